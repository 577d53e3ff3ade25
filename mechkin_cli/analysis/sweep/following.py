"""Following the branch of the first assembly along all rows: a guess for every row it reaches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.sweep.rows import Rows
from mechkin_cli.solver.closing_turns import turn_count
from mechkin_cli.solver.follow import TrackEnd
from mechkin_cli.solver.search import wrap_angles

if TYPE_CHECKING:
    from mechkin_cli.analysis.assembly.start import Start
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session


def follow_rows(session: Session, start: Start, *, every_row: bool = False) -> Rows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    values = session.inputs.values
    rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), values.shape[1])
    if start.state is None:
        rows.status[:] = start.status
        return rows
    onward, backward = slice(start.row, None), slice(start.row, None, -1)
    for way in (backward, onward) if start.row else (onward,):
        path = np.ascontiguousarray(values[:, way])
        rows.nodes += _follow_way(session, path, start.state, rows.part(way), every_row)
    _wrap_from_first(session.layout, rows)
    return rows


def _follow_way(session: Session, path: Floats, state: Floats, rows: Rows, every_row: bool) -> int:
    """Follows rows from the first of them, back from dead centres, too; returns the steps taken."""
    steps = first = 0
    turn: Floats | None = None
    while True:
        followed = session.follow(path, state, every_row=every_row, turns=True, turn=turn)
        steps += followed.steps
        rows.states[:, first:] = followed.guess[:, first:]
        rows.limit[first:] = followed.limit[first:]
        if followed.turns is not None:
            known = slice(first, followed.reached)
            rows.turns[:, known] = followed.turns[:, known]
        rows.reached[first:] = np.arange(first, rows.reached.size) < followed.reached
        if followed.end == TrackEnd.FINISHED:
            return steps
        from mechkin_cli.analysis.sweep.branch_end import explain_end

        back = explain_end(session, path, followed, rows)
        if back is None:
            return steps
        # the row before is near the dead centre: go on from the last regular place of the branch
        path = np.column_stack((followed.inputs, path[:, back:]))
        state, turn = followed.state, followed.turn
        rows, first = rows.part(slice(back - 1, None)), 1


def _wrap_from_first(layout: Layout, rows: Rows) -> None:
    """Angles are continuous from the first row, which lies in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    before = rows.states[:, first].copy()
    wrapped = before[:, None].copy()
    wrap_angles(layout, wrapped)
    turns = wrapped - before[:, None]
    if turns.any():
        rows.states += turns
