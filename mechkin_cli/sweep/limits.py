"""Rows beyond the limits of coordinates: they are solved, and say that the mechanism ends before
them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import dimension_of
from mechkin_cli.verdict import Status, has_forces

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import Limit, Problem, Wanted
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep.rows import RunRows, SweepRows


def limited(problem: Problem) -> dict[Wanted, Limit]:
    """The coordinates that have limits, of those that are followed."""
    known = problem.quantities() if problem.limits else {}
    return {known[limit.name]: limit for limit in problem.limits if limit.name in known}


def judge_limits(result: RunRows) -> None:
    """Gives the rows beyond limits their status, and names the limits."""
    problem, rows = result.problem, result.row_states
    for wanted, limit in limited(problem).items():
        values = np.broadcast_to(np.asarray(result.quantity(wanted.name).value), rows.reached.shape)
        off = limit.beyond(values, result.session.layout.length)
        out = rows.reached & (np.abs(off) > 0.0)
        if not out.any():
            continue
        rows.status[out & has_forces(rows.status)] = Status.beyond_limit
        for side, end in ((-1.0, limit.low), (1.0, limit.high)):
            there = out & (side * off > 0.0)
            if there.any():
                rows.diagnostics.append(_note(rows, problem, limit, end, values, there))


def _note(
    rows: SweepRows, problem: Problem, limit: Limit, end: float, values: Floats, there: Bools
) -> Diagnostic:
    numbers = np.flatnonzero(there)
    farthest = float(values[numbers[np.argmax(np.abs(values[numbers] - end))]])
    units, dimension = problem.units, dimension_of(limit.coordinate)
    value, at = (float(units.from_si(x, dimension)) for x in (farthest, end))
    unit = units.label(dimension)
    return Diagnostic(
        Status.beyond_limit.label,
        "warning",
        f"{_rows(numbers + rows.span.first)} beyond the "
        f"{'least' if end == limit.low else 'largest'} value of {limit.name}: the mechanism does "
        "not come there",
        limit.place,
        measured=units.text(farthest, dimension),
        limit=units.text(end, dimension),
        hint="let the run end at the limit, or widen the limit",
        numbers=(Number(limit.name, value, unit, limit=at),),
    )


def _rows(numbers: NDArray[np.intp]) -> str:
    first, last = numbers[0] + 1, numbers[-1] + 1
    if len(numbers) == 1:
        return f"row {first} lies"
    if last - first + 1 == len(numbers):
        return f"rows {first} to {last} lie"
    return f"{len(numbers)} rows, first row {first}, lie"
