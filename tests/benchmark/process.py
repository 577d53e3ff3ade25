"""Whole processes: `mechkin analyze` as the shell sees it, against bare imports of its stack."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import mechkin_cli
from mechkin_cli.bench.measurement import Timing, in_turns

RUNS = 21


def command() -> list[str]:
    """The installed `mechkin` of this interpreter, else the module."""
    script = Path(sys.executable).with_name("mechkin")
    if script.is_file() and os.access(script, os.X_OK):
        return [str(script)]
    return [sys.executable, "-m", "mechkin_cli"]


def process_times(
    file: Path, others: Sequence[Sequence[str]], runs: int = RUNS
) -> tuple[Timing, list[Timing]]:
    """Times of `mechkin analyze FILE` and of other command lines, in turns.

    In the others, FILE stands for the file and DIR for a folder to write to.

    Raises:
        CalledProcessError: one of them fails.
    """
    with TemporaryDirectory(prefix="mechkin-process-") as folder:
        places = {"FILE": str(file), "DIR": folder}
        lines = [[*command(), "analyze", "FILE", "--out", "DIR"], *others]
        run = partial(_run, environment=environment())
        calls = {
            number: partial(run, [places.get(word, word) for word in line])
            for number, line in enumerate(lines)
        }
        times = in_turns(calls, runs, perf_counter)
    mine, *rest = times.values()
    return mine, rest


def bare_imports() -> list[str]:
    """The command line that only imports the libraries mechkin is built on."""
    return [sys.executable, "-c", "import numpy, pydantic, yaml, typer"]


def environment() -> dict[str, str]:
    """The caller's, but with compiled bytecode as an installed package has it, and this package."""
    settings = ("PYTHONDONTWRITEBYTECODE", "PYTHONUNBUFFERED", "PYTHONPATH")
    kept = {name: value for name, value in os.environ.items() if name not in settings}
    package = str(Path(mechkin_cli.__file__).resolve().parents[1])
    paths = [package, os.environ.get("PYTHONPATH", "")]
    return kept | {"PYTHONPATH": os.pathsep.join(path for path in paths if path)}


def _run(line: list[str], environment: dict[str, str]) -> None:
    silent = subprocess.DEVNULL
    subprocess.run(line, check=True, stdout=silent, stderr=silent, env=environment)
