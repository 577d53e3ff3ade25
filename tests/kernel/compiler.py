"""The system's C++ compiler, for tests of what the compiled module hides."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

SOURCES = Path(__file__).parents[2] / "mechkin_cli" / "kernel" / "src"
FLAGS = ["-std=c++17", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fPIC"]
FLAGS += ["-fvisibility=hidden", "-Wno-psabi"]

COMPILER = shutil.which(os.environ.get("CXX", "c++"))


def compile_with(source: Path, target: Path, *options: str) -> Path:
    """Compiles one file of C++ against the kernel's headers."""
    assert COMPILER is not None
    command = [COMPILER, *FLAGS, f"-I{SOURCES}", *options, str(source), "-o", str(target)]
    subprocess.run(command, check=True, capture_output=True, text=True)
    return target
