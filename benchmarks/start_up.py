"""Times whole commands against the bare imports of the libraries that mechkin is built on.

    python -m benchmarks.start_up [--rounds N] [--file FILE] [COMMAND...]

All processes start in turns, so that a slow moment of the machine meets each. Printed are the best
time of each command and its ratio to the best of the imports. Compiled bytecode is kept, as an
installed package has it; the package timed is the one that this module sees.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import mechkin_cli

FILE = Path(__file__).resolve().parents[1] / "mechanisms" / "dissertation" / "rcsr.yaml"
ROUNDS = 15
IMPORTS = "imports"

COMMANDS: dict[str, list[str]] = {
    "analyze": ["analyze", "FILE", "--quiet", "--out", "DIR"],
    "check": ["check", "FILE", "--quiet"],
    "mobility": ["mobility", "FILE", "--quiet"],
    "modes": ["modes", "FILE", "--quiet"],
    "ranges": ["ranges", "FILE", "--quiet"],
    "tables": ["tables", "FILE", "--check", "--quiet"],
    "--version": ["--version"],
    "--help": ["--help"],
}
"""Command lines; FILE stands for the file, DIR for a folder to write to."""


def process_lines(file: Path, folder: str, names: Sequence[str]) -> dict[str, list[str]]:
    """What is started, by name: Python alone, the bare imports, and the commands."""
    places = {"FILE": str(file), "DIR": folder}
    program = [sys.executable, "-m", "mechkin_cli"]
    lines = {
        "python": [sys.executable, "-c", "pass"],
        IMPORTS: [sys.executable, "-c", "import numpy, pydantic, yaml, typer"],
    }
    for name in names:
        lines[name] = [*program, *(places.get(word, word) for word in COMMANDS[name])]
    return lines


def best_times(lines: Mapping[str, Sequence[str]], rounds: int) -> dict[str, float]:
    """The shortest wall time of each command line, s, after one round to warm up.

    Raises:
        CalledProcessError: one of them fails.
    """
    best = dict.fromkeys(lines, float("inf"))
    for number in range(rounds + 1):
        for name, line in lines.items():
            start = perf_counter()
            subprocess.run(line, check=True, capture_output=True, env=_environment())
            if number:
                best[name] = min(best[name], perf_counter() - start)
    return best


def _environment() -> dict[str, str]:
    """The caller's, with this package, compiled bytecode and as many BLAS threads as usual."""
    left_out = ("PYTHONDONTWRITEBYTECODE", "OPENBLAS_NUM_THREADS")
    kept = {name: value for name, value in os.environ.items() if name not in left_out}
    package = str(Path(mechkin_cli.__file__).resolve().parents[1])
    paths = [package, os.environ.get("PYTHONPATH", "")]
    return kept | {"PYTHONPATH": os.pathsep.join(path for path in paths if path)}


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--file", type=Path, default=FILE)
    parser.add_argument("commands", nargs="*", choices=[*COMMANDS, []], metavar="COMMAND")
    given = parser.parse_args()
    with TemporaryDirectory(prefix="mechkin-start-") as folder:
        lines = process_lines(given.file, folder, given.commands or list(COMMANDS))
        best = best_times(lines, given.rounds)
    for name, seconds in best.items():
        ratio = seconds / best[IMPORTS]
        print(f"{name:<10} {1000.0 * seconds:7.1f} ms  {ratio:5.2f} of the imports")


if __name__ == "__main__":
    main()
