"""The targets: kernel and sweep against the yardstick, the process against one doing nothing."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Literal

from mechkin_cli.benchmark.kernel_case import (
    BATCH,
    SWEEP_ROWS,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
    sweep_rows,
    widths,
)
from mechkin_cli.benchmark.process import process_times
from mechkin_cli.benchmark.rcsr import Dimensions
from mechkin_cli.benchmark.reference import ACCELERATIONS, EVERYTHING, POSITIONS, VELOCITIES
from mechkin_cli.benchmark.report import Cell, Column, Table
from mechkin_cli.benchmark.timing import Timing, in_turns
from mechkin_cli.benchmark.yardstick import LEVELS, Yardstick

KERNEL_LIMIT = 2.5
SWEEP_LIMIT = 5.0
PROCESS_LIMIT = 1.4

COLUMNS = (
    Column("case", "case"),
    Column("microseconds", "mechkin\nus", "time"),
    Column("other", "other\nus", "time"),
    Column("ratio", "\nratio", "ratio"),
    Column("spread", "+-\n%", "percent"),
    Column("limit", "\nlimit", "ratio"),
    Column("met", "\nmet", "verdict"),
)

Owner = Literal["mechkin", "yardstick"]


def table(size: Dimensions, yardstick: Yardstick) -> Table:
    """Kernel and sweep against the yardstick, per lane width."""
    coarse = KernelCase(size, degree_rows())
    fine = KernelCase(size, sweep_rows())
    inputs, guesses = repeated(coarse.inputs), repeated(coarse.second_order_guesses())
    levels = (POSITIONS, (*POSITIONS, *VELOCITIES, *ACCELERATIONS), EVERYTHING)
    runs = [PlannedRun(coarse, names) for names in levels]
    shared = [lanes for lanes in widths() if lanes in yardstick.widths]
    calls: dict[tuple[Owner, str, int], Callable[[], object]] = {}
    for lanes in shared:
        for level, name in enumerate(LEVELS):
            calls["mechkin", name, lanes] = partial(runs[level], inputs, guesses, lanes=lanes)
            calls["yardstick", name, lanes] = yardstick.call(lanes, level)
        calls["mechkin", "sweep", lanes] = fine.sweep(PlannedRun(fine, EVERYTHING), lanes)
    times = in_turns(calls)
    rows: list[dict[str, Cell]] = []
    for lanes in shared:
        for level, name in enumerate(LEVELS):
            mine, other = times["mechkin", name, lanes], times["yardstick", name, lanes]
            limit = KERNEL_LIMIT if level == 2 else None
            rows.append(_row(f"{lanes} lanes, {name}", mine, other, BATCH, BATCH, limit))
        mine, other = times["mechkin", "sweep", lanes], times["yardstick", LEVELS[2], lanes]
        name = f"{lanes} lanes, sweep of {SWEEP_ROWS} rows"
        rows.append(_row(name, mine, other, SWEEP_ROWS, BATCH, SWEEP_LIMIT))
    notes = (
        f"us per row, {BATCH} rows a call; each line of a width with all above it.",
        "other: the yardstick at the same width without contraction, two Newton steps,",
        f"no tests; its largest position error is {yardstick.position_error(max(shared)):.0e}.",
        "sweep: follow and run with everything, against as many rows of the yardstick.",
    )
    return Table("yardstick", "against the yardstick", COLUMNS, rows, notes)


def process_table(file: Path, do_nothing: Path) -> Table:
    """`mechkin analyze` against a program of the same stack that computes nothing."""
    times = process_times(file, do_nothing)
    row = _row(f"mechkin analyze {file.name}", *times, 1, 1, PROCESS_LIMIT)
    notes = (
        f"us, medians of processes in turns; other: {do_nothing.name}, which imports the same",
        "libraries, declares as many commands and validates the same file.",
    )
    return Table("process", "the whole process", COLUMNS, [row], notes)


def _row(
    name: str, mine: Timing, other: Timing, rows: int, other_rows: int, limit: float | None
) -> dict[str, Cell]:
    ratio = mine.ratio(other, rows / other_rows)
    return {
        "case": name,
        "microseconds": 1e6 * mine.median / rows,
        "other": 1e6 * other.median / other_rows,
        "ratio": ratio,
        "spread": mine.spread,
        "limit": limit,
        "met": None if limit is None else ratio <= limit,
    }
