"""Following the branch of the first assembly along all rows: a guess for every row it reaches."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.sweep.rows import Rows
from mechkin_cli.solver.closing_turns import (
    ORIENTATION,
    tree_slots,
    turn_count,
    turn_slots,
)
from mechkin_cli.solver.follow import TrackEnd

if TYPE_CHECKING:
    from collections.abc import Callable

    from mechkin_cli.analysis.assembly.start import Start
    from mechkin_cli.arrays import Floats
    from mechkin_cli.solver.follow import Followed
    from mechkin_cli.solver.session import Session


class _Way(NamedTuple):
    """Inputs (inputs, rows) on the way: as they are, and angles without their whole turns."""

    values: Floats
    reduced: Floats
    whole: Floats

    def part(self, rows: slice) -> _Way:
        return _Way(*(np.ascontiguousarray(table[:, rows]) for table in self))

    def after(self, place: Floats, row: int) -> _Way:
        """From a place (inputs,) on to the rows from `row` on; the place's angles have the whole
        turns of that row."""
        reduced = place - (self.values[:, row] - self.reduced[:, row])
        tables = zip(self, (place, reduced, self.whole[:, row]), strict=True)
        return _Way(*(np.column_stack((first, table[:, row:])) for table, first in tables))


def follow_rows(session: Session, start: Start, *, every_row: bool = False) -> Rows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    inputs = session.inputs
    way = _Way(inputs.values, inputs.reduced, inputs.whole)
    count = way.values.shape[1]
    if start.state is None:
        rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), count)
        rows.status[:] = start.status
        return rows
    first = _first_row(session, way, start, every_row)
    if first is not None:
        followed = _follow(session, way, first, every_row)
        rows = Rows.followed(followed)
        rows.nodes = _go_on(session, way, followed, rows, every_row)
    else:
        rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), count)
        for direction in (slice(start.row, None, -1), slice(start.row, None)):
            path = way.part(direction)
            followed = _follow(session, path, start.state, every_row)
            part = rows.part(direction)
            part.take(followed, 0)
            rows.nodes += _go_on(session, path, followed, part, every_row)
    _count_from_first(session, rows)
    return rows


def _first_row(session: Session, way: _Way, start: Start, every_row: bool) -> Floats | None:
    """The states of the first row where all rows are followed from it: where it is the start, and
    where a way of whole turns leads back to it, so that one turn serves them all."""
    if start.row == 0 or start.state is None:
        return start.state
    if not np.ptp(way.whole, axis=1).any():
        return None
    back = _follow(session, way.part(slice(start.row, None, -1)), start.state, every_row)
    return back.guess[:, -1] if back.end == TrackEnd.FINISHED else None


def _follow(
    session: Session, way: _Way, state: Floats, every_row: bool, turn: Floats | None = None
) -> Followed:
    return session.follow(
        way.reduced, state, every_row=every_row, turns=True, turn=turn, whole=way.whole
    )


def _go_on(session: Session, way: _Way, followed: Followed, rows: Rows, every_row: bool) -> int:
    """Finds out what ended a way, and follows it on, back from dead centres; returns the steps
    taken in all."""
    steps = followed.steps
    while followed.end != TrackEnd.FINISHED:
        from mechkin_cli.analysis.sweep.branch_end import explain_end

        back = _on_one_turn(session, followed, rows, explain_end, way.values)
        if back is None:
            break
        # the row before is near the dead centre: go on from the last regular place of the branch
        way = way.after(followed.inputs, back)
        rows = rows.part(slice(back - 1, None))
        followed = _follow(session, way, followed.state, every_row, followed.turn)
        rows.take(followed, 1)
        steps += followed.steps
    return steps


def _on_one_turn(
    session: Session,
    followed: Followed,
    rows: Rows,
    explain: Callable[[Session, Floats, Followed, Rows], int | None],
    path: Floats,
) -> int | None:
    """Explains an end with the tree's angles as they go on from the last place followed; rows that
    are filled in then get their turns."""
    if not followed.turn_is_known:
        return explain(session, path, followed, rows)
    assert followed.turn is not None
    slots = tree_slots(session.plan)
    near = np.flatnonzero(rows.reached)
    shift = np.zeros((rows.states.shape[0], rows.reached.size))
    for state, slot in slots.items():
        shift[state, near] = (rows.turns[slot, near] - followed.turn[slot]) * (2.0 * pi)
    rows.states += shift
    before = rows.reached.copy()
    back = explain(session, path, followed, rows)
    rows.states -= shift
    for row in np.flatnonzero(rows.reached & ~before):
        _take_turns_beside(session, rows, int(row), followed, slots)
    return back


def _take_turns_beside(
    session: Session, rows: Rows, row: int, followed: Followed, slots: dict[int, int]
) -> None:
    """The turns of a row that was filled in next to a dead centre: those of the row before, or of
    the last place followed."""
    turn = followed.turn if row == 0 or not rows.reached[row - 1] else rows.turns[:, row - 1]
    assert turn is not None
    known = np.isnan(rows.turns[:, row])
    rows.turns[known, row] = turn[known]
    for state, slot in slots.items():
        whole = np.rint(rows.states[state, row] / (2.0 * pi))
        rows.states[state, row] -= whole * (2.0 * pi)
        assert followed.turn is not None
        rows.turns[slot, row] = followed.turn[slot] + whole


def _count_from_first(session: Session, rows: Rows) -> None:
    """Turns count from the first row, whose angles lie in (-180, 180] degrees."""
    if not rows.reached.any():
        return
    first = int(np.argmax(rows.reached))
    # half a turn is +180, whichever side of it rounding has
    for state, slot in tree_slots(session.plan).items():
        below = rows.states[state, first] <= tolerances.HALF_TURN_SIDE - pi
        rows.turns[slot] -= rows.turns[slot, first] - (1.0 if below else 0.0)
    for (_, freedom), slot in turn_slots(session.plan).items():
        if freedom != ORIENTATION:
            beyond = rows.turns[slot, first] - pi - tolerances.HALF_TURN_SIDE
            turns = np.ceil(beyond / (2.0 * pi))
            rows.turns[slot] -= turns * (2.0 * pi)
