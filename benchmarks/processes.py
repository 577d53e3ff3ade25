"""What a whole process takes, beside the imports of other libraries.

No script of another library takes less than Python with that library imported, whatever it computes
then.
"""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from mechkin_cli.bench.measurement import in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, key_of

MILLI = 1000.0

LIBRARIES = ("numpy", "scipy.optimize", "pinocchio", "casadi", "mujoco")
"""What a script imports."""

PROCESS_COLUMNS = (
    ReportColumn("process", "process"),
    ReportColumn("milliseconds", "ms", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times the\nfirst", "ratio"),
)


def process_table(scene: str, text: str, rounds: int) -> ReportTable:
    """The whole command on the file of a scene, and the imports of the libraries that are here."""
    python = [sys.executable, "-P"]
    with TemporaryDirectory(prefix="mechkin-bench-") as folder:
        file = Path(folder) / "mechanism.yaml"
        file.write_text(text, encoding="utf-8")
        name = f"mechkin analyze, {scene}"
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
    key = "processes_" + key_of(scene)
    return ReportTable(key, f"{scene}: whole processes", PROCESS_COLUMNS, rows, notes)
