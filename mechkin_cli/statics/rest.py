"""A sweep at rest: the branch of equilibria along the rows.

From an equilibrium at one row the branch is followed to both ends. Rows are taken in stretches: the
coordinates at rest are predicted from the rows before, and all rows of a stretch are corrected at
once with the stiffness of its ends. A stretch that does not converge, or whose rows are not surely
on one branch, is halved. Where the next row alone is not, the branch is followed by its arclength:
it gets there, or turns back before (a fold), and the mechanism snaps through.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import dimension_of, eliminated
from mechkin_cli.memo import remembered
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.row_notes import RowSet
from mechkin_cli.session import Continued, input_unit
from mechkin_cli.statics.arc import Arc, End
from mechkin_cli.statics.forces import summed
from mechkin_cli.statics.newton import Balancing, determinant, search
from mechkin_cli.statics.places import Place, Statics, eigen
from mechkin_cli.sweep import first_assembly
from mechkin_cli.tape import TraceLost
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.mechanism import Rest
    from mechkin_cli.session import Precise, Session
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
    found = _Branch(sized, rest).follow(start.row, start.state)
    moved = _moved(session, found.rest, found.values)
    if found.start is None:
        return moved
    # the assembly that was chosen stands where the coordinates have not come to rest yet: chosen
    # where they have, it might be another
    return replace(moved, base=None, first=found.start._replace(chosen=start))


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
        self.unstable = np.zeros(self.rows, dtype=bool)
        self.crossings: list[str] = []

    def follow(self, row: int, state: Floats) -> _Rows:
        """All rows, from the equilibrium near an assembly at a row on."""
        driven = self.session.problem.motion.driven
        one = self.session.part(row, row)
        own = Statics(one, self.free)
        start = own.place(self.values[:, row], state)
        # most are found without knowing what each load does alone
        for measured in (False, True):
            coordinates = [driven[k] for k in self.free]
            balancing = Balancing.of(one, coordinates, measured=measured)
            try:
                found = search(balancing, balancing.charted(own, start))
            except ValueError:
                return self._nowhere(row)
            if found.found:
                break
        else:
            return self._nowhere(row)
        place = balancing.uncharted(own, found.place)
        last, after = self._march(row, place, 1)
        first, before = self._march(row, place, -1)
        # rows without an equilibrium stand where the last one before them does
        for number in self.free:
            self.values[number, :first] = self.values[number, first]
            self.values[number, last + 1 :] = self.values[number, last]
        ends = tuple(end or _NO_END for end in (before, after))
        notes = self._notes(first, last)
        rest = self.rest._replace(solved=True, first=first, last=last, ends=ends, notes=notes)
        return _Rows(rest, self.values, Continued(place.state, row, place.turns))

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
        known, block = [row], 1
        self.values[self.free, row] = place.inputs[self.free]
        matrix = self._slopes(place, float(self.times[row]))
        while matrix is not None and 0 <= known[-1] + step < self.rows:
            at = known[-1]
            self.unstable[at] = _least(matrix) < 0.0
            left = self.rows - 1 - at if step > 0 else at
            rows = at + step * np.arange(1, min(block, left) + 1)
            found = self._stretch(place, rows, known, matrix)
            if found is not None:
                place, matrix, chords = found
                known += rows.tolist()
                self.unstable[rows] = _least(matrix) < 0.0
                if chords <= tolerances.FEW_CHORDS:
                    block = min(2 * block, tolerances.MOST_REST_ROWS)
                elif chords > tolerances.MANY_CHORDS:
                    block = max(block - block // 3, 1)
                continue
            if block > 1:
                block //= 2
                continue
            onward, end = Arc(self, place, at, at + step).follow()
            if onward is None:
                return at, end
            place = onward
            known.append(at + step)
            self.values[self.free, at + step] = place.inputs[self.free]
            matrix = self._slopes(place, float(self.times[at + step]))
        if matrix is None:
            return known[-1], self.lost(known[-1])
        self.unstable[known[-1]] = _least(matrix) < 0.0
        return known[-1], None

    def lost(self, row: int, at: str | None = None) -> End:
        """That the branch could not be followed beyond a row, to which place at most."""
        text = f"the branch of equilibria could not be followed beyond row {row + 1}"
        hint = (
            "see whether the loads have a value and a direction there, or end the sweep before it"
        )
        return Status.branch_lost, Diagnostic("rest-lost", "error", text, None, at, hint=hint)

    def _predicted(self, known: list[int], rows: Floats) -> Floats:
        """The coordinates at rest (free, rows), by a polynomial through rows that are known."""
        most = tolerances.REST_POINTS - 1
        apart = max(1, min(len(known) - 1, len(rows)) // most)
        backs = [apart * k for k in range(most + 1)]
        points = [known[-1 - back] for back in backs if back < len(known)]
        found = np.zeros((len(self.free), len(rows)))
        for k in points:
            weight = np.ones(len(rows))
            for other in points:
                if other != k:
                    weight = weight * ((rows - other) / (k - other))
            found = found + self.values[self.free, k][:, None] * weight
        return found

    def _slopes(self, place: Place, time: float) -> Floats | None:
        """The stiffness (free, free) by the coordinates at rest; None where there is none."""
        steps = self._differences()
        found = self.statics.beside(place, steps, np.full(steps.shape[1], time))
        return self._differentiated(found.forces) if found.good.all() else None

    def _far(self, place: Place, time: float, near: Floats) -> Floats | None:
        """The stiffness at the end of a stretch; None where it has none, or where its determinant
        has another sign than at the beginning."""
        found = self._slopes(place, time)
        if found is None or determinant(found) * determinant(near) <= 0.0:
            return None
        return found

    def _differences(self) -> Floats:
        count, step = len(self.free), tolerances.NEWTON_DIFFERENCE
        steps = np.zeros((self.values.shape[0], 2 * count))
        for number, k in enumerate(self.free):
            steps[k, 2 * number], steps[k, 2 * number + 1] = step, -step
        return steps

    def _differentiated(self, forces: Floats) -> Floats:
        step = 2.0 * tolerances.NEWTON_DIFFERENCE
        found: Floats = (forces[:, ::2] - forces[:, 1::2]) / step
        return found

    def _stretch(
        self, place: Place, rows: Floats, known: list[int], matrix: Floats
    ) -> tuple[Place, Floats, int] | None:
        """Corrects the predicted equilibria of some rows beyond a place, all at once; the last
        place, the stiffness there and the number of corrections, or None where they are not surely
        those of the branch."""
        inputs = self.values[:, rows].copy()
        inputs[self.free] = self._predicted(known, rows)
        way = self.statics.way(np.concatenate([place.inputs[:, None], inputs], axis=1), place)
        if way.reached <= rows.size:
            return None
        states, turns, times = way.states[:, 1:], way.turns[:, 1:], self.times[rows]
        far = matrix
        if len(self.free) > 1:
            last = Place(inputs[:, -1], states[:, -1], turns[:, -1])
            known_far = self._far(last, float(times[-1]), matrix)
            if known_far is None:
                return None
            far = known_far
        part = np.arange(1, rows.size + 1) / rows.size
        slopes = matrix[:, :, None] * (1.0 - part) + far[:, :, None] * part
        predicted = inputs[self.free].copy()
        before, step = np.inf, None
        chords = 0
        while chords < tolerances.MOST_CHORDS:
            chords += 1
            found = self.statics.forces(inputs, states, turns, times)
            if not found.good.all():
                return None
            if step is not None:
                # what the last step left tells of the slopes (C. G. Broyden, Mathematics of
                # Computation 19, 1965)
                squares = summed(step * step)
                by = np.where(squares > 0.0, step / np.where(squares > 0.0, squares, 1.0), 0.0)
                slopes = slopes + found.forces[:, None, :] * by[None, :, :]
            step = _solved(slopes, -found.forces)
            if step is None:
                return None
            size = float(np.max(np.abs(step)))
            if not size < tolerances.CHORD_GAIN * before:
                # rounding is left, or chords that go nowhere
                if size > tolerances.REST_ROUNDING:
                    return None
                break
            inputs[self.free] += step
            states, before = found.states, size
            if size <= tolerances.EQUILIBRIUM_STEP:
                break
        moved = np.abs(inputs[self.free] - place.inputs[self.free][:, None]).max()
        off = np.abs(inputs[self.free] - predicted).max()
        if off > (tolerances.REST_MISS if len(known) == 1 else tolerances.SMOOTH_STEP * moved) and (
            off > tolerances.REST_SMALL
        ):
            return None
        # the states are those before the last step, of the size of rounding
        last = Place(inputs[:, -1], states[:, -1], turns[:, -1])
        if len(self.free) == 1:
            # of one freedom the steps have told the slope, where there were any
            told = float(np.abs(inputs[self.free, -1] - predicted[:, -1])[0])
            far = slopes[:, :, -1]
            if not told > tolerances.TELLING_STEP:
                known_far = self._far(last, float(times[-1]), matrix)
                if known_far is None:
                    return None
                far = known_far
            elif far[0, 0] * matrix[0, 0] <= 0.0:
                return None
        before_them = (
            place.inputs[self.free] if len(known) < 2 else self.values[self.free, known[-2]]
        )
        if not self._joined(place, known[-1], rows, inputs, states, turns, before_them):
            return None
        self.values[:, rows] = inputs
        return last, far, chords

    def _joined(
        self,
        place: Place,
        row: int,
        rows: Floats,
        inputs: Floats,
        states: Floats,
        turns: Floats,
        earlier: Floats,
    ) -> bool:
        """Whether equilibria in some rows surely lie on one branch with a place, that of the row
        before them; `earlier` is where the coordinates at rest were (free,) in the row before that.

        Short steps that change slowly do: before a fold they grow from row to row. Others do if
        they are those that the rates of the branch at both ends tell.
        """
        every = np.concatenate([place.inputs[:, None], inputs], axis=1)
        ways = np.diff(every, axis=1)
        steps, driven = ways[self.free], np.delete(ways, self.free, axis=0)
        sizes = np.max(np.abs(steps), axis=0)
        before = np.concatenate(
            [(place.inputs[self.free] - earlier)[:, None], steps[:, :-1]], axis=1
        )
        changes = np.max(np.abs(steps - before), axis=0)
        slow = (sizes <= tolerances.SHORT_REST) & (
            changes <= tolerances.SLOW_REST * sizes + tolerances.REST_ROUNDING
        )
        if slow.all():
            return True
        far = np.max(np.abs(driven), axis=0, initial=0.0)
        if (np.maximum(sizes, far)[~slow] > tolerances.LONG_REST).any():
            return False
        times = np.concatenate([[self.times[row]], self.times[rows]])
        for k in np.flatnonzero(~slow).tolist():
            here = Place(inputs[:, k - 1], states[:, k - 1], turns[:, k - 1]) if k else place
            there = Place(inputs[:, k], states[:, k], turns[:, k])
            way, pace = ways[:, k].copy(), float(times[k + 1] - times[k])
            way[self.free] = 0.0
            begin = self._rate(here, way, float(times[k]), pace)
            end = self._rate(there, way, float(times[k + 1]), pace)
            if begin is None or end is None or begin[1] * end[1] <= 0.0:
                return False
            off = float(np.max(np.abs(steps[:, k] - 0.5 * (begin[0] + end[0]))))
            most = float(np.max(np.abs([begin[0], end[0]])))
            if off > tolerances.JOINED_REST * most + tolerances.REST_ROUNDING:
                return False
        return True

    def _rate(
        self, place: Place, way: Floats, time: float, pace: float
    ) -> tuple[Floats, float] | None:
        """How far (free,) the branch goes at the rate that it has at a place, where the inputs go a
        `way` (inputs,) and time goes on by `pace`; and the determinant of the stiffness there."""
        count, h = len(self.free), tolerances.NEWTON_DIFFERENCE
        size = max(float(np.max(np.abs(way))), tolerances.LEAST_REST_WAY)
        steps = np.concatenate([self._differences(), np.zeros((way.size, 2))], axis=1)
        steps[:, -2], steps[:, -1] = way * (h / size), -way * (h / size)
        times = np.full(2 * count + 2, time)
        times[-2] += pace * (h / size)
        times[-1] -= pace * (h / size)
        found = self.statics.beside(place, steps, times)
        if not found.good.all():
            return None
        matrix = self._differentiated(found.forces[:, : 2 * count])
        push = (found.forces[:, -2] - found.forces[:, -1]) * (size / (2.0 * h))
        solved = eliminated(matrix.tolist(), (-push).tolist(), 0.0)
        return None if solved is None else (np.array(solved), determinant(matrix))

    def _notes(self, first: int, last: int) -> tuple[Diagnostic, ...]:
        """Which rows are unstable equilibria, and where other branches cross."""
        notes = []
        rows = np.flatnonzero(self.unstable[first : last + 1]) + first
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


def _least(matrix: Floats) -> float:
    """The least eigenvalue of the symmetric part of a stiffness."""
    return float(eigen(0.5 * (matrix + matrix.T))[0][0])


def _solved(matrices: Floats, right: Floats) -> Floats | None:
    """The solutions (count, rows) of systems (count, count, rows), each by elimination without
    exchange where that is safe; None where one is singular."""
    count = right.shape[0]
    if count == 1:
        pivots = matrices[0, 0]
        return None if (pivots == 0.0).any() else right / pivots
    found = np.empty_like(right)
    for k in range(right.shape[1]):
        solved = eliminated(matrices[:, :, k].tolist(), right[:, k].tolist(), 0.0)
        if solved is None:
            return None
        found[:, k] = solved
    return found
