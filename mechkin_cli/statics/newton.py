"""The search for equilibria: Newton's steps towards any place at which the forces vanish, stable or
not; where they end without one, once down to where the mechanism would come to rest.

Each step is taken on a chart about the place before, so no dead centre of a coordinate stops it. It
goes as far as the forces become smaller, and as the places along it lie on one smooth branch. Many
searches go side by side, so that a call of the kernel takes the places of all; one does not depend
on the others.
"""

from __future__ import annotations

from enum import Enum
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import ZERO, eliminated
from mechkin_cli.memo import remembered
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.response import free_session, with_loads
from mechkin_cli.session import continuous_angle, turn_count
from mechkin_cli.statics.forces import (
    DrivenAt,
    Forces,
    ForcesAt,
    FreePlace,
    orthonormal_each,
    summed,
)
from mechkin_cli.statics.places import Place, Statics, eigen

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.session import Coordinate, Session
    from mechkin_cli.show import Bools, Floats


class SearchEnd(Enum):
    """Why a search ended."""

    FOUND = "found"
    LEAST = "no step makes the forces smaller"
    RUNAWAY = "the mechanism runs away"
    BRANCH_ENDS = "the mechanism cannot be followed further"
    NO_FORCES = "the loads have no value there"
    STEPS = "steps ran out"


class Search(NamedTuple):
    """The last place of a search, the forces there (freedoms,), the largest force or slope that is
    known of one load or of all, and why it ended; forces in kernel units."""

    place: FreePlace
    forces: Floats
    largest: float
    end: SearchEnd
    steps: int

    @property
    def found(self) -> bool:
        """Whether the loads balance there."""
        return self.end is SearchEnd.FOUND


