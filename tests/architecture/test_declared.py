"""Every library that the package imports is declared as its dependency."""

from __future__ import annotations

import re
import sys
import tomllib

from architecture.package import FILES, ROOT, imports

DISTRIBUTIONS = {"yaml": "pyyaml", "pydantic_core": "pydantic-core"}
"""Libraries whose distribution has another name."""

BY_HAND = {}
"""Modules that are looked for, and done without."""


def declared() -> set[str]:
    project = tomllib.loads((ROOT.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    # the benchmark, pictures, data frames and studies ask for extras, and are done without
    extras = project["optional-dependencies"]
    asked = ("bench", "plot", "pandas", "parquet", "cluster", "fit")
    named = [*project["dependencies"], *(text for extra in asked for text in extras[extra])]
    return {re.split(r"[<>=;\[ ]", text)[0] for text in named}


def test_what_is_imported_is_declared() -> None:
    used = {module.split(".")[0] for path in FILES for _, module in imports(path)}
    third = used - set(sys.stdlib_module_names) - {"mechkin_cli"} - BY_HAND.keys()
    names = {DISTRIBUTIONS.get(module, module) for module in third}
    assert {"numpy", "pydantic-core", "pyyaml", "typer"} <= names
    assert names - declared() == set()
