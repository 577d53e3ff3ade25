"""The rows of a sweep: states, and what is known of each row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import is_angle
from mechkin_cli.memo import remembered
from mechkin_cli.plan import TrackEnd
from mechkin_cli.session import ORIENTATION, continuous_angle, turn_count
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.assembly import AssemblyStart, PlacesBefore
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.session import EndOfRows, Followed, Session
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep.result import Columns, Result


def sections(found: Followed, rows: int) -> NDArray[np.int64]:
    """The number of branch points that a way passed before each row (rows,)."""
    if not found.crossings:
        return np.zeros(rows, dtype=np.int64)
    passed = [crossing.row for crossing in found.crossings]
    return np.searchsorted(np.sort(np.array(passed)), np.arange(rows), side="right")


@dataclass
class SweepRows:
    """States (states, rows), guesses until they are closed, and what is known about rows that have
    none; `limit` is the largest correction that a guess may still need, `numbers` counts the rows
    from 0 as the file does, `nodes` the steps with which they were followed. `turns` (turn slots,
    rows) are angles and quaternions of closing joints as following carried them along
    (`solver.closing_turns`). `section` (rows,) tells rows apart between which a branch point was
    passed; numbers say nothing but that. `ends` are the dead centres beyond which rows are missing,
    `dead_centres` the rows that stand at one, twice where either of two branches may be meant.
    """

    states: Floats
    limit: Floats
    reached: Bools
    status: NDArray[np.int8]
    nodes: int
    diagnostics: list[Diagnostic]
    numbers: NDArray[np.int64]
    turns: Floats
    section: NDArray[np.int64]
    ends: list[EndOfRows]
    dead_centres: list[PlacesBefore] = field(default_factory=list)

    @classmethod
    def without_guesses(cls, states: int, turns: int, rows: int) -> SweepRows:
        """Rows of which nothing is known yet; none is reached."""
        return cls(
            states=np.zeros((states, rows)),
            limit=np.zeros(rows),
            reached=np.zeros(rows, dtype=bool),
            status=np.full(rows, int(Status.ok), dtype=np.int8),
            nodes=0,
            diagnostics=[],
            numbers=np.arange(rows),
            turns=np.full((turns, rows), np.nan),
            section=np.zeros(rows, dtype=np.int64),
            ends=[],
        )

    @classmethod
    def followed(cls, found: Followed) -> SweepRows:
        """The rows of one way from the first, whose arrays become theirs."""
        count = found.limit.size
        turns = np.empty((0, count)) if found.turns is None else found.turns
        return cls(
            states=found.guess,
            limit=found.limit,
            reached=np.arange(count) < found.reached,
            status=np.zeros(count, dtype=np.int8),
            nodes=found.steps,
            diagnostics=[],
            numbers=np.arange(count),
            turns=turns,
            section=sections(found, count),
            ends=[],
        )

    def take(self, found: Followed, first: int) -> None:
        """Takes what a way found from its row `first` on."""
        known = slice(first, found.reached)
        self.states[:, first:] = found.guess[:, first:]
        self.limit[first:] = found.limit[first:]
        if found.turns is not None:
            self.turns[:, known] = found.turns[:, known]
        self.reached[first:] = np.arange(first, self.reached.size) < found.reached
        self.section[first:] = sections(found, self.reached.size)[first:]

    def part(self, rows: slice) -> SweepRows:
        """Some of the rows, in the slice's order: views of the same arrays."""
        arrays = (self.states[:, rows], self.limit[rows], self.reached[rows], self.status[rows])
        more = (self.nodes, self.diagnostics, self.numbers[rows], self.turns[:, rows])
        return SweepRows(*arrays, *more, self.section[rows], self.ends)

    @property
    def has_failed(self) -> bool:
        """Whether some row did not close."""
        return bool((self.status == Status.not_converged).any())


# Following the branch of the first assembly along all rows: a guess for every row it reaches.


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
            way = slice(start.row, None, step)
            followed = session.follow_rows(start.state, start.row, step, every_row=every_row)
            part = rows.part(way)
            part.take(followed, 0)
            part.section *= step
            rows.nodes += followed.steps
            _explain(session, np.ascontiguousarray(values[:, way]), followed, part)
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
    """Says which branch points a way passed, and what ended it, if it ended."""
    if followed.crossings:
        from mechkin_cli.sweep.branch_end import crossing_note

        rows.diagnostics.append(crossing_note(session, followed))
    if followed.end != TrackEnd.FINISHED and not rows.reached.all():
        from mechkin_cli.sweep.branch_end import explain_end

        explain_end(session, path, followed, rows)


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


# Continuous angles: the kernel gives them within a turn, following counts whole turns
# (`solver.closing_turns`).


@dataclass
class _Turning:
    """Angles of one sort: their names, outputs, and the rows of `Followed.turns` that count their
    turns; of inputs, their numbers."""

    names: list[str] = field(default_factory=list)
    outputs: list[int] = field(default_factory=list)
    turns: list[int] = field(default_factory=list)

    def add(self, name: str, output: int, turn: int) -> None:
        self.names.append(name)
        self.outputs.append(output)
        self.turns.append(turn)


@dataclass(frozen=True)
class _Angles:
    """The angles among some outputs: of inputs, of the tree and of closing joints."""

    driven: _Turning = field(default_factory=_Turning)
    tree: _Turning = field(default_factory=_Turning)
    closing: _Turning = field(default_factory=_Turning)


def make_continuous(result: Result, wanted: Sequence[Wanted], outputs: Floats) -> Columns:
    """Makes the angles among some outputs (outputs, rows) continuous from the first row, in place.

    Returns:
        What they are within a turn, of those that have turns.
    """
    rows, session = result.row_states, result.session
    angles = _angles(session, tuple(wanted))
    reached = rows.reached
    for output, number in zip(angles.driven.outputs, angles.driven.turns, strict=True):
        values = result.problem.motion.inputs[number].values
        outputs[output] = np.where(reached, values, outputs[output])
    rests: Columns = {}
    for some in (angles.tree, angles.closing):
        if not some.names:
            continue
        rest, turns = outputs[some.outputs], rows.turns[some.turns]
        if some is angles.closing:
            continuous = continuous_angle(rest, turns)
        else:
            continuous = rest + turns * (2.0 * pi)
        outputs[some.outputs] = continuous
        turned = ((continuous != rest) & reached).any(axis=1)
        rests |= {some.names[k]: rest[k] for k in np.flatnonzero(turned)}
    return rests


@remembered
def _angles(session: Session, wanted: tuple[Wanted, ...]) -> _Angles:
    found, layout, slots = _Angles(), session.layout, session.readout(wanted).slots
    inputs = {item.name: number for number, item in enumerate(session.problem.motion.inputs)}
    for quantity in filter(has_turns, wanted):
        name, output = quantity.name, slots[quantity.name].first
        turn = session.turn_slots.of_angle(layout, quantity)
        if name in inputs:
            found.driven.add(name, output, inputs[name])
        elif turn is not None:
            closing = layout.joint_reference[quantity.owner] < 0
            (found.closing if closing else found.tree).add(name, output, turn)
    return found


def has_turns(quantity: Wanted) -> bool:
    """Whether a quantity is an angle, which may have whole turns."""
    return quantity.kind == "coordinate" and is_angle(quantity.coordinate) and quantity.order == 0
