"""What each part of the demand plan costs: the same rows with one part more at a time, by width."""

from __future__ import annotations

from functools import partial

from mechkin_cli.benchmark.kernel_case import (
    BATCH,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
    widths,
)
from mechkin_cli.benchmark.rcsr import Dimensions
from mechkin_cli.benchmark.reference import ACCELERATIONS, EVERYTHING, POSITIONS, VELOCITIES
from mechkin_cli.benchmark.report import Cell, Column, Table
from mechkin_cli.benchmark.timing import in_turns
from mechkin_cli.solver.codes import Demand

MOTION = (*POSITIONS, *VELOCITIES, *ACCELERATIONS)

STEPS: tuple[tuple[str, tuple[str, ...], Demand], ...] = (
    ("position", POSITIONS, Demand.POSITION),
    ("+ velocity", (*POSITIONS, *VELOCITIES), Demand.POSITION),
    ("+ acceleration", MOTION, Demand.POSITION),
    ("+ effort", (*MOTION, "O1.effort"), Demand.POSITION),
    ("+ wrenches of all joints", EVERYTHING, Demand.POSITION),
    ("+ condition, power error", EVERYTHING, Demand.CONDITION | Demand.POWER),
)
"""Name, quantities, and what is computed beside them."""


def table(size: Dimensions) -> Table:
    """Microseconds per row for every step and width."""
    case = KernelCase(size, degree_rows())
    inputs, guesses = repeated(case.inputs), repeated(case.second_order_guesses())
    planned = {name: PlannedRun(case, names, more) for name, names, more in STEPS}
    calls = {
        (name, lanes): partial(run, inputs, guesses, lanes=lanes)
        for name, run in planned.items()
        for lanes in widths()
    }
    times = in_turns(calls)
    rows: list[dict[str, Cell]] = []
    for name in planned:
        row: dict[str, Cell] = {"part": name}
        row |= {f"lanes_{n}": 1e6 * times[name, n].median / BATCH for n in widths()}
        rows.append(row)
    widest = max(widths())
    for row, name in zip(rows, planned, strict=True):
        row["part_of_all"] = times[name, widest].ratio(times[STEPS[-1][0], widest])
    columns = (
        Column("part", "computed"),
        *(Column(f"lanes_{n}", f"{n} lanes\nus per row", "time") for n in widths()),
        Column("part_of_all", f"% of all\n({widest} lanes)", "percent"),
    )
    notes = (f"{BATCH} rows a call; each line computes all lines above it as well.",)
    return Table("demand", "what the parts of the demand plan cost", columns, rows, notes)
