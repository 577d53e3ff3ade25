"""The system's C++ compiler, for tests of what the compiled module hides."""

from __future__ import annotations

import os
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path

SOURCES = Path(__file__).parents[2] / "mechkin_cli" / "kernel" / "core"
FLAGS = ["-std=c++17", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fPIC"]
FLAGS += ["-fvisibility=hidden", "-Wno-psabi"]

NARROW = "--config-settings=cmake.define.MECHKIN_NARROW=ON"
"""For `pip install` of a changed copy: its narrowest units alone, in less than half the
time; what is computed does not depend on the width."""

TOOLS_HERE = shutil.which("cmake") is not None and all(
    find_spec(name) for name in ("scikit_build_core", "nanobind")
)
"""What `pip install` builds with is here, and need not be brought for a build of its own."""

COMPILER = shutil.which(os.environ.get("CXX", "c++"))


def compile_with(source: Path, target: Path, *options: str) -> Path:
    """Compiles one file of C++ against the kernel's headers."""
    assert COMPILER is not None
    command = [COMPILER, *FLAGS, f"-I{SOURCES}", *options, str(source), "-o", str(target)]
    subprocess.run(command, check=True, capture_output=True, text=True)
    return target


def built_object(library: str, source: str) -> Path | None:
    """The object file of a source in what `pip install .` left here, if it is newer than all
    sources of the core."""
    return _built(f"CMakeFiles/{library}.dir/{source}.o")


def built_core() -> Path | None:
    """The library of the core in what `pip install .` left here, likewise."""
    return _built("libmechkin_core.a")


def _built(name: str) -> Path | None:
    newest = max(file.stat().st_mtime for file in SOURCES.rglob("*") if file.is_file())
    for file in SOURCES.parents[2].glob(f"build/*/core/{name}"):
        if file.stat().st_mtime > newest:
            return file
    return None
