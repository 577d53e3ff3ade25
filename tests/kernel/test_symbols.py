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
from kernel.compiler import COMPILER, SOURCES, built_object, compile_with

from mechkin_cli.kernel import _kernel

UNITS = {
    "sse2": (2, []),
    "avx2": (4, ["-mavx2"]),
    "avx512": (8, ["-mavx512f", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]),
}
DOUBLE_DOUBLE = {
    "sse2": (2, 0, []),
    "avx512": (8, 1, ["-mavx512f", "-mavx512dq", "-mavx512vl", "-mprefer-vector-width=512"]),
}
FUSED = re.compile(r"\bv?fn?m(add|sub)[a-z0-9]*\b")

MOST_BYTES = 4_000_000
"""Of the module for x86-64: docs/internals.md says what it is made of. A new pair is compiled
twelve times; what exceeds this is mostly something that every unit has a copy of and needs none."""

pytestmark = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="units of x86-64"
)
needs_compiler = pytest.mark.skipif(
    COMPILER is None or shutil.which("nm") is None, reason="no C++ compiler or no nm here"
)
needs_objdump = pytest.mark.skipif(shutil.which("objdump") is None, reason="no objdump here")


PLAIN = ["-O2", "-c", "-fno-exceptions", "-fno-rtti"]
OF_DOUBLES = [f"{kind}_{name}" for kind in ("unit", "motion") for name in UNITS]
OF_DOUBLE_DOUBLE = [f"double_double_{name}" for name in DOUBLE_DOUBLE]
OF_INTERVALS = [f"enclosing_{name}" for name in DOUBLE_DOUBLE]
FOLDERS = {"unit": "rows", "motion": "response", "double_double": "rows", "enclosing": "proofs"}
NAMES = {"unit": "UNIT", "motion": "MOTION", "double_double": "UNIT", "enclosing": "ENCLOSING"}


def compile_unit(name: str, target: Path) -> Path:
    """As the build does, or has done."""
    kind, _, instructions = name.rpartition("_")
    if kind in ("unit", "motion"):
        lanes, options = UNITS[instructions]
        arithmetic = []
    else:
        lanes, fused, options = DOUBLE_DOUBLE[instructions]
        number = 1 if kind == "double_double" else 2
        arithmetic = [f"-DMECHKIN_ARITHMETIC={number}", f"-DMECHKIN_FUSED={fused}", "-Os"]
    entry = f"-DMECHKIN_{NAMES[kind]}=mechkin_{name}"
    defined = [f"-DMECHKIN_LANES={lanes}", entry, *arithmetic, f"-I{SOURCES}"]
    source = f"{FOLDERS[kind]}/" + ("unit.cpp" if kind == "unit" else f"{kind}_unit.cpp")
    library = f"mechkin_{instructions if kind in ('unit', 'motion') else name}"
    if built := built_object(library, source):
        shutil.copy(built, target)
        return target
    return compile_with(SOURCES / source, target, *PLAIN, *defined, *options)


@pytest.fixture(scope="module", params=OF_DOUBLES + OF_DOUBLE_DOUBLE + OF_INTERVALS)
def unit(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One unit, compiled as the build does."""
    name: str = request.param
    return compile_unit(name, tmp_path_factory.mktemp("units") / f"{name}.o")


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
    assert shared == [f"mechkin_{unit.stem}"]


@needs_compiler
def test_a_unit_calls_nothing_but_memory_functions(unit: Path) -> None:
    called = {name for kind, name in symbols(unit) if kind == "U"}
    assert called <= {"memcpy", "memset", "memmove", "_GLOBAL_OFFSET_TABLE_"}


@needs_compiler
@needs_objdump
def test_a_unit_does_nothing_when_the_module_is_loaded(unit: Path) -> None:
    """A constant that is computed then would run wide instructions on every machine."""
    command = ["objdump", "-h", str(unit)]
    sections = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    assert ".text" in sections
    assert ".init_array" not in sections


@needs_compiler
@needs_objdump
@pytest.mark.parametrize("unit", OF_DOUBLES, indirect=True)
def test_a_unit_of_doubles_fuses_no_multiplications_and_additions(unit: Path) -> None:
    text = instructions(unit)
    assert "mul" in text
    assert FUSED.search(text) is None


@needs_compiler
@needs_objdump
@pytest.mark.parametrize("unit", OF_DOUBLE_DOUBLE + OF_INTERVALS, indirect=True)
def test_double_double_fuses_products_with_their_rounded_value_alone(unit: Path) -> None:
    found = set(FUSED.findall(instructions(unit)))
    assert found == ({"sub"} if "avx512" in unit.stem else set())


@needs_objdump
def test_the_built_module_fuses_nothing_else() -> None:
    text = instructions(Path(_kernel.__file__))
    assert "mul" in text
    fused = [line for line in text.splitlines() if FUSED.search(line)]
    assert all("vfmsub" in line and "zmm" in line for line in fused)


@pytest.mark.skipif(shutil.which("nm") is None or platform.system() != "Linux", reason="no nm here")
def test_the_module_exports_what_python_asks_for_alone() -> None:
    command = ["nm", "-D", "--defined-only", str(_kernel.__file__)]
    found = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert [line.split()[-1] for line in found.splitlines()] == ["PyInit__kernel"]


def test_the_module_is_no_larger_than_it_need_be() -> None:
    assert Path(_kernel.__file__).stat().st_size <= MOST_BYTES


def test_the_build_compiles_the_same_units() -> None:
    """The flags above are those of CMakeLists.txt."""
    build = (SOURCES / "CMakeLists.txt").read_text(encoding="utf-8")
    assert "-ffp-contract=off" in build
    units = re.findall(r"^ *mechkin_unit\((\w+) (\d)([^)]*)\)", build, re.MULTILINE)
    assert {name: (int(lanes), flags.split()) for name, lanes, flags in units} == UNITS
    for made in ("double_double", "enclosing"):
        pattern = rf"^ *mechkin_{made}\((\w+) (\d) (\d)([^)]*)\)"
        units = re.findall(pattern, build, re.MULTILINE)
        assert {
            name: (int(lanes), int(fused), flags.split()) for name, lanes, fused, flags in units
        } == DOUBLE_DOUBLE
