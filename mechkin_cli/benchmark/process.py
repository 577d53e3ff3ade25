"""Whole processes: `mechkin analyze` as the shell sees it, against a program that does nothing."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from mechkin_cli.benchmark.timing import Timing, in_turns

RUNS = 21


def command() -> list[str]:
    """The installed `mechkin` of this interpreter, else the module."""
    script = Path(sys.executable).with_name("mechkin")
    if script.is_file() and os.access(script, os.X_OK):
        return [str(script)]
    return [sys.executable, "-m", "mechkin_cli"]


def process_times(file: Path, do_nothing: Path, runs: int = RUNS) -> tuple[Timing, Timing]:
    """Times of `mechkin analyze FILE` and of the program `do_nothing` on the same file, in turns.

    Raises:
        CalledProcessError: one of them fails.
    """
    with TemporaryDirectory(prefix="mechkin-process-") as folder:
        mechkin = [*command(), "analyze", str(file), "--out", folder]
        nothing = [sys.executable, str(do_nothing), "analyze", str(file), "--out", folder]
        run = partial(_run, environment=_environment())
        calls = {"mechkin": partial(run, mechkin), "nothing": partial(run, nothing)}
        times = in_turns(calls, runs)
    return times["mechkin"], times["nothing"]


def _environment() -> dict[str, str]:
    """The caller's, but with compiled bytecode as an installed package has it, and this package."""
    settings = ("PYTHONDONTWRITEBYTECODE", "PYTHONUNBUFFERED", "PYTHONPATH")
    kept = {name: value for name, value in os.environ.items() if name not in settings}
    package = str(Path(__file__).resolve().parents[2])
    paths = [package, os.environ.get("PYTHONPATH", "")]
    return kept | {"PYTHONPATH": os.pathsep.join(path for path in paths if path)}


def _run(line: list[str], environment: dict[str, str]) -> None:
    nothing = subprocess.DEVNULL
    subprocess.run(line, check=True, stdout=nothing, stderr=nothing, env=environment)