@dataclass(frozen=True)
class Balancing:
    """The forces of a mechanism about places, at one moment.

    Attributes:
        chosen: the session of one row, among whose inputs are the coordinates that are free.
        coordinates: these (joint, coordinate), which fix a place.
        forces: of what is free.
        measured: whether what balances is measured by each load alone, which takes a plan for each;
            else by the sum of all.
    """

    chosen: Session
    coordinates: list[Coordinate]
    forces: Forces
    measured: bool = True

    @classmethod
    def of(
        cls, chosen: Session, coordinates: list[Coordinate], *, measured: bool = True
    ) -> Balancing:
        """The forces where some inputs of a session of one row are free."""
        problem, motion = chosen.problem, chosen.problem.motion
        driven = tuple(
            item for item in motion.inputs if (item.joint, item.coordinate) not in coordinates
        )
        motion = motion._replace(inputs=driven, leader=None, rest=None)
        free = free_session(chosen, coordinates)
        free = replace(free.moved(problem.moved(motion)), packing=chosen.packing)
        return cls(chosen, coordinates, Forces(free, DrivenAt.row(free)), measured)

    @cached_property
    def alone(self) -> tuple[Forces, ...]:
        """The forces of each load alone, and of all weights; of all where these are not wanted."""
        if not self.measured:
            return (self.forces,)
        driven = self.forces.driven
        return tuple(Forces(one, driven) for one in _alone(self.forces.session))

    def largest(self, places: FreePlace) -> Floats:
        """The largest force of one load alone, or of all weights, and the largest slope of one, for
        a unit of the chart: what balances at each of many places and about it (places,)."""
        most = np.zeros(places.state.shape[1])
        for one in self.alone:
            forces, matrices, good = slopes_each(one, places)
            sizes = np.maximum(np.abs(forces).max(axis=0), np.abs(matrices).max(axis=(0, 1)))
            most = np.where(good, np.maximum(most, sizes), most)
        return most

    def charted(self, statics: Statics, place: Place, tangents: Floats | None = None) -> FreePlace:
        """A place of the chosen session with a chart about it, from the rates (free, columns) at
        unit rates of the free coordinates, where these are known.

        Raises:
            ValueError: a named coordinate stands at a dead centre there.
        """
        found, good = self.charted_each(
            statics,
            Place(place.inputs[:, None], place.state[:, None], place.turns[:, None]),
            None if tangents is None else tangents[:, :, None],
        )
        if not good[0]:
            raise ValueError("a named coordinate stands at a dead centre at this place")
        return found.at(0)

    def charted_each(
        self, statics: Statics, places: Place, tangents: Floats | None = None
    ) -> tuple[FreePlace, Bools]:
        """Many places of the chosen session, whose arrays have them as their last axis, with charts
        about them; and where none of the named coordinates stands at a dead centre (places,)."""
        session, layout = self.chosen, self.chosen.layout
        state = places.state.copy()
        # a free motion's states have the whole turns of the tree's angles
        for slot, row in session.structure.tree_slots.items():
            state[slot] += 2.0 * pi * places.turns[row]
        closing = len(places.turns) - len(session.structure.tree_slots)
        turns = np.zeros((turn_count(self.forces.session.plan), state.shape[1]))
        turns[:closing] = places.turns[:closing]
        for number, (edge, freedom) in enumerate(session.graph.inputs):
            state[layout.state(edge, freedom)] = places.inputs[number]
        if tangents is None:
            tangents = statics.tangents(places.inputs, places.state)
        finite = np.isfinite(tangents).all(axis=(0, 1))
        tangents, independent = orthonormal_each(np.where(finite, tangents, 0.0))
        return FreePlace(state, turns, tangents), finite & independent

    def uncharted(self, statics: Statics, place: FreePlace) -> Place:
        """The same place of the chosen session."""
        session, layout = self.chosen, self.chosen.layout
        inputs = session.inputs.values[:, 0].copy()
        inputs[statics.free] = self.named(place)[0]
        state = place.state.copy()
        slots = session.structure.tree_slots
        turns = np.zeros(turn_count(session.plan))
        closing = turns.size - len(slots)
        turns[:closing] = place.turns[:closing]
        for slot, row in slots.items():
            turns[row] = np.rint(state[slot] / (2.0 * pi))
            state[slot] -= 2.0 * pi * turns[row]
        reduced, _ = statics.reduced(inputs[:, None])
        for number, (edge, freedom) in enumerate(session.graph.inputs):
            state[layout.state(edge, freedom)] = reduced[number, 0]
        return Place(inputs, state, turns)

    def named(self, place: FreePlace) -> tuple[Floats, Floats]:
        """The free coordinates (freedoms,) at a place, and their rates (freedoms, freedoms) where
        one direction of its chart after the other has unit rate."""
        values, rates = self.named_each(FreePlace.many([place]))
        return values[:, 0], rates[:, 0]

    def named_each(self, places: FreePlace) -> tuple[Floats, Floats]:
        """The same of many places: (freedoms, places), (freedoms, places, freedoms)."""
        return coordinates_at(self.forces, self.coordinates, places)


def coordinates_at(
    forces: Forces, coordinates: list[Coordinate], places: FreePlace
) -> tuple[Floats, Floats]:
    """Some coordinates (coordinates, places) at many places in kernel units, and their rates
    (coordinates, places, freedoms) where one direction of each chart after the other has unit
    rate."""
    session = forces.session
    known = session.problem.quantities()
    names = [f"{joint}.{name}" for joint, name in coordinates]
    wanted = [known[name + suffix] for suffix in ("", "_dot") for name in names]
    readout = session.readout(wanted)
    count = places.state.shape[1]
    outputs = forces.read(places, readout).reshape(-1, count, forces.freedoms)
    joints = session.layout.mechanism.joints
    values, rates = [], []
    for (joint, name), full in zip(coordinates, names, strict=True):
        unit = joints[joint].unit_of(name, session.layout.length)
        value = outputs[readout.slots[full].start][:, 0]
        if session.layout.joint_reference[joint] < 0:
            slot = session.structure.turn_slot(known[full])
            if slot is not None:
                value = continuous_angle(value, places.turns[slot])
        values.append(value / unit)
        rates.append(outputs[readout.slots[full + "_dot"].start] / unit)
    return np.array(values), np.array(rates)


