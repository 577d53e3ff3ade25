"""What settings of a run cost: what skipping saves, what threads gain, what a whole process takes.

Skipping: the same rows with one part of the demand plan more at a time, in the kernel's call, in
`analyze` within a process, and in a whole process that imports, reads, checks and analyzes. Whole
processes stand beside what a script of another library takes at least: none takes less than Python
with its library imported, whatever it computes then.
"""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from mechkin_cli.bench.measurement import Timing, in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, key_of
from mechkin_cli.bench.scene import BATCH, BenchScene, Subject
from mechkin_cli.kernel import _kernel
from mechkin_cli.plan import Demand
from mechkin_cli.session import Packing
from mechkin_cli.sweep import analyze

SCRIPT = (
    "import sys, mechkin_cli as mk; "
    "mk.load(sys.argv[1]).analyze(sys.argv[2:], tables=[], threads=1)"
)
MILLI = 1000.0
MICRO = MILLI * MILLI

DEMAND_COLUMNS = (
    ReportColumn("part", "computed"),
    ReportColumn("kernel", "kernel,\nus a row", "time"),
    ReportColumn("share", "% of\nall", "percent"),
    ReportColumn("analyze", "analyze,\nus a row", "time"),
    ReportColumn("analyze_share", "% of\nall", "percent"),
    ReportColumn("process", "process,\nms", "time"),
    ReportColumn("process_share", "% of\nall", "percent"),
)


def steps(scene: BenchScene) -> list[tuple[str, tuple[str, ...], Demand]]:
    """What is computed, the quantities, and what is demanded beside them."""
    asked = scene.asked
    efforts = tuple(name for name in asked.loads if name.endswith(".effort"))
    first = (*asked.position, *asked.velocity)
    moving = asked.level("motion")
    found = [("position", asked.position, Demand.POSITION)]
    found += [("+ velocity", first, Demand.POSITION), ("+ acceleration", moving, Demand.POSITION)]
    if efforts:
        found += [("+ effort", (*moving, *efforts), Demand.POSITION)]
    if len(asked.loads) > len(efforts):
        found += [("+ reactions of all joints", asked.level("everything"), Demand.POSITION)]
    return [*found, ("+ verdicts of all rows", found[-1][1], scene.verdicts("everything"))]


def demand_table(subject: Subject, rounds: int, processes: int) -> ReportTable:
    """One line for every step; `processes` are the rounds of processes (0: none)."""
    scene = subject.scene
    plan, session = steps(scene), scene.model.session.packed(Packing(0, 1))
    verdicts = [k == len(plan) - 1 for k in range(len(plan))]
    kernel = in_turns(
        {
            k: scene.kernel(names, scene.followed, BATCH, more=more)
            for k, (_, names, more) in enumerate(plan)
        },
        rounds,
    )
    whole = in_turns(
        {
            k: partial(analyze, session, names, verdicts=verdicts[k])
            for k, (_, names, _) in enumerate(plan)
        },
        rounds,
    )
    processed = _processes([names for _, names, _ in plan], subject, processes) if processes else {}
    last, rows = len(plan) - 1, []
    for k, (name, _, _) in enumerate(plan):
        row: dict[str, Cell] = {
            "part": name,
            "kernel": MICRO * kernel[k].median / BATCH,
            "share": kernel[k].ratio(kernel[last]),
            "analyze": MICRO * whole[k].median / scene.result.rows,
            "analyze_share": whole[k].ratio(whole[last]),
        }
        if k in processed:
            row["process"] = MILLI * processed[k].median
            row["process_share"] = processed[k].ratio(processed[last])
        rows.append(row)
    notes = (
        f"kernel: {BATCH} rows a call; analyze: {scene.result.rows} rows, with verdicts in the",
        "last line alone; a process has them in every line.",
        "each line computes all lines above it as well.",
    )
    name = "demand_" + key_of(scene.name)
    return ReportTable(name, f"{scene.name}: what skipping saves", DEMAND_COLUMNS, rows, notes)


def _processes(asked: list[tuple[str, ...]], subject: Subject, rounds: int) -> dict[int, Timing]:
    with subject.on_disk() as file:
        line = [sys.executable, "-P", "-c", SCRIPT, str(file)]
        calls = {
            k: partial(subprocess.run, [*line, *names], check=True, capture_output=True)
            for k, names in enumerate(asked)
        }
        return in_turns(calls, rounds, perf_counter)


THREAD_ROWS = 50_000

THREAD_COLUMNS = (
    ReportColumn("scene", "mechanism"),
    ReportColumn("threads", "threads", "number"),
    ReportColumn("microseconds", "us a row", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("gain", "times one\nthread", "ratio"),
)


def thread_table(scenes: list[BenchScene], rounds: int, rows: int = THREAD_ROWS) -> ReportTable:
    """Everything that is asked of every scene, on 1, 2, 4 ... threads, as many as there are."""
    most = _kernel.available_processors()
    counts = [n for n in (1, 2, 4, 8, 16, 32, 64) if n < most] + [most]
    lines: list[dict[str, Cell]] = []
    for scene in scenes:
        calls = {
            n: scene.kernel("everything", scene.followed, rows, packing=Packing(0, n))
            for n in counts
        }
        times = in_turns(calls, rounds, perf_counter)
        for n, timing in times.items():
            lines.append(
                {
                    "scene": scene.name,
                    "threads": n,
                    "microseconds": MICRO * timing.median / rows,
                    "spread": timing.spread,
                    "gain": times[counts[0]].ratio(timing),
                }
            )
    notes = (f"{rows} rows a call with everything; by the clock on the wall.",)
    return ReportTable("threads", "What threads gain", THREAD_COLUMNS, lines, notes)


LIBRARIES = ("numpy", "scipy.optimize", "pinocchio", "casadi", "mujoco")
"""What a script imports."""

PROCESS_COLUMNS = (
    ReportColumn("process", "process"),
    ReportColumn("milliseconds", "ms", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times the\nfirst", "ratio"),
)


def process_table(subject: Subject, rounds: int) -> ReportTable:
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
    return ReportTable(key, f"{subject.name}: whole processes", PROCESS_COLUMNS, rows, notes)
