"""What each part of the demand plan costs: the same rows with one part more at a time, by width."""

from __future__ import annotations

from functools import partial

from benchmark.kernel_case import (
    BATCH,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
)
from benchmark.specimen import Specimen

from mechkin_cli.bench.measurement import ROUNDS, in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable
from mechkin_cli.kernel.functions import widths
from mechkin_cli.plan.records import Demand

Step = tuple[str, tuple[str, ...], Demand]


def steps(specimen: Specimen) -> list[Step]:
    """Name, quantities, and what is computed beside them."""
    position, velocity, _ = specimen.motion
    _, moving, everything = specimen.levels
    return [
        ("position", position, Demand.POSITION),
        ("+ velocity", (*position, *velocity), Demand.POSITION),
        ("+ acceleration", moving, Demand.POSITION),
        ("+ effort", (*moving, specimen.loads[0]), Demand.POSITION),
        ("+ wrenches of all joints", everything, Demand.POSITION),
        ("+ condition, power error", everything, Demand.CONDITION | Demand.POWER),
    ]


def table(specimen: Specimen, rounds: int = ROUNDS) -> ReportTable:
    """Microseconds per row for every step and width."""
    case = KernelCase(specimen, degree_rows(specimen))
    inputs, guesses = repeated(case.inputs), repeated(case.second_order_guesses())
    planned = {name: PlannedRun(case, names, more) for name, names, more in steps(specimen)}
    calls = {
        (name, lanes): partial(run, inputs, guesses, lanes=lanes)
        for name, run in planned.items()
        for lanes in widths()
    }
    times = in_turns(calls, rounds)
    rows: list[dict[str, Cell]] = []
    for name in planned:
        row: dict[str, Cell] = {"part": name}
        row |= {f"lanes_{n}": 1e6 * times[name, n].median / BATCH for n in widths()}
        rows.append(row)
    widest, last = max(widths()), list(planned)[-1]
    for row, name in zip(rows, planned, strict=True):
        row["part_of_all"] = times[name, widest].ratio(times[last, widest])
    columns = (
        ReportColumn("part", "computed"),
        *(ReportColumn(f"lanes_{n}", f"{n} lanes\nus per row", "time") for n in widths()),
        ReportColumn("part_of_all", f"% of all\n({widest} lanes)", "percent"),
    )
    notes = (f"{BATCH} rows a call; each line computes all lines above it as well.",)
    title = f"{specimen.name}: what the parts of the demand plan cost"
    return ReportTable(f"demand_{specimen.name.lower()}", title, columns, rows, notes)