@remembered
def _alone(session: Session) -> tuple[Session, ...]:
    """Sessions in which one load acts alone, or all weights."""
    problem = session.problem
    mechanism = problem.mechanism
    acting = [replace(mechanism, loads=(load,), gravity=ZERO) for load in mechanism.loads]
    if mechanism.gravity != ZERO:
        acting.append(replace(mechanism, loads=()))
    return tuple(with_loads(session, replace(problem, mechanism=each)) for each in acting)


_PARTS = np.array([0.0625, 0.25, 0.5, 0.75, 1.0])
"""Parts of a step at which the forces are looked at: of one freedom these, two places beside the
end and the rates there are eight lanes."""


def search(balancing: Balancing, start: FreePlace) -> Search:
    """Searches for an equilibrium from a place."""
    return searches(balancing, FreePlace.many([start]))[0]


def searches(balancing: Balancing, starts: FreePlace) -> list[Search]:
    """Searches for equilibria from many places."""
    found = _Searches(balancing, starts)
    while found.active.size:
        found.step()
    return found.results()


class _Searches:
    """Searches side by side: the place of each, forces (freedoms, searches) and slopes (freedoms,
    freedoms, searches) there, the length of its last step, and how it ended."""

    def __init__(self, balancing: Balancing, starts: FreePlace) -> None:
        self.balancing, self.free = balancing, balancing.forces
        count = starts.state.shape[1]
        self.place = FreePlace(*(array.copy() for array in starts))
        self.largest = balancing.largest(starts)
        self.forces = np.full((self.free.freedoms, count), np.nan)
        self.matrix = np.full((self.free.freedoms, self.free.freedoms, count), np.nan)
        self.length = np.full(count, np.inf)
        self.settled = np.zeros(count, dtype=bool)
        self.steps = np.zeros(count, dtype=np.int64)
        self.ends: list[SearchEnd | None] = [None] * count
        self._differentiate(np.arange(count))

    @property
    def active(self) -> NDArray[np.intp]:
        """The searches that have not ended."""
        return np.flatnonzero([end is None for end in self.ends])

    def results(self) -> list[Search]:
        """The searches, when all have ended."""
        return [
            Search(
                self.place.at(k), self.forces[:, k], float(self.largest[k]), end, int(self.steps[k])
            )
            for k, end in enumerate(self.ends)
            if end is not None
        ]

    def _put(self, numbers: NDArray[np.intp], places: FreePlace) -> None:
        for own, array in zip(self.place, places, strict=True):
            own[..., numbers] = array

    def _differentiate(self, numbers: NDArray[np.intp]) -> None:
        """Forces and slopes at the places of some searches; they end where there are none."""
        if not numbers.size:
            return
        forces, matrices, good = slopes_each(self.free, self.place.at(numbers))
        self._take(numbers, forces, matrices, good)

    def _take(
        self, numbers: NDArray[np.intp], forces: Floats, matrices: Floats, good: Bools
    ) -> None:
        self.forces[:, numbers[good]] = forces[:, good]
        self.matrix[:, :, numbers[good]] = matrices[:, :, good]
        for k in numbers[~good].tolist():
            self.ends[k], self.largest[k] = SearchEnd.NO_FORCES, 0.0

    def step(self) -> None:
        """A step of each search, or its end."""
        wanted: dict[int, Floats] = {}
        stuck: dict[int, SearchEnd] = {}
        slope = np.abs(self.matrix).max(axis=(0, 1))
        size = np.abs(self.forces).max(axis=0)
        balances = size <= tolerances.EQUILIBRIUM_ROUNDING * np.maximum(self.largest, slope)
        for k in self.active.tolist():
            step = newton_step(self.matrix[:, :, k], self.forces[:, k])
            near = self.length[k] <= tolerances.EQUILIBRIUM_STEP
            before, length = float(self.length[k]), _length(step)
            self.length[k] = length
            # steps to a marginal place shrink slowly, and go on as long as forces become smaller
            lingers = tolerances.LINGERING_STEP * before < length < before
            is_last = self.steps[k] == tolerances.MOST_EQUILIBRIUM_STEPS
            if near or (balances[k] and (is_last or not lingers)):
                self._end(k, SearchEnd.FOUND, max(self.largest[k], slope[k]))
            elif is_last:
                self._end(k, SearchEnd.STEPS, slope[k])
            elif length > tolerances.WILD_STEP:
                stuck[k] = SearchEnd.LEAST
            else:
                far = length > tolerances.EQUILIBRIUM_REACH
                wanted[k] = step * (tolerances.EQUILIBRIUM_REACH / length) if far else step
        stuck.update(self._move(wanted))
        lost = [k for k in stuck if balances[k]]
        for k in lost:
            self._end(k, SearchEnd.FOUND, max(self.largest[k], slope[k]))
        lost = [k for k in stuck if not balances[k]]
        down = [
            k for k in lost if not self.settled[k] and self.length[k] > tolerances.EQUILIBRIUM_STEP
        ]
        moved = self._settle(np.array(down, dtype=np.intp)) if down else []
        lost = [k for k in lost if k not in moved]
        if lost:
            # rounding alone may be left
            largest = np.maximum(self.balancing.largest(self.place.at(np.array(lost))), slope[lost])
            for k, most in zip(lost, largest.tolist(), strict=True):
                end = stuck[k]
                if size[k] <= tolerances.EQUILIBRIUM_BALANCE * most:
                    end = SearchEnd.FOUND
                elif self.settled[k] and self.length[k] > tolerances.WILD_STEP:
                    end = SearchEnd.RUNAWAY
                self._end(k, end, most)
        going = self.active
        self.steps[going] += 1
        far = going[self.steps[going] % 8 == 0]
        if far.size:
            slides = np.abs(self.balancing.named_each(self.place.at(far))[0]).max(axis=0)
            for k in far[slides > tolerances.FAR_EQUILIBRIUM].tolist():
                self._end(k, SearchEnd.RUNAWAY, slope[k])

    def _end(self, k: int, end: SearchEnd, largest: float) -> None:
        self.ends[k], self.largest[k] = end, largest

    def _move(self, wanted: dict[int, Floats]) -> dict[int, SearchEnd]:
        """Takes steps to where the forces are least along them, if they are less than before; the
        searches of which there is no such place, and why."""
        if not wanted:
            return {}
        numbers = np.array(list(wanted))
        steps = np.stack(list(wanted.values()), axis=-1)
        places, every = self.place.at(numbers), np.arange(numbers.size)
        # most go to the full step's end: the slopes and the chart there come with it
        along, beside, rates = self.free.along(
            places, steps, _PARTS, _stencil(self.free.freedoms)[:, 1:]
        )
        reached = smooth_each(places.state, along)
        sizes = summed(along.forces * along.forces)
        sizes = np.where(np.arange(_PARTS.size) < reached[:, None], sizes, np.inf)
        best = np.argmin(sizes, axis=1)
        moves = sizes[every, best] < summed(self.forces[:, numbers] * self.forces[:, numbers])
        stalled = (reached == _PARTS.size) | ((reached == 0) & along.good[:, 0])
        failed = {
            int(numbers[k]): SearchEnd.LEAST if stalled[k] else SearchEnd.BRANCH_ENDS
            for k in np.flatnonzero(~moves)
        }
        ends = FreePlace(along.states[:, every, best], along.turns[:, every, best], places.tangents)
        full = moves & (best == _PARTS.size - 1) & np.isfinite(rates).all(axis=(0, 1))
        going = self._arrive(numbers, full, ends, rates, along, beside)
        part = np.flatnonzero(moves & ~full)
        if part.size:
            charted, good = self.free.charted(ends.at(part))
            self._put(numbers[part[good]], charted.at(good))
            self._differentiate(numbers[part[good]])
            going[part] = good
        failed.update(dict.fromkeys(numbers[moves & ~going].tolist(), SearchEnd.BRANCH_ENDS))
        return failed

    def _arrive(
        self,
        numbers: NDArray[np.intp],
        full: Bools,
        ends: FreePlace,
        rates: Floats,
        along: ForcesAt,
        beside: ForcesAt,
    ) -> Bools:
        """Takes the ends of full steps, with charts from the free rates there, and the forces and
        slopes by these; which have one."""
        columns, n = rates.shape[1], len(rates)
        chosen = np.flatnonzero(full)
        unit = np.repeat(np.eye(n)[:, :, None], chosen.size, axis=2)
        rows = np.concatenate([rates[:, :, chosen], unit], axis=1)
        basis, independent = orthonormal_each(rows, columns)
        # the rates of the chart before, where a direction of the new one has unit rate
        before = basis[:, columns:]
        forces = np.stack([summed(a * along.forces[:, chosen, -1]) for a in before])
        old = _differences(beside.forces)[:, :, chosen].swapaxes(0, 1)
        matrices = np.stack(
            [np.stack([summed(a * summed(b[:, None] * old)) for b in before]) for a in before]
        )
        good = np.logical_and.reduce(beside.good, axis=1)[chosen]
        own = chosen[independent]
        places = ends.at(own)._replace(tangents=basis[:, :columns, independent])
        self._put(numbers[own], places)
        self._take(
            numbers[own], forces[:, independent], matrices[:, :, independent], good[independent]
        )
        going = np.zeros(full.size, dtype=bool)
        going[own] = True
        return going

    def _settle(self, numbers: NDArray[np.intp]) -> list[int]:
        """Goes down from the places of some searches; which of them moved."""
        self.settled[numbers] = True
        lower, moved = settle(self.balancing, self.place.at(numbers))
        own = numbers[moved]
        self._put(own, lower.at(moved))
        self._differentiate(own)
        return [int(k) for k in own]


