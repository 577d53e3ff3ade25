"""Every library that the package imports is declared as its dependency."""

from __future__ import annotations

import re
import subprocess
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
    asked = ("bench", "plot", "pandas", "parquet", "cluster", "fit", "xlsx", "notebook", "dxf")
    named = [*project["dependencies"], *(text for extra in asked for text in extras[extra])]
    return {re.split(r"[<>=;\[ ]", text)[0] for text in named}


def test_what_is_imported_is_declared() -> None:
    used = {module.split(".")[0] for path in FILES for _, module in imports(path)}
    third = used - set(sys.stdlib_module_names) - {"mechkin_cli"} - BY_HAND.keys()
    names = {DISTRIBUTIONS.get(module, module) for module in third}
    assert {"numpy", "pydantic-core", "pyyaml", "typer"} <= names
    assert names - declared() == set()


def project() -> dict[str, list[str]]:
    text = (ROOT.parent / "pyproject.toml").read_text(encoding="utf-8")
    found: dict[str, list[str]] = tomllib.loads(text)["project"]
    return found


def test_every_dependency_has_a_lowest_version() -> None:
    for text in project()["dependencies"]:
        assert re.fullmatch(r"[a-z-]+>=[0-9.]+(,<[0-9]+)?", text), text
    # typer 0.15 and older die in help and in wrong options with click 8.2 and later
    (typer,) = (text for text in project()["dependencies"] if text.startswith("typer"))
    assert tuple(map(int, typer.removeprefix("typer>=").split("."))) >= (0, 16)
    # another major version of what the sections are checked by would be another language
    (core,) = (text for text in project()["dependencies"] if text.startswith("pydantic-core"))
    assert core.endswith(",<3")


def test_the_small_gate_takes_the_lowest_versions_of_all_dependencies() -> None:
    script = ROOT.parent / ".ci" / "versions"
    listed = subprocess.run(["bash", script, "list"], capture_output=True, text=True, check=True)
    lowest = [text.partition(",")[0].replace(">=", "==") for text in project()["dependencies"]]
    assert listed.stdout.splitlines() == lowest


def test_what_is_tested_together_or_first_is_there() -> None:
    text = (ROOT.parent / "tests" / "conftest.py").read_text(encoding="utf-8")
    named = re.findall(r'"(tests/[a-z_/.]+)"', text)
    assert len(named) > 5
    assert [name for name in named if not list(ROOT.parent.glob(f"{name}*"))] == []
