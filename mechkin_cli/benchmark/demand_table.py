"""What skipping saves: the same rows with one part of the demand plan more at a time.

In the kernel's call, in `analyze` within a process, and in a whole process that imports, reads,
checks and analyzes.
"""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from time import perf_counter

from mechkin_cli.benchmark.report import Cell, Column, Table, key_of
from mechkin_cli.benchmark.scene import BATCH, Scene
from mechkin_cli.benchmark.subject import Subject
from mechkin_cli.benchmark.timing import Timing, in_turns
from mechkin_cli.plan import Demand
from mechkin_cli.session import Packing
from mechkin_cli.sweep import analyze

SCRIPT = (
    "import sys, mechkin_cli as mk; "
    "mk.load(sys.argv[1]).analyze(sys.argv[2:], tables=[], threads=1)"
)
MILLI = 1000.0
MICRO = MILLI * MILLI

COLUMNS = (
    Column("part", "computed"),
    Column("kernel", "kernel,\nus a row", "time"),
    Column("share", "% of\nall", "percent"),
    Column("analyze", "analyze,\nus a row", "time"),
    Column("analyze_share", "% of\nall", "percent"),
    Column("process", "process,\nms", "time"),
    Column("process_share", "% of\nall", "percent"),
)


def steps(scene: Scene) -> list[tuple[str, tuple[str, ...], Demand]]:
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


def demand_table(scene: Scene, subject: Subject, rounds: int, processes: int) -> Table:
    """One line for every step; `processes` are the rounds of processes (0: none)."""
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
    return Table(name, f"{scene.name}: what skipping saves", COLUMNS, rows, notes)


def _processes(asked: list[tuple[str, ...]], subject: Subject, rounds: int) -> dict[int, Timing]:
    with subject.on_disk() as file:
        line = [sys.executable, "-P", "-c", SCRIPT, str(file)]
        calls = {
            k: partial(subprocess.run, [*line, *names], check=True, capture_output=True)
            for k, names in enumerate(asked)
        }
        return in_turns(calls, rounds, perf_counter)
