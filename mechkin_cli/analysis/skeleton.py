"""Following the branch of the first assembly along all rows: a guess for every row it reaches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.rows import RowStates
from mechkin_cli.analysis.setup import Setup
from mechkin_cli.solver.follow import TrackEnd, follow
from mechkin_cli.solver.layout import Layout
from mechkin_cli.solver.search import wrap_angles

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


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
        rows.nodes += _follow_way(setup, path, start.state, rows.part(way), every_row)
    _wrap_from_first(setup.layout, rows)
    return rows


def _follow_way(setup: Setup, path: Floats, state: Floats, rows: RowStates, every_row: bool) -> int:
    """Follows rows from the first of them, back from dead centres, too; returns the steps taken."""
    steps = first = 0
    while True:
        followed = follow(setup.outputs.plan, path, state, every_row=every_row)
        steps += followed.steps
        rows.guess[:, first:] = followed.guess[:, first:]
        rows.limit[first:] = followed.limit[first:]
        rows.reached[first:] = np.arange(first, rows.reached.size) < followed.reached
        if followed.end == TrackEnd.FINISHED:
            return steps
        from mechkin_cli.analysis.branch_end import explain_end

        back = explain_end(setup, path, followed, rows)
        if back is None:
            return steps
        # the row before is near the dead centre: go on from the last regular place of the branch
        path = np.column_stack((followed.inputs, path[:, back:]))
        state, rows, first = followed.state, rows.part(slice(back - 1, None)), 1


def _wrap_from_first(layout: Layout, rows: RowStates) -> None:
    """Angles are continuous from the first row, which lies in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    before = rows.guess[:, first].copy()
    wrapped = before[:, None].copy()
    wrap_angles(layout, wrapped)
    rows.guess += wrapped - before[:, None]
