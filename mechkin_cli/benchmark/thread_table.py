"""What threads gain: one call of the kernel for many rows, by the clock on the wall."""

from __future__ import annotations

from time import perf_counter

from mechkin_cli.benchmark.report import Cell, Column, Table
from mechkin_cli.benchmark.scene import Scene
from mechkin_cli.benchmark.timing import in_turns
from mechkin_cli.kernel import _kernel
from mechkin_cli.session import Packing

ROWS = 50_000
MICRO = 1000.0 * 1000.0

COLUMNS = (
    Column("scene", "mechanism"),
    Column("threads", "threads", "number"),
    Column("microseconds", "us a row", "time"),
    Column("spread", "+-\n%", "percent"),
    Column("gain", "times one\nthread", "ratio"),
)


def thread_table(scenes: list[Scene], rounds: int, rows: int = ROWS) -> Table:
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
    return Table("threads", "What threads gain", COLUMNS, lines, notes)