def _length(step: Floats) -> float:
    return float(np.sqrt(summed(step * step)))


def _stencil(count: int) -> Floats:
    """Steps (freedoms, 1 + 2 freedoms) from a place by which slopes are differenced, after none."""
    u = np.zeros((count, 2 * count + 1))
    for k in range(count):
        u[k, 2 * k + 1], u[k, 2 * k + 2] = (
            tolerances.NEWTON_DIFFERENCE,
            -tolerances.NEWTON_DIFFERENCE,
        )
    return u


def _differences(forces: Floats) -> Floats:
    """Slopes (freedoms, freedoms, places) from forces (freedoms, places, steps) at a stencil."""
    matrices = (forces[..., 0::2] - forces[..., 1::2]) / (2.0 * tolerances.NEWTON_DIFFERENCE)
    return matrices.transpose(0, 2, 1)


def slopes(forces: Forces, place: FreePlace) -> tuple[Floats, Floats] | None:
    """Forces (freedoms,) and their slopes (freedoms, freedoms) at a place; None where there are
    none."""
    found, matrices, good = slopes_each(forces, FreePlace.many([place]))
    return (found[:, 0], matrices[:, :, 0]) if good[0] else None


def slopes_each(forces: Forces, places: FreePlace) -> tuple[Floats, Floats, Bools]:
    """Forces (freedoms, places) and their slopes (freedoms, freedoms, places) at many places; and
    where there are any (places,)."""
    u = _stencil(forces.freedoms)[:, None, :].repeat(places.state.shape[1], axis=1)
    found = forces.about(places, u)
    good = np.logical_and.reduce(found.good, axis=1)
    return found.forces[..., 0], _differences(found.forces[..., 1:]), good


