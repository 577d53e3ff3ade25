"""What settings of a run cost: what skipping saves, and what threads gain.

Skipping: the same rows with one part of the demand plan more at a time, in the kernel's call and in
`analyze`.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from time import perf_counter

from mechkin_cli.bench.measurement import in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, key_of
from mechkin_cli.bench.scene import BATCH, BenchScene
from mechkin_cli.kernel import _kernel
from mechkin_cli.plan import Demand
from mechkin_cli.session import Packing
from mechkin_cli.sweep import analyze

MICRO = 1000.0 * 1000.0

DEMAND_COLUMNS = (
    ReportColumn("part", "computed"),
    ReportColumn("kernel", "kernel,\nus a row", "time"),
    ReportColumn("share", "% of\nall", "percent"),
    ReportColumn("analyze", "analyze,\nus a row", "time"),
    ReportColumn("analyze_share", "% of\nall", "percent"),
)


def steps(scene: BenchScene) -> list[tuple[str, tuple[str, ...], Demand]]:
    """Each part with the quantities of the parts up to it, and what is demanded beside them."""
    asked = scene.asked
    efforts = tuple(name for name in asked.loads if name.endswith(".effort"))
    first = (*asked.position, *asked.velocity)
    moving = asked.level("motion")
    parts = [("position", asked.position), ("+ velocity", first), ("+ acceleration", moving)]
    if efforts:
        parts.append(("+ effort", (*moving, *efforts)))
    if len(asked.loads) > len(efforts):
        parts.append(("+ reactions of all joints", asked.level("everything")))
    verdicts = ("+ verdicts of all rows", parts[-1][1], scene.verdicts("everything"))
    return [*((name, names, Demand.POSITION) for name, names in parts), verdicts]


def demand_table(scene: BenchScene, rounds: int) -> ReportTable:
    """One line for every step."""
    plan, session = steps(scene), scene.model.session.packed(Packing(0, 1))
    last = len(plan) - 1
    calls = [scene.kernel(names, scene.followed, BATCH, more=more) for _, names, more in plan]
    kernel = in_turns(dict(enumerate(calls)), rounds)
    whole = in_turns(
        {
            k: partial(analyze, session, names, verdicts=k == last)
            for k, (_, names, _) in enumerate(plan)
        },
        rounds,
    )
    rows: list[dict[str, Cell]] = [
        {
            "part": name,
            "kernel": MICRO * kernel[k].median / BATCH,
            "share": kernel[k].ratio(kernel[last]),
            "analyze": MICRO * whole[k].median / scene.result.rows,
            "analyze_share": whole[k].ratio(whole[last]),
        }
        for k, (name, _, _) in enumerate(plan)
    ]
    notes = (
        f"kernel: {BATCH} rows a call; analyze: {scene.result.rows} rows, with verdicts in the",
        "last line alone.",
        "each line computes all lines above it as well.",
    )
    name = "demand_" + key_of(scene.name)
    return ReportTable(name, f"{scene.name}: what skipping saves", DEMAND_COLUMNS, rows, notes)


THREAD_ROWS = 50_000

THREAD_COLUMNS = (
    ReportColumn("scene", "mechanism"),
    ReportColumn("threads", "threads", "number"),
    ReportColumn("microseconds", "us a row", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("gain", "times one\nthread", "ratio"),
)


def thread_table(scenes: Sequence[BenchScene], rounds: int, rows: int = THREAD_ROWS) -> ReportTable:
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
