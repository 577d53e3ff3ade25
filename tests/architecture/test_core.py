"""The kernel's core is a library of its own: it knows no Python, and refuses by results."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from architecture.package import ROOT, of_every

KERNEL = ROOT / "kernel"
CORE = sorted(path for path in (KERNEL / "core").rglob("*.?pp"))
SKINS = sorted(path for skin in ("python", "c") for path in (KERNEL / skin).glob("*.[ch]*"))
INCLUDE = re.compile(r'^ *# *include *([<"])([^>"]+)[>"]', re.MULTILINE)
SYSTEM = {"cpuid.h", "immintrin.h", "xmmintrin.h", "pthread.h", "sched.h", "signal.h"}
"""What the core takes beyond C++'s own headers, whose names have no ending: one instruction set's
registers and one family of systems' threads, where there are such."""
THREADS = KERNEL / "core/rows/threads.cpp"
"""Memory that runs out in a thread is carried to the caller there."""


def included(path: Path) -> list[tuple[str, str]]:
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


@of_every(CORE)
def test_the_core_includes_itself_and_the_language_alone(path: Path) -> None:
    for bracket, header in included(path):
        if bracket == '"':
            assert (KERNEL / "core" / header).is_file(), header
        else:
            assert re.fullmatch("[a-z_]+", header) or header in SYSTEM, header
    assert not re.search(r"nanobind|Py[A-Z]\w+|Python\.h", path.read_text(encoding="utf-8"))


@of_every(CORE)
def test_nothing_is_thrown_in_the_core(path: Path) -> None:
    code = re.sub(r'//[^\n]*|"(?:\\.|[^"\\\n])*"', "", path.read_text(encoding="utf-8"))
    found = re.findall(r"\b(?:throw|try|catch|rethrow_exception|invalid_argument)\b", code)
    assert not found or path == THREADS


@of_every(SKINS)
def test_a_skin_includes_itself_and_the_core(path: Path) -> None:
    for bracket, header in included(path):
        if bracket == '"':
            assert (path.parent / header).is_file() or (KERNEL / "core" / header).is_file(), header
    if path.parent.name == "c":
        assert not any("nanobind" in header or "Python" in header for _, header in included(path))


@pytest.mark.parametrize("part", ["core", "python", "c"])
def test_every_source_is_built(part: str) -> None:
    folder = KERNEL / part
    build = (folder / "CMakeLists.txt").read_text(encoding="utf-8")
    sources = {path.relative_to(folder).as_posix() for path in folder.rglob("*.cpp")}
    assert sources == set(re.findall(r"[\w/]+\.cpp", build))


def test_the_page_names_the_folders_of_the_core() -> None:
    """The folders of the core are those that the pages name."""
    page = (ROOT.parent / "docs/internals.md").read_text(encoding="utf-8")
    folders = {path.name for path in (KERNEL / "core").iterdir() if path.is_dir()}
    assert all(f"`core/{folder}/`" in page for folder in folders), folders


LIBM = re.compile(
    r"std::(?:pow|cbrt|exp|exp2|expm1|log|log2|log10|log1p|hypot"
    r"|sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh)\("
)
"""Functions whose last bits are the library's own, unlike those of square roots."""


def test_the_core_calls_no_function_whose_bits_are_the_machines() -> None:
    assert LIBM.search("std::pow(x, 1.0 / n)")
    assert not LIBM.search("std::sqrt(x)")
    core = KERNEL / "core"
    called = [
        f"{path.relative_to(core)}: {found.group()}"
        for path in sorted([*core.rglob("*.cpp"), *core.rglob("*.hpp")])
        for found in LIBM.finditer(path.read_text(encoding="utf-8"))
    ]
    assert called == []