def newton_step(matrix: Floats, forces: Floats) -> Floats:
    """The step (freedoms,) at whose end forces would vanish if they were linear; of singular slopes
    a damped one."""
    count = forces.size
    scale = float(np.max(np.abs(matrix), initial=0.0))
    if not scale > 0.0:
        return np.full(count, np.inf)
    solved = None
    if np.max(np.abs(matrix), axis=1).min() > tolerances.MARGINAL_STIFFNESS * scale:
        solved = eliminated(matrix.tolist(), (-forces).tolist(), tolerances.MARGINAL_STIFFNESS)
    if solved is not None:
        return np.array(solved)
    # least squares with a little damping: along what is indifferent nothing moves
    normal = np.zeros((count, count))
    right = np.zeros(count)
    for k in range(count):
        normal += matrix[k][:, None] * matrix[k][None, :]
        right -= matrix[k] * forces[k]
    normal += np.eye(count) * (tolerances.MARGINAL_STIFFNESS * scale * scale)
    damped = eliminated(normal.tolist(), right.tolist(), 0.0)
    return np.full(count, np.inf) if damped is None else np.array(damped)


def smooth_each(states: Floats, along: ForcesAt) -> NDArray[np.intp]:
    """How many places along each step from some states (states, steps), at `_PARTS` of it, lie on
    one smooth branch (steps,): the states go evenly from each to the next, as none do that jump to
    another branch."""
    count = along.good.shape[1]
    good = np.argmin(np.concatenate([along.good, np.zeros((len(along.good), 1), bool)], 1), axis=1)
    inside = np.arange(count) < good[:, None]
    every = np.concatenate([states[:, :, None], along.states], axis=2)
    pace = np.where(inside, np.diff(every, axis=2) / np.diff(np.concatenate([[0.0], _PARTS])), 0.0)
    change = np.abs(np.diff(pace, axis=2)).max(axis=0)
    fastest = np.maximum.accumulate(np.abs(pace).max(axis=0), axis=1)[:, 1:]
    jumps = inside[:, 1:] & (change > tolerances.SMOOTH_STEP * fastest)
    first = np.where(jumps.any(axis=1), np.argmax(jumps, axis=1) + 1, count)
    reached: NDArray[np.intp] = np.minimum(good, first)
    return reached


