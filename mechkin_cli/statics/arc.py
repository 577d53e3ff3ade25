"""The branch of equilibria between two rows of a sweep at rest, by its arclength: up to folds, and
straight on where another branch crosses."""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, Protocol

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import eliminated
from mechkin_cli.memo import remembered
from mechkin_cli.record import NamedTuple
from mechkin_cli.session import input_number, input_text, input_unit
from mechkin_cli.statics.forces import determinant, summed
from mechkin_cli.statics.places import Place, Statics
from mechkin_cli.units import TIME
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.session import Exchanged, Route, Session
    from mechkin_cli.show import Floats

End = tuple[Status, Diagnostic] | None


class Followed(Protocol):
    """What is read of the branch that is followed over the rows.

    Attributes:
        session: of the sweep.
        statics: the forces about its places.
        free: numbers of the coordinates at rest among its inputs.
        values: all inputs (inputs, rows), kernel units.
        times: of the rows (rows,), s.
        crossings: places at which other branches cross, in words.
        instead: what tells places apart where the coordinates at rest do not.
    """

    session: Session
    statics: Statics
    free: list[int]
    values: Floats
    times: Floats
    crossings: list[str]
    instead: Exchanged | None

    def lost(self, row: int, at: str | None = None, hint: str | None = None) -> End:
        """That the branch could not be followed beyond a row, to which place at most, and what may
        be done."""
        ...


class _Going(NamedTuple):
    """The direction (free + 1,) of the branch at a place, of length one, and the slopes (free, free
    + 1) of the forces."""

    tangent: Floats
    slopes: Floats


class _Onward(NamedTuple):
    """A place, the part of the way that the inputs have gone there, how the branch goes on, and
    whether it is that of the next row."""

    place: Place
    gone: float
    going: _Going
    ends: bool

    @property
    def turns_back(self) -> bool:
        """Whether the inputs go back there."""
        return bool(self.going.tangent[-1] <= 0.0)


