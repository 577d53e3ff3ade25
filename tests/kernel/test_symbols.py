"""The kernel's unit of each instruction set shares no code with the others and contracts nothing.

A template instantiated in several units is linked once, from whichever unit comes first: wide
instructions would then run on machines that lack them. So a unit may define nothing but its entry
and local symbols.
"""

from __future__ import annotations

import platform
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from kernel.compiler import COMPILER, SOURCES, compile_with

from mechkin_cli.kernel import _kernel

UNITS = {
    "sse2": (2, []),
    "avx2": (4, ["-mavx2"]),
    "avx512": (8, ["-mavx512f", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]),
}
FUSED = re.compile(r"\bv?fn?m(add|sub)[a-z0-9]*\b")

pytestmark = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="units of x86-64"
)
needs_compiler = pytest.mark.skipif(
    COMPILER is None or shutil.which("nm") is None, reason="no C++ compiler or no nm here"
)
needs_objdump = pytest.mark.skipif(shutil.which("objdump") is None, reason="no objdump here")


@pytest.fixture(scope="module", params=UNITS)
def unit(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One unit, compiled as the build does."""
    lanes, options = UNITS[request.param]
    defined = [f"-DMECHKIN_LANES={lanes}", f"-DMECHKIN_UNIT=mechkin_unit_{request.param}"]
    target = tmp_path_factory.mktemp("units") / f"{request.param}.o"
    plain = ["-O3", "-c", "-fno-exceptions", "-fno-rtti"]
    return compile_with(SOURCES / "unit.cpp", target, *plain, *defined, *options)


def symbols(file: Path, *options: str) -> list[tuple[str, str]]:
    """(kind, name) of the symbols; nm writes local kinds in lower case."""
    command = ["nm", *options, str(file)]
    listing = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [tuple(line.split()[-2:]) for line in listing.splitlines()]


def instructions(file: Path) -> str:
    command = ["objdump", "-d", "--no-show-raw-insn", str(file)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@needs_compiler
def test_a_unit_exports_its_entry_only(unit: Path) -> None:
    shared = [name for kind, name in symbols(unit) if kind in "TWVuBDGRC"]
    assert shared == [f"mechkin_unit_{unit.stem}"]


@needs_compiler
def test_a_unit_calls_nothing_but_memory_functions(unit: Path) -> None:
    called = {name for kind, name in symbols(unit) if kind == "U"}
    assert called <= {"memcpy", "memset", "memmove", "_GLOBAL_OFFSET_TABLE_"}


@needs_compiler
@needs_objdump
def test_a_unit_fuses_no_multiplications_and_additions(unit: Path) -> None:
    text = instructions(unit)
    assert "mul" in text
    assert FUSED.search(text) is None


@needs_objdump
def test_the_built_module_fuses_no_multiplications_and_additions() -> None:
    text = instructions(Path(_kernel.__file__))
    assert "mul" in text
    assert FUSED.search(text) is None


def test_the_build_compiles_the_same_units() -> None:
    """The flags above are those of CMakeLists.txt."""
    build = (SOURCES.parent / "CMakeLists.txt").read_text(encoding="utf-8")
    assert "-ffp-contract=off" in build
    units = re.findall(r"^ *mechkin_unit\((\w+) (\d)([^)]*)\)", build, re.MULTILINE)
    assert {name: (int(lanes), flags.split()) for name, lanes, flags in units} == UNITS
