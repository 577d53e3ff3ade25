"""A sweep at rest: the branch of equilibria along the rows.

From an equilibrium at one row the branch is followed to both ends. Rows are taken in stretches
(stretch.py). Where the next row alone is not surely on the branch, this is followed by its
arclength: it gets there, or turns back before (a fold), and the mechanism snaps through.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import DrivenInput, dimension_of
from mechkin_cli.memo import remembered
from mechkin_cli.plan import TrackEnd
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.row_notes import RowSet
from mechkin_cli.session import Continued, input_unit
from mechkin_cli.statics.arc import Arc, End
from mechkin_cli.statics.newton import Balancing, search
from mechkin_cli.statics.places import Place, Places, Statics, eigen
from mechkin_cli.statics.stretch import Stretches
from mechkin_cli.sweep import first_assembly
from mechkin_cli.tape import TraceLost
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Rest
    from mechkin_cli.session import Exchanged, Precise, Session
    from mechkin_cli.show import Floats


@remembered
def rested(session: Session) -> Session:
    """The session of a sweep whose coordinates at rest are where the loads balance in each row; as
    it is without such."""
    rest = session.problem.motion.rest
    if rest is None or rest.solved:
        return session
    sized, start = first_assembly(session)
    if start.state is None:
        # the sweep says why there is no first assembly
        return _moved(session, rest._replace(solved=True), session.inputs.values)
    branch = _Branch(sized, rest)
    found = branch.follow(start.row, start.state)
    notes: tuple[Diagnostic, ...] = ()
    for _ in range(tolerances.MOST_REST_EXCHANGES):
        instead = branch.instead or (branch.arcs and _blocked(session, found)) or None
        if instead is None or found.start is None:
            break
        sized = _exchanged(sized, instead, found.start)
        branch = _Branch(sized, rest)
        assert found.start.state is not None
        further = branch.follow(found.start.row, found.start.state)
        if further.rest.rows < found.rest.rows:
            break
        if further.rest.rows == found.rest.rows and branch.instead is not None:
            break
        notes = (*notes, _exchange_note(instead))
        session, found = _exchanged(session, instead, found.start), further
    found = found._replace(rest=found.rest._replace(notes=(*notes, *found.rest.notes)))
    moved = _moved(session, found.rest, found.values)
    if found.start is None:
        return moved
    # the assembly that was chosen stands where the coordinates have not come to rest yet: chosen
    # where they have, it might be another
    return replace(moved, base=None, first=found.start._replace(chosen=start))


def _exchanged(session: Session, instead: Exchanged, start: Continued) -> Session:
    """The session in which another coordinate of the tree rests, from the place where it was
    followed on."""
    assert start.state is not None
    other = session.exchanged(instead.session.graph)
    problem, motion = session.problem, session.problem.motion
    joint, coordinate = instead.driven.name
    inputs, still = list(motion.inputs), np.zeros(motion.rows)
    orders = np.zeros((4, motion.rows))
    item = DrivenInput(joint, coordinate, still, still, still, still, orders)
    value = float(start.state[instead.driven.state])
    in_si = value * input_unit(other.layout, item)
    orders[0] = problem.units.from_si(in_si, dimension_of(coordinate))
    inputs[instead.number] = item._replace(values=still + in_si, written_orders=orders)
    motion = motion._replace(inputs=tuple(inputs), leader=motion.leading_number)
    problem = replace(problem, motion=motion).with_quantities_of(problem)
    return replace(other, problem=problem)


def _blocked(session: Session, found: _Rows) -> Exchanged | None:
    """What tells places apart where the straight way from a row to the next, which the sweep goes
    though the branch of equilibria does not, comes to a dead centre; None where it does not."""
    start = found.start
    if start is None or start.state is None or start.turns is None:
        return None
    moved = _moved(session, found.rest, found.values)
    for step in (1, -1):
        way = moved.follow_rows(start.state, start.row, step, turn=start.turns)
        if way.end != TrackEnd.FINISHED and way.turn is not None:
            known = Place(found.values[:, start.row], start.state, start.turns)
            place = Place(way.inputs, way.state, way.turn)
            return Statics(moved, found.rest.inputs).beside_dead_centre(place, known, surely=True)
    return None


def _exchange_note(instead: Exchanged) -> Diagnostic:
    """That another coordinate took the place of one at rest."""
    before, now = (".".join(one.name) for one in (instead.freed, instead.driven))
    text = f"{before} comes near a dead centre of its own: {now} tells the equilibria in its place"
    return Diagnostic("rest-exchanged", "note", text)


class _Rows(NamedTuple):
    """The inputs of all rows (inputs, rows) in kernel units, what is known of them, and the place
    from which they were followed."""

    rest: Rest
    values: Floats
    start: Continued | None = None


def _moved(session: Session, rest: Rest, values: Floats) -> Session:
    """The session with the coordinates at rest at some values, which no text says."""
    motion, units = session.problem.motion, session.problem.units
    inputs = list(motion.inputs)
    for number in rest.inputs:
        item = inputs[number]
        in_si = values[number] * input_unit(session.layout, item)
        written = item.written_orders.copy()
        written[0] = units.from_si(in_si.copy(), dimension_of(item.coordinate))
        inputs[number] = item._replace(values=in_si, written_orders=written)
    leader = motion.leading_number
    motion = motion._replace(inputs=tuple(inputs), rest=rest, leader=leader)
    problem = replace(session.problem, motion=motion).with_quantities_of(session.problem)
    return session.moved(problem).reading(UnsolvedText(session))


class UnsolvedText:
    """In place of the text of a sweep whose coordinates at rest were found.

    Args:
        session: before that; its text does not say them.
    """

    def __init__(self, session: Session) -> None:
        self.session = session

    def __call__(self) -> Precise:
        """Tells that there is none.

        Raises:
            TraceLost: always.
        """
        raise TraceLost("a coordinate that rests where the loads balance")


class _Branch:
    """The branch of equilibria along the rows of a session."""

    def __init__(self, session: Session, rest: Rest) -> None:
        self.session, self.rest = session, rest
        self.statics = Statics(session, rest.inputs)
        self.free = list(rest.inputs)
        self.values = session.inputs.values.copy()
        self.rows = self.values.shape[1]
        moments = session.problem.motion.time
        self.times = np.zeros(self.rows) if moments is None else moments.values
        self.stretches = Stretches(self.statics, self.values, self.times)
        self.least = np.full(self.rows, np.nan)
        self.crossings: list[str] = []
        self.instead: Exchanged | None = None
        self.arcs = 0

    def follow(self, row: int, state: Floats) -> _Rows:
        """All rows, from the equilibrium near an assembly at a row on."""
        start = self.statics.place(self.values[:, row], state)
        place = self._nearby(row, start) or self._searched(row, start)
        if place is None:
            return self._nowhere(row)
        last, after = self._march(row, place, 1)
        first, before = self._march(row, place, -1)
        if np.isnan(self.least[row]):
            self._tell(row, place)
        # rows without an equilibrium stand where the last one before them does
        for number in self.free:
            self.values[number, :first] = self.values[number, first]
            self.values[number, last + 1 :] = self.values[number, last]
        ends = tuple(end or _NO_END for end in (before, after))
        notes = self._notes(first, last)
        rest = self.rest._replace(solved=True, first=first, last=last, ends=ends, notes=notes)
        return _Rows(rest, self.values, Continued(place.state, row, place.turns))

    def _nearby(self, row: int, start: Place) -> Place | None:
        """The equilibrium to which whole Newton's steps lead, each at most half as long as the one
        before, within a step's reach of a place at a row; None where they do not."""
        time = self.times[row : row + 1]
        at, _ = self.statics.balanced(Places.of(start, self.times[row]))
        if not at.times.size:
            return None
        inputs = np.concatenate([start.inputs[:, None], at.inputs], axis=1)
        if np.abs(at.inputs[:, 0] - start.inputs).max() > tolerances.EQUILIBRIUM_REACH:
            return None
        # the steps close the loops from where they begin, and might do so in another assembly
        way = self.statics.way(inputs, start)
        if way.reached < inputs.shape[1]:
            return None
        there, _ = self.statics.balanced(
            Places(at.inputs, way.states[:, 1:], way.turns[:, 1:], time)
        )
        if not there.times.size:
            return None
        is_same = np.abs(there.states - at.states).max() <= tolerances.REST_SMALL
        return there.place(0) if is_same else None

    def _searched(self, row: int, start: Place) -> Place | None:
        """The equilibrium to which a search leads from a place at a row."""
        driven = self.session.problem.motion.driven
        one = self.session.part(row, row)
        own = Statics(one, self.free)
        # most are found without knowing what each load does alone
        for measured in (False, True):
            coordinates = [driven[k] for k in self.free]
            balancing = Balancing.of(one, coordinates, measured=measured)
            try:
                found = search(balancing, balancing.charted(own, start))
            except ValueError:
                return None
            if found.found:
                return balancing.uncharted(own, found.place)
        return None

    def _nowhere(self, row: int) -> _Rows:
        text = f"no place was found at which the loads balance in row {row + 1}"
        hint = (
            "start nearer, with assembly: {near: {...}}, or look for one with equilibria: {NAME: "
            "{window: {...}}}"
        )
        end = Status.no_equilibrium, Diagnostic("no-equilibrium", "error", text, hint=hint)
        rest = self.rest._replace(solved=True, first=row, last=row - 1, ends=(_NO_END, end))
        return _Rows(rest, self.values)

    def _march(self, row: int, place: Place, step: int) -> tuple[int, End]:
        """Follows the branch from a row in a direction; the last row with an equilibrium, and why
        there is none beyond."""
        known = [row]
        self.values[self.free, row] = place.inputs[self.free]
        while 0 <= known[-1] + step < self.rows:
            at = known[-1]
            taken = self.stretches.onward(place, known, step)
            if taken is None:
                self.arcs += 1
                onward, end = Arc(self, place, at, at + step).follow()
                if onward is None:
                    return at, end
                place = onward
                known.append(at + step)
                self.values[self.free, at + step] = place.inputs[self.free]
                self._tell(at + step, place)
                continue
            place = taken.place
            for number, own in zip(self.free, taken.free, strict=True):
                self.values[number, taken.rows] = own
            known += taken.rows.tolist()
            # each node tells of the rows before it, and the last one of those behind it, too
            least = _least_each(taken.stiffness)
            ends = np.abs(taken.nodes - at) + 1
            ends[-1] = taken.rows.size + 1
            rows = at + step * np.arange(ends[-1])
            self.least[rows] = np.repeat(least, np.diff(ends, prepend=0))
        return known[-1], None

    def _tell(self, row: int, place: Place) -> None:
        """Tells the least stiffness of a row."""
        found = self.stretches.beside(Places.of(place, self.times[row]))
        if found.good[0]:
            self.least[row] = _least_each(found.stiffness)[0]

    def lost(self, row: int, at: str | None = None, hint: str | None = None) -> End:
        """That the branch could not be followed beyond a row, to which place at most, and what may
        be done."""
        text = f"the branch of equilibria could not be followed beyond row {row + 1}"
        hint = hint or (
            "see whether the loads have a value and a direction there, or end the sweep before it"
        )
        return Status.branch_lost, Diagnostic("rest-lost", "error", text, None, at, hint=hint)

    def _notes(self, first: int, last: int) -> tuple[Diagnostic, ...]:
        """Which rows are unstable equilibria, and where other branches cross."""
        notes = []
        rows = np.flatnonzero(self.least[first : last + 1] < 0.0) + first
        if rows.size:
            text = (
                f"the equilibrium of {RowSet.of(rows)} is unstable: nothing stays there by itself"
            )
            hint = (
                "hold it by an effort, or start at another equilibrium with assembly: {near: ...}"
            )
            notes.append(Diagnostic("unstable", "warning", text, hint=hint))
        for place in self.crossings:
            text = "another branch of equilibria crosses this one, which goes straight on"
            hint = "the mechanism may go the other way: start there with assembly: {near: ...}"
            crossed = Diagnostic(
                "equilibria-cross", "warning", text, None, f"at {place}", hint=hint
            )
            notes.append(crossed)
        return tuple(notes)


_NO_END = Status.ok, Diagnostic("", "note", "")


def _least_each(stiffness: Floats) -> Floats:
    """The least eigenvalues of the symmetric parts of stiffnesses (free, free, places)."""
    if len(stiffness) == 1:
        return np.asarray(stiffness[0, 0])
    halves = 0.5 * (stiffness + stiffness.swapaxes(0, 1))
    return np.array([eigen(halves[:, :, k])[0][0] for k in range(halves.shape[2])])