class Arc:
    """The way from an equilibrium at a row towards the next row by the arclength of the branch, in
    the coordinates at rest and the part of the way that the inputs have gone."""

    def __init__(self, branch: Followed, place: Place, row: int, to: int) -> None:
        self.branch, self.statics, self.free = branch, branch.statics, branch.free
        self.row, self.to = row, to
        self.start = place
        way = branch.values[:, to] - place.inputs
        way[self.free] = 0.0
        self.scale = max(sqrt(float(summed(way * way))), tolerances.LEAST_REST_WAY)
        self.way = way
        self.times = float(branch.times[row]), float(branch.times[to])
        self.route = _route(branch.session)
        if self.route is not None:
            course = self.route.course
            ends = [course.at[course.rows == number] for number in (row, to)]
            self.ends = float(ends[0][0]), float(ends[1][0])

    def follow(self) -> tuple[Place | None, End]:
        """The place at the next row; or None and why the branch does not come there."""
        place, gone = self.start, 0.0
        going = self._going(place, gone, None)
        step, over = min(self.scale, tolerances.EQUILIBRIUM_REACH) / 4.0, False
        for _ in range(tolerances.MOST_ARCS):
            if going is None:
                break
            if going.tangent[-1] <= 0.0:  # of the very first place
                return None, self._fold(place, gone)
            found = self._step(place, gone, going, step)
            if found is not None and (
                found.turns_back or not self._is_one(place, gone, going, found)
            ):
                found = None
            if found is None and step <= tolerances.FOLD_STEP:
                # slopes change much beside a fold, however short steps are
                end = self._folded(place, gone, going)
                if end is not None:
                    return None, end
            if found is None and step <= tolerances.CROSSING_STEP and not over:
                # another branch may cross: then no step that comes near to it is seen to be right
                over = True
                found = self._step(place, gone, going, tolerances.CROSSING_STEP)
                crossing = None if found is None else self._crossing(place, gone, going, found)
                if found is not None and crossing is not None:
                    if found.turns_back:
                        return None, self._turned(crossing)
                    self.branch.crossings.append(crossing)
                else:
                    found = None
            if found is not None:
                place, gone, going = found.place, found.gone, found.going
                if found.ends:
                    return place, None
                step, over = min(2.0 * step, tolerances.EQUILIBRIUM_REACH), False
                continue
            step *= 0.5
            if step < tolerances.LEAST_ARC:
                break
        return None, self._lost(place, gone)

    def _folded(self, place: Place, gone: float, going: _Going) -> End:
        """Where the branch turns back within a short step, and that it does; None where it does
        not."""
        found = self._step(place, gone, going, tolerances.FOLD_STEP)
        if found is None or not found.turns_back or not self._is_one(place, gone, going, found):
            return None
        # beside a dead centre of these coordinates slopes are differences over its other side
        if self.statics.beside_dead_centre(place, self.start) is not None:
            return None
        here = self._y(place, gone)
        way = self._y(found.place, found.gone) - here
        length = sqrt(float(summed(way * way)))
        begin, end = (length * float(one.tangent[-1]) for one in (going, found.going))
        part, further = _summit(begin, end, found.gone - gone)
        inputs, _ = self._at(here + part * way)
        gone += further
        return self._fold(place._replace(inputs=inputs), gone)

    def _step(self, place: Place, gone: float, going: _Going, step: float) -> _Onward | None:
        """The place a step onward, or that at the next row where this comes first, which is not
        judged yet; None where there is none."""
        ends = gone + step * going.tangent[-1] >= self.scale
        found = self._corrected(place, gone, going.tangent, step, ends)
        onward = None if found is None else self._going(*found, going.tangent)
        if found is None or onward is None:
            return None
        if float(summed(onward.tangent * going.tangent)) <= tolerances.ARC_COSINE:
            return None
        return _Onward(*found, onward, ends)

    def _is_one(self, place: Place, gone: float, going: _Going, found: _Onward) -> bool:
        """Whether two places surely lie on one branch, and the inputs go on between them unless
        they go back at its end: slopes of the forces, with the direction of the branch and alone,
        change by less than half of what would make them singular from either end to the other,
        and to the middle of the curve between them (as branches of positions are judged,
        docs/numerics.md)."""
        first, last = self._y(place, gone), self._y(found.place, found.gone)
        size = sqrt(float(summed((last - first) * (last - first))))
        middle = 0.5 * (first + last) + (size / 8.0) * (going.tangent - found.going.tangent)
        inputs, _ = self._at(middle)
        way = self.statics.way(np.stack([place.inputs, inputs], axis=1), place)
        if way.reached < 2:
            return False
        between = self._slopes(Place(inputs, way.states[:, 1], way.turns[:, 1]), float(middle[-1]))
        if between is None:
            return False
        border = _between(going, found.going)
        slopes = (going.slopes, between[1], found.going.slopes)
        judged = [[np.concatenate([each, border]) for each in slopes]]
        if not found.turns_back:
            judged.append([each[:, :-1] for each in slopes])
        for begin, half, end in judged:
            pairs = ((begin, half), (begin, end), (end, half), (end, begin))
            if any(not _change(one, other) <= tolerances.SPECTRAL_RADIUS for one, other in pairs):
                return False
        return True

    def _crossing(self, place: Place, gone: float, going: _Going, found: _Onward) -> str | None:
        """Where another branch of equilibria crosses between two places between which this one goes
        straight, in words; None where none does. There the slopes with the direction of the branch
        are singular: their determinant changes its sign."""
        here, way = self._y(place, gone), self._y(found.place, found.gone)
        way = way - here
        length = sqrt(float(summed(way * way)))
        off = way - length * going.tangent
        bent = found.going.tangent - going.tangent
        straight = sqrt(float(max(summed(off * off) / (length * length), summed(bent * bent))))
        border = _between(going, found.going)
        first, last = (
            determinant(np.concatenate([each.slopes, border])) for each in (going, found.going)
        )
        if straight > tolerances.CROSSING_BEND or first * last >= 0.0:
            return None
        at = here + (first / (first - last)) * way
        inputs, _ = self._at(at)
        return self._words(place._replace(inputs=inputs), float(at[-1]))

    def _words(self, place: Place, gone: float) -> str:
        """Where a place is, as messages tell it."""
        session, motion = self.branch.session, self.branch.session.problem.motion
        problem = session.problem
        inputs = self._inputs(gone)
        inputs[self.free] = place.inputs[self.free]
        at = [
            input_text(input_number(problem, session.layout, number, float(inputs[number])))
            for number in (motion.leading_number, *self.free)
        ]
        leader = self.branch.values[motion.leading_number]
        if motion.leading_number in self.free or leader.min() == leader.max():
            at = at[1:]
        if motion.time is not None:
            shown = float(problem.units.from_si(self._time(gone), TIME))
            at.insert(0, f"time = {shown:.12g} {problem.units.label(TIME)}")
        return ", ".join(at)

    def _lost(self, place: Place, gone: float) -> End:
        """That the branch could not be followed beyond a place, and what may be done."""
        other = self.statics.beside_dead_centre(place, self.start)
        hint = None
        if other is not None:
            self.branch.instead = other
            hint = (
                "the coordinates at rest come near a dead centre there; name others under rest, as "
                f"{'.'.join(other.driven.name)}"
            )
        return self.branch.lost(self.row, self._words(place, gone), hint)

    def _turned(self, at: str) -> End:
        """That the branch turns back where another one crosses."""
        text = (
            f"the branch of equilibria turns back between rows {self.row + 1} and {self.to + 1}, "
            "where another one crosses"
        )
        hint = (
            "the mechanism may go on along that one: start there with assembly: {near: ...}, or "
            "end the sweep before it"
        )
        return Status.branch_lost, Diagnostic(
            "rest-lost", "error", text, None, f"at {at}", hint=hint
        )

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
        inputs = self._inputs(float(y[-1]))
        inputs[self.free] = y[:-1]
        return inputs, self._time(float(y[-1]))

    def _time(self, gone: float) -> float:
        part = gone / self.scale
        return (1.0 - part) * self.times[0] + part * self.times[1]

    def _inputs(self, gone: float) -> Floats:
        """The inputs (inputs,) where they have gone a part of their way, as their laws say."""
        part = gone / self.scale
        inputs = self.start.inputs + self.way * part
        if self.route is None or part in (0.0, 1.0):
            return inputs
        at, edges = (1.0 - part) * self.ends[0] + part * self.ends[1], self.route.course.edges
        # of two cells that meet at a row, the one on this side
        low, high = sorted(self.ends)
        inner = min(max(at, low), high) if 0.0 < part < 1.0 else 0.5 * (low + high)
        cell = min(max(int(np.searchsorted(edges, inner)) - 1, 0), edges.size - 2)
        values = self.route.jets(cell, np.array([at]))[0, :, 0]
        inputs[: values.size] = values
        return inputs

    def _y(self, place: Place, gone: float) -> Floats:
        return np.append(place.inputs[self.free], gone)

    def _slopes(self, place: Place, gone: float) -> tuple[Floats, Floats] | None:
        """Forces (free,) and their slopes (free, free + 1) at a place."""
        here, onward = self._inputs(gone), tolerances.NEWTON_DIFFERENCE * self.scale
        beyond = np.array([onward, -onward]) + gone
        steps = np.stack([self._inputs(at) - here for at in beyond.tolist()], axis=1)
        times = np.array([self._time(at) for at in beyond.tolist()])
        found = self.statics.slopes(place, self._time(gone), steps, times)
        if found is None:
            return None
        forces, slopes = found
        along = (forces[:, 1:2] - forces[:, 2:3]) / (2.0 * onward)
        return forces[:, 0], np.concatenate([slopes, along], axis=1)

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


