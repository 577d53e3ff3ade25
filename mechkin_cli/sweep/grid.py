"""The rows of a grid: lines on which only the fast of two inputs moves.

One line after the other is followed both ways from a row that is reached straight from the line
before, so that the end of the branch on one line does not end the others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.session import turn_count
from mechkin_cli.sweep import branch_end, retracing
from mechkin_cli.sweep.following import count_from_first, explain_way, follow_rows
from mechkin_cli.sweep.rows import SweepRows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart
    from mechkin_cli.session import Session
    from mechkin_cli.show import Floats

_LINE_SECTIONS = 1 << 20
"""Sections of a line of a grid at most."""


def follow_grid(session: Session, start: AssemblyStart, *, every_row: bool = False) -> SweepRows:
    """Guesses for the rows of a grid on the branch through the start, from its row on; arguments as
    those of `follow_rows`."""
    grid = session.problem.motion.grid
    if grid is None or start.state is None:
        return follow_rows(session, start, every_row=every_row)
    rows = _Lines(session, grid[1], every_row).follow(start)
    count_from_first(session, rows)
    return rows


class _Lines:
    """The rows of a session in lines of a width, while they are followed."""

    def __init__(self, session: Session, width: int, every_row: bool) -> None:
        self.session, self.width, self.every_row = session, width, every_row
        count = session.inputs.values.shape[1]
        self.lines = count // width
        self.rows = SweepRows.without_guesses(
            session.layout.states, turn_count(session.plan), count
        )

    def follow(self, start: AssemblyStart) -> SweepRows:
        """All rows, from the assembly at its row on."""
        assert start.state is not None
        self._along(start.row, start.state, None)
        first = start.row // self.width
        for step, lines in ((1, range(first + 1, self.lines)), (-1, range(first - 1, -1, -1))):
            row = start.row
            for line in lines:
                found = self._onto(line, row, step)
                if found is None:
                    self._explain(line, step)
                    break
                row = found
        self.rows.diagnostics = branch_end.without_repeats(self.rows.diagnostics)
        return self.rows

    def _along(self, row: int, state: Floats, turn: Floats | None) -> None:
        """Follows the line of a row from there both ways."""
        first = row - row % self.width
        for step, last in ((-1, first), (1, first + self.width - 1)):
            followed = self.session.follow_rows(
                state, row, step, every_row=self.every_row, turn=turn, last=last
            )
            end = last + step
            part = self.rows.part(slice(row, end if end >= 0 else None, step))
            part.take(followed, 0)
            part.section *= step
            part.nodes += followed.steps
            explain_way(self.session, followed, part, self.every_row)
            self.rows.nodes = part.nodes
        if self.session.problem.assembly.straight:
            # sides are compared within a section: a line has its own
            self.rows.section[first : first + self.width] += _LINE_SECTIONS * first

    def _onto(self, line: int, near: int, step: int) -> int | None:
        """Follows a line from the row next to that of the line before which lies nearest to `near`
        and leads there; the row, None where none does."""
        for row in self._reached(line - step, near):
            to = int(row) + step * self.width
            inputs = np.ascontiguousarray(self.session.inputs.values[:, to])
            found = retracing.straight_to(self.session, self._place(int(row)), inputs)
            if found is not None:
                self._along(to, found.state, found.turn)
                return to
        return None

    def _reached(self, line: int, near: int) -> NDArray[np.intp]:
        """The rows of a line that are reached, in the order of their distance from one's column."""
        rows = np.arange(line * self.width, (line + 1) * self.width)
        rows = rows[self.rows.reached[rows]]
        return rows[np.argsort(np.abs(rows % self.width - near % self.width), kind="stable")]

    def _place(self, row: int) -> retracing.Place:
        inputs = np.ascontiguousarray(self.session.inputs.values[:, row])
        turn = np.ascontiguousarray(self.rows.turns[:, row])
        return retracing.Place(inputs, retracing.closed(self.session, self.rows, row), turn)

    def _explain(self, line: int, step: int) -> None:
        """Says why no row of a line is reached, and gives it and those behind it their status."""
        reached = np.sort(self._reached(line - step, 0))
        row = int(reached[-1 if step > 0 else 0])
        start = self._place(row)
        to = self.session.inputs.values[:, row + step * self.width]
        path = np.stack([start.inputs, to], axis=1)
        followed = self.session.follow(path, start.state, every_row=True)
        rest = self.rows.part(slice(row, None, step))
        values = np.ascontiguousarray(self.session.inputs.values[:, rest.numbers])
        branch_end.explain_end(self.session, values, followed, rest)
