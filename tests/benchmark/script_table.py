"""Whole processes on the same table: `mechkin analyze FILE`, and scripts of other libraries."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Collection
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from benchmark.process import command, environment
from benchmark.script_problem import Script, scripts

from mechkin_cli.bench.measurement import in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable

FOLDER = Path(__file__).resolve().parent / "scripts"
LIBRARIES = {"Pinocchio": "pinocchio", "MuJoCo": "mujoco", "CasADi": "casadi"}
MILLI = 1000.0
TABLE = "motion.csv"

COLUMNS = (
    ReportColumn("mechanism", "mechanism"),
    ReportColumn("process", "process"),
    ReportColumn("milliseconds", "ms", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times\nmechkin", "ratio"),
    ReportColumn("difference", "largest\ndifference", "error"),
)


def script_table(runs: int, names: Collection[str] = ()) -> ReportTable:
    """RCSR, 7R and Stewart's platform, or some of them, each in turns with scripts of the libraries
    that are here; the others are left out by name.

    Raises:
        CalledProcessError: `mechkin analyze`, or a script whose library is here, failed.
    """
    rows: list[dict[str, Cell]] = []
    missing: dict[str, None] = {}
    for name, make in scripts().items():
        if names and name not in names:
            continue
        with TemporaryDirectory(prefix="mechkin-script-") as folder:
            rows += _mechanism(name, make(), Path(folder), runs, missing)
    notes = [
        "the same table of positions, rates and accelerations by whole processes, by the clock.",
        "a script is given the mechanism in plain numbers; it has no file to read and to check,",
        "no forces, no verdicts, and starts each row from the row before.",
        "difference: from mechkin's table, in parts of a column's largest value.",
        *(f"{label} is left out: it is not installed." for label in missing),
    ]
    return ReportTable("scripts", "whole scripts of other libraries", COLUMNS, rows, notes)


def _mechanism(
    name: str, script: Script, folder: Path, runs: int, missing: dict[str, None]
) -> list[dict[str, Cell]]:
    lines = _lines(script, folder)
    _run(lines["mechkin analyze"])
    differences: dict[str, float] = {}
    for label in LIBRARIES:
        differences[label] = _difference(lines[label], folder / TABLE)
        if differences[label] < 0.0:
            missing[label] = None
            del lines[label]
    times = in_turns({k: partial(_run, line) for k, line in lines.items()}, runs, perf_counter)
    own = times["mechkin analyze"]
    return [
        {
            "mechanism": name,
            "process": label,
            "milliseconds": MILLI * timing.median,
            "spread": timing.spread,
            "ratio": timing.ratio(own),
            "difference": differences.get(label),
        }
        for label, timing in times.items()
    ]


def _lines(script: Script, folder: Path) -> dict[str, list[str]]:
    """The command lines by what the table calls them; files are written into the folder."""
    problem, file = folder / "problem.json", folder / "mechanism.yaml"
    problem.write_text(json.dumps(script.problem), encoding="utf-8")
    file.write_text(script.text, encoding="utf-8")
    own = [*command(), "analyze", str(file), "--out", str(folder), "--format", "csv", "--quiet"]
    lines = {"mechkin analyze": own}
    for label, library in LIBRARIES.items():
        path = FOLDER / f"with_{library}.py"
        lines[label] = [sys.executable, "-P", str(path), str(problem), str(folder)]
    return lines


def _difference(line: list[str], table: Path) -> float:
    """Runs a script once and compares its table; -1 where its library is not here."""
    done = subprocess.run([*line, str(table)], capture_output=True, text=True, env=environment())
    if done.returncode and done.stderr.startswith("left out"):
        return -1.0
    done.check_returncode()
    return float(done.stdout.split()[-1])


def _run(line: list[str]) -> None:
    subprocess.run(line, check=True, capture_output=True, env=environment())
