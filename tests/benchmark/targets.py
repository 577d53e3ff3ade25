"""The targets: kernel and sweep against the yardstick, the process against bare imports."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

from benchmark.kernel_case import (
    BATCH,
    SWEEP_ROWS,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
    sweep_rows,
)
from benchmark.process import bare_imports, process_times
from benchmark.specimen import Specimen
from benchmark.yardstick_kernel import LEVELS, Yardstick

from benchmarks import sevenr
from mechkin_cli.bench.measurement import Timing, in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable
from mechkin_cli.kernel.functions import widths

KERNEL_LIMIT = 1.6
SWEEP_LIMIT = 2.5
PROCESS_LIMIT = 1.45

COLUMNS = (
    ReportColumn("case", "case"),
    ReportColumn("microseconds", "mechkin\nus", "time"),
    ReportColumn("other", "other\nus", "time"),
    ReportColumn("ratio", "\nratio", "ratio"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("limit", "\nlimit", "ratio"),
    ReportColumn("met", "\nmet", "verdict"),
)

YARDSTICK_NAMES = {"RCSR": "rcsr", "7R": "sevenr"}

Owner = Literal["mechkin", "yardstick"]


def table(specimen: Specimen, yardstick: Yardstick) -> ReportTable:
    """Kernel and sweep against the yardstick on its own copy, per lane width."""
    coarse = KernelCase(specimen, degree_rows(specimen))
    fine = KernelCase(specimen, sweep_rows(specimen))
    other_case = yardstick.case(YARDSTICK_NAMES[specimen.name])
    inputs, guesses = repeated(coarse.inputs), repeated(coarse.second_order_guesses())
    runs = [PlannedRun(coarse, names) for names in specimen.levels]
    shared = [lanes for lanes in widths() if lanes in yardstick.widths]
    calls: dict[tuple[Owner, str, int], Callable[[], object]] = {}
    for lanes in shared:
        for level, name in enumerate(LEVELS):
            calls["mechkin", name, lanes] = partial(runs[level], inputs, guesses, lanes=lanes)
            calls["yardstick", name, lanes] = other_case.call(lanes, level)
        everything = PlannedRun(fine, specimen.levels[2])
        calls["mechkin", "sweep", lanes] = fine.sweep(everything, lanes)
        calls["mechkin", "following", lanes] = fine.following(everything)
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
        mine = times["mechkin", "following", lanes]
        rows.append(_row("of which following", mine, other, SWEEP_ROWS, BATCH))
    notes = (
        f"us per row, {BATCH} rows a call; each line of a width with all above it.",
        "other: the yardstick at the same width without contraction, two Newton steps,",
        f"no tests; its largest position error is {other_case.position_error(max(shared)):.0e}.",
        "sweep: follow and run with everything, against as many rows of the yardstick.",
    )
    title = f"{specimen.name} against the yardstick"
    return ReportTable(f"yardstick_{specimen.name.lower()}", title, COLUMNS, rows, notes)


def process_table(rcsr: Path, peer: Sequence[str] = ()) -> ReportTable:
    """Whole processes: `mechkin analyze` of RCSR and of 361 rows of 7R, against bare imports.

    Args:
        rcsr: the mechanism's file.
        peer: a command line that does the work of the 7R file by other means, with FILE and DIR for
            the file and a folder; () for none.

    Raises:
        CalledProcessError: a process failed.
    """
    idle = bare_imports()
    with TemporaryDirectory(prefix="mechkin-7r-") as folder:
        file = Path(folder) / "7r.yaml"
        file.write_text(sevenr.text(), encoding="utf-8")
        mine, (other,) = process_times(rcsr, [idle])
        rows = [_row("RCSR, bare imports", mine, other, 1, 1, PROCESS_LIMIT)]
        mine, others = process_times(file, [idle, peer] if peer else [idle])
    names = (f"7R, {SWEEP_ROWS} rows, bare imports", f"7R, {SWEEP_ROWS} rows, Pinocchio")
    limits = (PROCESS_LIMIT, None)  # a peer has no limit
    rows += [
        _row(name, mine, o, 1, 1, limit)
        for name, o, limit in zip(names, others, limits, strict=False)
    ]
    notes = (
        "mechkin analyze FILE, us, medians of processes in turns; bare imports:",
        f'python -c "{idle[-1]}"',
    )
    return ReportTable("process", "the whole process", COLUMNS, rows, notes)


def _row(
    name: str, mine: Timing, other: Timing, rows: int, other_rows: int, limit: float | None = None
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
