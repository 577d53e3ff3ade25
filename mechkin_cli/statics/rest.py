"""A sweep at rest: the branch of equilibria along the rows.

From an equilibrium at one row the branch is followed to both ends. Rows are taken in stretches: the
coordinates at rest are predicted from the rows before, all rows of a stretch are corrected at once
with the stiffness of its ends, and a stretch that does not converge is halved. Where even the next
row is not reached, the branch is followed by its arclength between the two rows: it may get there
around a bend, or turn back before (a fold), beyond which the mechanism snaps through.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.mechanism import dimension_of, eliminated
from mechkin_cli.memo import remembered
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.row_notes import RowSet
from mechkin_cli.session import Continued, input_number, input_text, input_unit
from mechkin_cli.statics.forces import summed
from mechkin_cli.statics.newton import Balancing, determinant, search
from mechkin_cli.statics.places import Place, Statics, eigen
from mechkin_cli.sweep import first_assembly
from mechkin_cli.tape import TraceLost
from mechkin_cli.units import TIME
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
    return session.moved(problem).reading(_no_text)


def _no_text() -> Precise:
    raise TraceLost("a coordinate that rests where the loads balance")


End = tuple[Status, Diagnostic] | None


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
            onward, end = _Arc(self, place, at, at + step).follow()
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


class _Going(NamedTuple):
    """The direction (free + 1,) of the branch at a place, of length one, and the slopes (free, free
    + 1) of the forces."""

    tangent: Floats
    slopes: Floats


class _Arc:
    """The way from an equilibrium at a row towards the next row by the arclength of the branch, in
    the coordinates at rest and the part of the way that the inputs have gone."""

    def __init__(self, branch: _Branch, place: Place, row: int, to: int) -> None:
        self.branch, self.statics, self.free = branch, branch.statics, branch.free
        self.row, self.to = row, to
        self.start = place
        way = branch.values[:, to] - place.inputs
        way[self.free] = 0.0
        self.scale = max(sqrt(float(summed(way * way))), tolerances.LEAST_REST_WAY)
        self.direction = way / self.scale
        self.pace = float(branch.times[to] - branch.times[row]) / self.scale

    def follow(self) -> tuple[Place | None, End]:
        """The place at the next row; or None and why the branch does not come there."""
        place, gone = self.start, 0.0
        going = self._going(place, gone, None)
        step = min(self.scale, tolerances.EQUILIBRIUM_REACH) / 4.0
        for _ in range(tolerances.MOST_ARCS):
            if going is None:
                return None, self.branch.lost(self.row, self._words(place, gone))
            tangent = going.tangent
            if tangent[-1] <= 0.0:  # of the very first place
                return None, self._fold(place, gone)
            # the last step ends at the row itself
            ends = tangent[-1] > 0.0 and gone + step * tangent[-1] >= self.scale
            found = self._corrected(place, gone, tangent, step, ends)
            if found is not None:
                onward, there = found
                following = self._going(onward, there, tangent)
                if following is not None and (
                    self._is_one(place, gone, going, found, following)
                    or self._crosses(place, gone, step, going, found, following)
                ):
                    turns_back = following.tangent[-1] <= 0.0
                    if turns_back and step <= tolerances.FOLD_STEP:
                        return None, self._fold(place, gone)
                    if not turns_back and ends:
                        return onward, None
                    if not turns_back:
                        place, gone, going = onward, there, following
                        step = min(2.0 * step, tolerances.EQUILIBRIUM_REACH)
                        continue
            step *= 0.5
            if step < tolerances.LEAST_ARC:
                if tangent[-1] < tolerances.NEAR_FOLD:
                    return None, self._fold(place, gone)
                return None, self.branch.lost(self.row, self._words(place, gone))
        return None, self.branch.lost(self.row, self._words(place, gone))

    def _is_one(
        self, place: Place, gone: float, going: _Going, found: tuple[Place, float], onward: _Going
    ) -> bool:
        """Whether two places surely lie on one branch: slopes of the forces, with the direction of
        the branch, change by less than half of what would make them singular from either end to the
        other, and to the middle of the curve between them (as branches of positions are judged,
        docs/numerics.md)."""
        if float(summed(onward.tangent * going.tangent)) <= tolerances.ARC_COSINE:
            return False
        first, last = self._y(place, gone), self._y(*found)
        size = sqrt(float(summed((last - first) * (last - first))))
        middle = 0.5 * (first + last) + (size / 8.0) * (going.tangent - onward.tangent)
        inputs, _ = self._at(middle)
        way = self.statics.way(np.stack([place.inputs, inputs], axis=1), place)
        if way.reached < 2:
            return False
        between = self._slopes(Place(inputs, way.states[:, 1], way.turns[:, 1]), float(middle[-1]))
        if between is None:
            return False
        border = going.tangent + onward.tangent
        border = border / sqrt(float(summed(border * border)))
        begin, half, end = (
            np.concatenate([slopes, border[None, :]])
            for slopes in (going.slopes, between[1], onward.slopes)
        )
        pairs = ((begin, half), (begin, end), (end, half), (end, begin))
        return all(_change(one, other) <= tolerances.SPECTRAL_RADIUS for one, other in pairs)

    def _crosses(
        self,
        place: Place,
        gone: float,
        step: float,
        going: _Going,
        found: tuple[Place, float],
        onward: _Going,
    ) -> bool:
        """Whether another branch of equilibria crosses between two places, so that no slopes tell
        them from it, and this one goes on in a straight line."""
        if step > tolerances.CROSSING_STEP:
            return False
        off = self._y(*found) - self._y(place, gone)
        length = sqrt(float(summed(off * off)))
        off = off - length * going.tangent
        bent = onward.tangent - going.tangent
        straight = sqrt(float(max(summed(off * off) / (length * length), summed(bent * bent))))
        if straight > tolerances.CROSSING_BEND:
            return False
        self.branch.crossings.append(self._words(place, gone))
        return True

    def _words(self, place: Place, gone: float) -> str:
        """Where a place is, as messages tell it."""
        session, motion = self.branch.session, self.branch.session.problem.motion
        problem = session.problem
        inputs = self.start.inputs + self.direction * gone
        inputs[self.free] = place.inputs[self.free]
        at = [
            input_text(input_number(problem, session.layout, number, float(inputs[number])))
            for number in (motion.leading_number, *self.free)
        ]
        if motion.leading_number in self.free or not self.direction.any():
            at = at[1:]
            if motion.time is not None:
                time = float(self.branch.times[self.row]) + self.pace * gone
                shown = float(problem.units.from_si(time, TIME))
                at.insert(0, f"time = {shown:.12g} {problem.units.label(TIME)}")
        return ", ".join(at)

    def _fold(self, place: Place, gone: float) -> End:
        """That the branch turns back at a place, and where."""
        text = (
            f"the branch of equilibria turns back between rows {self.row + 1} and {self.to + 1}: "
            "the mechanism snaps through"
        )
        hint = "end the sweep before it, or start on the other branch with assembly: {near: ...}"
        found = Diagnostic(
            "snaps-through", "error", text, None, f"at {self._words(place, gone)}", hint=hint
        )
        return Status.snapped_through, found

    def _at(self, y: Floats) -> tuple[Floats, float]:
        inputs = self.start.inputs + self.direction * y[-1]
        inputs[self.free] = y[:-1]
        return inputs, float(self.branch.times[self.row]) + self.pace * float(y[-1])

    def _y(self, place: Place, gone: float) -> Floats:
        return np.append(place.inputs[self.free], gone)

    def _slopes(self, place: Place, gone: float) -> tuple[Floats, Floats] | None:
        """Forces (free,) and their slopes (free, free + 1) at a place."""
        count, h = len(self.free), tolerances.NEWTON_DIFFERENCE
        steps = np.zeros((place.inputs.size, 2 * count + 3))
        times = np.full(2 * count + 3, self._at(self._y(place, gone))[1])
        for number, k in enumerate(self.free):
            steps[k, 2 * number], steps[k, 2 * number + 1] = h, -h
        for sign, column in ((1.0, 2 * count), (-1.0, 2 * count + 1)):
            steps[:, column] = sign * h * self.direction
            times[column] += sign * h * self.pace
        found = self.statics.beside(place, steps, times)
        if not found.good.all():
            return None
        return found.forces[:, -1], (found.forces[:, :-1:2] - found.forces[:, 1:-1:2]) / (2.0 * h)

    def _going(self, place: Place, gone: float, before: Floats | None) -> _Going | None:
        """How the branch goes on at a place, onward from the direction before."""
        found = self._slopes(place, gone)
        if found is None:
            return None
        slopes = found[1]
        count = slopes.shape[0]
        onward = np.append(np.zeros(count), 1.0) if before is None else before
        matrix = np.concatenate([slopes, onward[None, :]])
        solved = eliminated(matrix.tolist(), [0.0] * count + [1.0], 0.0)
        if solved is None:
            return None
        tangent = np.array(solved)
        size = sqrt(float(summed(tangent * tangent)))
        return _Going(tangent / size, slopes) if np.isfinite(size) and size > 0.0 else None

    def _corrected(
        self, place: Place, gone: float, tangent: Floats, step: float, ends: bool
    ) -> tuple[Place, float] | None:
        """The equilibrium a step onward, or the one at the next row where the way `ends`."""
        y = self._y(place, gone) + step * tangent
        if ends:
            y = self._y(place, gone) + tangent * ((self.scale - gone) / tangent[-1])
            y[-1] = self.scale
        predicted, here = y.copy(), place
        last = np.append(np.zeros(len(self.free)), 1.0) if ends else tangent
        size = np.inf
        for _ in range(tolerances.MOST_CHORDS):
            inputs, _time = self._at(y)
            way = self.statics.way(np.stack([here.inputs, inputs], axis=1), here)
            if way.reached < 2:
                return None
            here = Place(inputs, way.states[:, 1], way.turns[:, 1])
            if size <= tolerances.EQUILIBRIUM_STEP:
                off = y - predicted
                if sqrt(float(summed(off * off))) > tolerances.SMOOTH_STEP * step:
                    return None
                return here, float(y[-1])
            found = self._slopes(here, float(y[-1]))
            if found is None:
                return None
            forces, slopes = found
            matrix = np.concatenate([slopes, last[None, :]])
            beyond = float(summed(last * (y - predicted)))
            solved = eliminated(matrix.tolist(), [*(-forces).tolist(), -beyond], 0.0)
            if solved is None:
                return None
            by = np.array(solved)
            size = sqrt(float(summed(by * by)))
            if not size <= tolerances.EQUILIBRIUM_REACH:
                return None
            y = y + by
        return None


def _least(matrix: Floats) -> float:
    """The least eigenvalue of the symmetric part of a stiffness."""
    return float(eigen(0.5 * (matrix + matrix.T))[0][0])


def _change(one: Floats, other: Floats) -> float:
    """The largest sum of a row of one^-1 (other - one), which bounds its spectral radius; infinite
    where `one` is singular."""
    columns = []
    for k in range(len(one)):
        solved = eliminated(one.tolist(), (other[:, k] - one[:, k]).tolist(), 0.0)
        if solved is None:
            return np.inf
        columns.append(np.abs(solved))
    return float(np.max(summed(np.array(columns))))


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
