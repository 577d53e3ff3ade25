"""Following the branch of the first assembly along all rows: a guess for every row it reaches."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

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
    from mechkin_cli.solver.route import Way
    from mechkin_cli.solver.session import Session


def follow_rows(session: Session, start: Start, *, every_row: bool = False) -> Rows:
    """Guesses for the rows on the branch through the start, onward and backward from its row.

    With `every_row` each row is a careful step instead of a place filled in between two.
    """
    count = session.inputs.values.shape[1]
    if start.state is None:
        rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), count)
        rows.status[:] = start.status
        return rows
    if start.row == 0:
        way = _Way.along(session, 0, 1)
        followed = way.follow(start.state, every_row)
        rows = Rows.followed(followed)
        rows.nodes = _go_on(way, followed, rows, every_row)
    else:
        rows = Rows.without_guesses(session.layout.states, turn_count(session.plan), count)
        for step in (-1, 1):
            way = _Way.along(session, start.row, step)
            followed = way.follow(start.state, every_row)
            part = rows.part(slice(start.row, None, step))
            part.take(followed, 0)
            rows.nodes += _go_on(way, followed, part, every_row)
    _wrap_from_first(session.layout, rows)
    return rows


class _Way(NamedTuple):
    """Rows in the order in which they are followed: their inputs (inputs, rows), and the way along
    the inputs' course where they have one."""

    session: Session
    path: Floats
    course: Way | None

    @classmethod
    def along(cls, session: Session, row: int, step: int) -> _Way:
        """From a row on, or with step -1 back from it."""
        path = np.ascontiguousarray(session.inputs.values[:, row::step])
        return cls(session, path, None if session.route is None else session.route.way(row, step))

    def from_place(self, inputs: Floats, row: int) -> _Way:
        """From some inputs straight to the row with a number in this way, and on."""
        path = np.column_stack((inputs, self.path[:, row:]))
        if self.course is None or self.session.route is None:
            return self._replace(path=path)
        number = int(self.course.rows[self.course.real[row]])
        return self._replace(
            path=path, course=self.session.route.way_from(inputs, self.course, number)
        )

    def follow(self, start: Floats, every_row: bool, turn: Floats | None = None) -> Followed:
        """The branch through a start along the way."""
        if self.course is None:
            follow = self.session.follow
            return follow(self.path, start, every_row=every_row, turns=True, turn=turn)
        return self.session.follow_way(
            self.course, start, every_row=every_row, turns=True, turn=turn
        )


def _go_on(way: _Way, followed: Followed, rows: Rows, every_row: bool) -> int:
    """Finds out what ended a way, and follows it on, back from dead centres; returns the steps
    taken in all."""
    steps = followed.steps
    while followed.end != TrackEnd.FINISHED:
        from mechkin_cli.analysis.sweep.branch_end import explain_end

        back = explain_end(way.session, way.path, way.course, followed, rows)
        if back is None:
            break
        # the row before is near the dead centre: go on from the last regular place of the branch
        way = way.from_place(followed.inputs, back)
        rows = rows.part(slice(back - 1, None))
        followed = way.follow(followed.state, every_row, followed.turn)
        rows.take(followed, 1)
        steps += followed.steps
    return steps


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
