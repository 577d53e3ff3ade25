"""Rows beyond the limits of coordinates: they are solved, and say that the mechanism ends before
them."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism import dimension_of
from mechkin_cli.row_notes import Found, RowNote, RowSet
from mechkin_cli.verdict import Status, has_forces

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Limit, Problem, Wanted
    from mechkin_cli.sweep.rows import RunRows


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
                words = partial(_note, problem, limit, end)
                rows.diagnostics.append(
                    RowNote(
                        Status.beyond_limit.label,
                        "warning",
                        (limit.name, side),
                        there,
                        words,
                        np.abs(values - end),
                        values.__getitem__,
                    )
                )


def _note(problem: Problem, limit: Limit, end: float, found: Found) -> Diagnostic:
    farthest = float(found.told)
    units, dimension = problem.units, dimension_of(limit.coordinate)
    value, at = (float(units.from_si(x, dimension)) for x in (farthest, end))
    unit = units.label(dimension)
    return Diagnostic(
        Status.beyond_limit.label,
        "warning",
        f"{_rows(found.rows)} beyond the "
        f"{'least' if end == limit.low else 'largest'} value of {limit.name}: the mechanism does "
        "not come there",
        limit.place,
        measured=units.text(farthest, dimension),
        limit=units.text(end, dimension),
        hint="let the run end at the limit, or widen the limit",
        numbers=(Number(limit.name, value, unit, limit=at),),
    )


def _rows(rows: RowSet) -> str:
    if rows.size == 1:
        return f"row {rows.first} lies"
    if rows.last - rows.first + 1 == rows.size:
        return f"rows {rows.first} to {rows.last} lie"
    return f"{rows.size} rows, first row {rows.first}, lie"
