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
    from mechkin_cli.solver.follow import Followed
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session


def follow_rows(session: Session, start: Start, *, every_row: bool = False) -> Rows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    values = session.inputs.values
    count = values.shape[1]
    if start.state is None:
        rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), count)
        rows.status[:] = start.status
        return rows
    if start.row == 0:
        followed = session.follow_rows(start.state, every_row=every_row)
        rows = Rows.followed(followed)
        _explain(session, values, followed, rows)
    else:
        rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), count)
        for way in (slice(start.row, None, -1), slice(start.row, None)):
            path = np.ascontiguousarray(values[:, way])
            followed = session.follow_rows(
                start.state, start.row, way.step or 1, every_row=every_row
            )
            part = rows.part(way)
            part.take(followed, 0)
            if way.step == -1:
                part.section *= -1
            rows.nodes += followed.steps
            _explain(session, path, followed, part)
    _wrap_from_first(session.layout, rows)
    return rows


def _explain(session: Session, path: Floats, followed: Followed, rows: Rows) -> None:
    """Says which branch points a way passed, and what ended it, if it ended."""
    if followed.crossings:
        from mechkin_cli.analysis.sweep.branch_end import crossing_note

        rows.diagnostics.append(crossing_note(session, followed))
    if followed.end != TrackEnd.FINISHED and not rows.reached.all():
        from mechkin_cli.analysis.sweep.branch_end import explain_end

        explain_end(session, path, followed, rows)


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