def settle(balancing: Balancing, starts: FreePlace) -> tuple[FreePlace, Bools]:
    """Places lower than many starts, near those where the mechanism would come to rest, and which
    of them moved (places,): steps against the forces, by slopes of either sign taken as positive,
    each as far as the forces still push."""
    forces = balancing.forces
    places = FreePlace(*(array.copy() for array in starts))
    moved = np.zeros(starts.state.shape[1], dtype=bool)
    active = np.arange(moved.size)
    for _ in range(tolerances.MOST_SETTLING_STEPS):
        pushes, matrices, good = slopes_each(forces, places.at(active))
        steps = [
            _step_down(pushes[:, k], matrices[:, :, k]) if good[k] else None
            for k in range(active.size)
        ]
        going = np.array([step is not None for step in steps], dtype=bool)
        active = active[going]
        if not active.size:
            break
        wanted = np.stack([step for step in steps if step is not None], axis=-1)
        own = places.at(active)
        found = forces.about(own, wanted[:, :, None] * _PARTS)
        reached = smooth_each(own.state, found)
        onward = (summed(found.forces * wanted[:, :, None]) <= 0.0) & (
            np.arange(_PARTS.size) < reached[:, None]
        )
        # as far as it still goes down
        ahead = np.concatenate([onward, np.zeros((active.size, 1), dtype=bool)], axis=1)
        last = np.maximum(np.argmin(ahead, axis=1) - 1, 0)
        every = np.arange(active.size)
        ends = FreePlace(found.states[:, every, last], found.turns[:, every, last], own.tangents)
        charted, good = forces.charted(ends)
        good &= reached > 0
        active = active[good]
        for array, new in zip(places, charted.at(good), strict=True):
            array[..., active] = new
        moved[active] = True
    return places, moved


def _step_down(pushes: Floats, matrix: Floats) -> Floats | None:
    """A step (freedoms,) against the forces; None where it is short, or nothing pushes."""
    values, vectors = eigen(0.5 * (matrix + matrix.T))
    scale = float(np.max(np.abs(values)))
    if not scale > 0.0:
        scale = _length(pushes)
    if not scale > 0.0:
        return None
    sizes = np.maximum(np.abs(values), tolerances.SETTLING_STIFFNESS * scale)
    wanted = np.zeros(pushes.size)
    for k in range(pushes.size):
        wanted = wanted - vectors[:, k] * (float(summed(vectors[:, k] * pushes)) / sizes[k])
    length = _length(wanted)
    if length < tolerances.SETTLED_STEP:
        return None
    return wanted * min(1.0, tolerances.EQUILIBRIUM_REACH / length)
