"""What a row costs: a call of the kernel, a sweep that is followed and run, a whole analysis."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from mechkin_cli.benchmark.kernel_case import (
    BATCH,
    SWEEP_ROWS,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
    sweep_rows,
)
from mechkin_cli.benchmark.report import Cell, Column, Table
from mechkin_cli.benchmark.specimen import Specimen
from mechkin_cli.benchmark.timing import ROUNDS, in_turns

COLUMNS = (
    Column("route", "route"),
    Column("microseconds", "us per\nrow", "time"),
    Column("spread", "+-\n%", "percent"),
    Column("ratio", "times\nkernel", "time"),
)
NOTES = (
    f"kernel: {BATCH} rows a call, 1 degree apart, each predicted to second order.",
    f"sweep: {SWEEP_ROWS} rows; follow and run: the calls that analyze() makes of the kernel.",
)
EVERYTHING = "kernel, everything"


def table(specimen: Specimen, rounds: int = ROUNDS) -> Table:
    """Microseconds per row of every route, in the widest packs."""
    coarse = KernelCase(specimen, degree_rows(specimen))
    fine = KernelCase(specimen, sweep_rows(specimen))
    inputs, guesses = repeated(coarse.inputs), repeated(coarse.second_order_guesses())
    positions, _, everything = specimen.levels
    calls: dict[str, Callable[[], object]] = {
        "kernel, positions only": partial(PlannedRun(coarse, positions), inputs, guesses),
        EVERYTHING: partial(PlannedRun(coarse, everything), inputs, guesses),
        "sweep, follow and run": fine.sweep(PlannedRun(fine, everything)),
        "sweep, model.analyze()": partial(fine.model.analyze, everything),
    }
    counts = {name: BATCH if name.startswith("kernel") else SWEEP_ROWS for name in calls}
    times = in_turns(calls, rounds)
    unit = times[EVERYTHING].median / counts[EVERYTHING]
    rows: list[dict[str, Cell]] = [
        {
            "route": name,
            "microseconds": 1e6 * timing.median / counts[name],
            "spread": timing.spread,
            "ratio": timing.median / counts[name] / unit,
        }
        for name, timing in times.items()
    ]
    name = f"sweeps_{specimen.name.lower()}"
    return Table(name, f"{specimen.name}: what a row costs, one thread", COLUMNS, rows, NOTES)