@remembered
def _route(session: Session) -> Route | None:
    """The way of the driven inputs along the rows; None where it goes straight from each to the
    next."""
    motion = session.problem.motion
    if motion.rest is None or motion.rest.course is None:
        return None
    from mechkin_cli.session import Route

    count = len(motion.rest.course.values)
    units = [input_unit(session.layout, item) for item in motion.inputs[:count]]
    return Route(motion.rest.course, session.inputs.values[:count], np.array(units))


def _summit(begin: float, end: float, rise: float) -> tuple[float, float]:
    """Where between 0 and 1 a curve of third degree is highest, and how high, that begins at 0 with
    the slope `begin` > 0 and ends at `rise` with the slope `end` <= 0."""
    square, cube = 3.0 * rise - 2.0 * begin - end, begin + end - 2.0 * rise
    root = square * square - 3.0 * begin * cube
    at = begin / (sqrt(root) - square) if root >= 0.0 and sqrt(root) > square else 1.0
    if not at < 1.0:
        at = begin / (begin - end)
    return at, at * (begin + at * (square + at * cube))


def _between(one: _Going, other: _Going) -> Floats:
    """The direction between those of a branch at two places, (1, free + 1)."""
    border = one.tangent + other.tangent
    found: Floats = (border / sqrt(float(summed(border * border))))[None, :]
    return found


def _change(one: Floats, other: Floats) -> float:
    """The spectral radius of one^-1 (other - one), whatever the units of its columns; infinite
    where `one` is singular."""
    columns = []
    for k in range(len(one)):
        solved = eliminated(one.tolist(), (other[:, k] - one[:, k]).tolist(), 0.0)
        if solved is None:
            return np.inf
        columns.append(solved)
    change = np.array(columns).T
    found = _kernel.eigen(np.ascontiguousarray(change)) if np.isfinite(change).all() else None
    if found is None:
        return np.inf
    real, imaginary = found[:2]
    return float(np.sqrt(np.max(real * real + imaginary * imaginary)))
