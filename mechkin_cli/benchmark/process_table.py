"""Whole processes: `mechkin analyze FILE`, beside what a script of another library takes at least.

No script takes less than Python with its library imported, whatever it computes then.
"""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from mechkin_cli.benchmark.report import Cell, Column, Table, key_of
from mechkin_cli.benchmark.subject import Subject
from mechkin_cli.benchmark.timing import in_turns

MILLI = 1000.0

LIBRARIES = ("numpy", "scipy.optimize", "pinocchio", "casadi", "mujoco")
"""What a script imports."""

COLUMNS = (
    Column("process", "process"),
    Column("milliseconds", "ms", "time"),
    Column("spread", "+-\n%", "percent"),
    Column("ratio", "times the\nfirst", "ratio"),
)


def process_table(subject: Subject, rounds: int) -> Table:
    """The whole command on one file, and the imports of the libraries that are here."""
    python = [sys.executable, "-P"]
    with subject.on_disk() as file, TemporaryDirectory(prefix="mechkin-bench-") as folder:
        name = f"mechkin analyze, {subject.name}"
        options = ["--quiet", "--out", folder]
        lines = {name: [*python, "-m", "mechkin_cli", "analyze", str(file), *options]}
        lines["python, nothing imported"] = [*python, "-c", "pass"]
        for module in LIBRARIES:
            if find_spec(module.partition(".")[0]) is not None:
                lines[f"import {module}"] = [*python, "-c", f"import {module}"]
        run = partial(subprocess.run, capture_output=True, cwd=Path(folder))
        calls = {key: partial(run, line) for key, line in lines.items()}
        times = in_turns(calls, rounds, perf_counter)
    rows: list[dict[str, Cell]] = [
        {
            "process": key,
            "milliseconds": MILLI * timing.median,
            "spread": timing.spread,
            "ratio": timing.ratio(times[name]),
        }
        for key, timing in times.items()
    ]
    notes = ("a script of another library takes at least its import, before it reads or solves.",)
    key = "processes_" + key_of(subject.name)
    return Table(key, f"{subject.name}: whole processes", COLUMNS, rows, notes)
