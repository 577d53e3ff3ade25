"""Every library that the package imports is declared as its dependency."""

from __future__ import annotations

import re
import sys
import tomllib

from architecture.package import FILES, ROOT, imports

DISTRIBUTIONS = {"yaml": "pyyaml", "pydantic_core": "pydantic-core", "pinocchio": "pin"}
"""Libraries whose distribution has another name."""

BY_HAND = {}
"""Modules that are looked for, and done without."""


def declared() -> set[str]:
    project = tomllib.loads((ROOT.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    # the benchmark, pictures and data frames ask for extras, and are done without
    extras = project["optional-dependencies"]
    named = [*project["dependencies"], *extras["bench"], *extras["plot"], *extras["pandas"]]
    return {re.split(r"[<>=;\[ ]", text)[0] for text in named}


def test_what_is_imported_is_declared() -> None:
    used = {module.split(".")[0] for path in FILES for _, module in imports(path)}
    third = used - set(sys.stdlib_module_names) - {"mechkin_cli"} - BY_HAND.keys()
    names = {DISTRIBUTIONS.get(module, module) for module in third}
    assert {"numpy", "pydantic-core", "pyyaml", "typer"} <= names
    assert names - declared() == set()
