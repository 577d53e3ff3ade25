"""Following the branch of the first assembly along all rows: a guess for every row it reaches."""

from __future__ import annotations

import numpy as np

from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.analysis.setup import Setup
from mechkin_cli.solver.follow import TrackEnd, follow
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.search import wrap_angles


def follow_rows(setup: Setup, *, every_row: bool = False) -> RowStates:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    start, values = setup.start, setup.inputs.values
    rows = RowStates.without_guesses(setup.layout.states, setup.problem.motion.rows)
    if start.state is None:
        rows.status[:] = start.status
        return rows
    onward, backward = slice(start.row, None), slice(start.row, None, -1)
    for way in (backward, onward) if start.row else (onward,):
        path = np.ascontiguousarray(values[:, way])
        followed = follow(setup.outputs.plan, path, start.state, every_row=every_row)
        part = rows.part(way)
        part.guess[:], part.limit[:] = followed.guess, followed.limit
        part.reached[:] = np.arange(part.reached.size) < followed.reached
        rows.nodes += followed.steps
        if followed.end != TrackEnd.FINISHED:
            from mechkin_cli.analysis.branch_end import explain_end

            explain_end(setup, path, followed, part)
    _wrap_from_first(setup.layout, rows)
    return rows


def _wrap_from_first(layout: Layout, rows: RowStates) -> None:
    """Angles are continuous from the first row, which lies in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    before = rows.guess[:, first].copy()
    wrapped = before[:, None].copy()
    wrap_angles(layout, wrapped)
    rows.guess += wrapped - before[:, None]
