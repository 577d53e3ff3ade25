"""The rows of a sweep followed along the inputs from the first assembly, and why they end."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.plan import TrackEnd
from mechkin_cli.session import ORIENTATION, turn_count
from mechkin_cli.sweep.rows import SweepRows

if TYPE_CHECKING:
    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.session import Followed, Session
    from mechkin_cli.show import Floats


def follow_rows(session: Session, start: AssemblyStart, *, every_row: bool = False) -> SweepRows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    values = session.inputs.values
    count = values.shape[1]
    if start.state is None:
        rows = SweepRows.without_guesses(session.layout.states, turn_count(session.plan), count)
        rows.status[:] = start.status
        return rows
    first = _first_row(session, start, every_row)
    if first is not None:
        followed = session.follow_rows(first, every_row=every_row)
        rows = SweepRows.followed(followed)
        _explain(session, values, followed, rows)
    else:
        rows = SweepRows.without_guesses(session.layout.states, turn_count(session.plan), count)
        for step in (-1, 1):
            onward = slice(start.row, None, step)
            followed = session.follow_rows(start.state, start.row, step, every_row=every_row)
            part = rows.part(onward)
            part.take(followed, 0)
            part.section *= step
            rows.nodes += followed.steps
            _explain(session, np.ascontiguousarray(values[:, onward]), followed, part)
    _count_from_first(session, rows)
    return rows


def _first_row(session: Session, start: AssemblyStart, every_row: bool) -> Floats | None:
    """The states of the first row where all rows are followed from it: where it is the start, and
    where a way of whole turns leads back to it, so that one turn serves them all."""
    if start.row == 0 or start.state is None:
        return start.state
    if session.route is not None or not np.ptp(session.inputs.whole, axis=1).any():
        return None
    back = session.follow_rows(start.state, start.row, -1, every_row=every_row)
    return back.guess[:, -1] if back.end == TrackEnd.FINISHED else None


def _explain(session: Session, path: Floats, followed: Followed, rows: SweepRows) -> None:
    """Says which branch points were passed, and what ended the branch, if it ended."""
    if not (followed.crossings or followed.end != TrackEnd.FINISHED):
        return
    from mechkin_cli.sweep import branch_end

    if followed.crossings:
        rows.diagnostics.append(branch_end.crossing_note(session, followed))
    if followed.end != TrackEnd.FINISHED and not rows.reached.all():
        branch_end.explain_end(session, path, followed, rows)


def _count_from_first(session: Session, rows: SweepRows) -> None:
    """Turns count from the first row, whose angles lie in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    # half a turn is +180, whichever side of it rounding has
    for state, slot in session.turn_slots.tree.items():
        below = rows.states[state, first] <= tolerances.HALF_TURN_SIDE - pi
        turns = rows.turns[slot, first] - (1.0 if below else 0.0)
        if turns:
            rows.turns[slot] -= turns
    for (_, freedom), slot in session.turn_slots.closing.items():
        if freedom != ORIENTATION:
            beyond = rows.turns[slot, first] - pi - tolerances.HALF_TURN_SIDE
            turns = float(np.ceil(beyond / (2.0 * pi)))
            if turns:
                rows.turns[slot] -= turns * (2.0 * pi)
