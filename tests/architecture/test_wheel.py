"""The wheel has what runs: no source that is compiled, nothing of the benchmarks, all data."""

from __future__ import annotations

import importlib.metadata
import tomllib
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

import pathspec
import pytest
from architecture.package import ROOT

import mechkin_cli

SETTINGS = tomllib.loads((ROOT.parent / "pyproject.toml").read_text(encoding="utf-8"))
SETTINGS = SETTINGS["tool"]["scikit-build"]
MADE = ("*.so", "*.pyd", "__pycache__")
"""What a build leaves in the tree, and no file of the source."""

COMPILED = {".c", ".cc", ".cpp", ".cxx", ".h", ".hh", ".hpp", ".cmake"}
NEEDED = (
    "mechkin_cli/py.typed",
    "mechkin_cli/kernel/_kernel.pyi",
    "mechkin_cli/bench/hard_mechanisms.json",
    "mechkin_cli/templates/four-bar.yaml",
    "mechkin_cli/view/page.html",
    "mechkin_cli/view/shell/shell.html",
    "mechkin_cli/view/shell/widget.js",
)


def packed(paths: Iterable[str]) -> list[str]:
    """Those of the tree's files that scikit-build-core takes, by its own globbing."""
    left_out = pathspec.GitIgnoreSpec.from_lines([*SETTINGS["wheel"]["exclude"], *MADE])
    return [path for path in paths if not left_out.match_file(path)]


def strangers(paths: Iterable[str]) -> list[str]:
    """Files that have no place in a wheel."""
    return [
        path
        for path in map(PurePosixPath, paths)
        if path.suffix in COMPILED
        or path.name == "CMakeLists.txt"
        or {"benchmark", "benchmarks", "tests"} & set(path.parts)
    ]


def tree() -> list[str]:
    files = (path for path in ROOT.rglob("*") if path.is_file())
    return [path.relative_to(ROOT.parent).as_posix() for path in files]


def test_the_package_alone_is_packed() -> None:
    assert SETTINGS["wheel"]["packages"] == ["mechkin_cli"]


def test_no_source_and_no_benchmark_is_packed() -> None:
    found = packed(tree())
    assert strangers(found) == []
    assert set(NEEDED) <= set(found)
    # the test sees what it looks for
    assert len(strangers(tree())) > 200


@pytest.mark.parametrize("folder", ["", "src/", "core/rows/", "python/", "c/", "c/include/"])
@pytest.mark.parametrize("name", ["x.cpp", "x.hpp", "x.h", "x.c", "CMakeLists.txt"])
def test_sources_may_lie_anywhere_below_the_kernel(folder: str, name: str) -> None:
    assert packed([f"mechkin_cli/kernel/{folder}{name}"]) == []


def test_the_installed_package_has_no_stranger() -> None:
    files = importlib.metadata.files("mechkin") or []
    here = {Path(str(file.locate())).resolve() for file in files}
    if Path(mechkin_cli.__file__).resolve() not in here:
        pytest.skip("mechkin is not run from a wheel")
    assert strangers(map(str, files)) == []
    assert set(NEEDED) <= set(map(str, files))
