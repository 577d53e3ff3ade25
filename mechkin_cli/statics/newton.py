"""The search for one equilibrium: Newton's steps towards any place at which the forces vanish,
stable or not; where they end without one, once down to where the mechanism would come to rest.

Each step is taken on a chart about the place before, so no dead centre of a coordinate stops it. It
goes as far as the forces become smaller, and as the places along it lie on one smooth branch.
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
from mechkin_cli.session import turn_count
from mechkin_cli.statics.forces import DrivenAt, Forces, ForcesAt, FreePlace, summed
from mechkin_cli.statics.places import Place, Statics, eigen

if TYPE_CHECKING:
    from mechkin_cli.session import Coordinate, Session
    from mechkin_cli.show import Floats


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

    def largest(self, place: FreePlace) -> float:
        """The largest force of one load alone, or of all weights, and the largest slope of one, for
        a unit of the chart: what balances at a place and about it."""
        most = 0.0
        for one in self.alone:
            found = slopes(one, place)
            if found is not None:
                most = max(most, *(float(np.max(np.abs(each))) for each in found))
        return most

    def charted(self, statics: Statics, place: Place) -> FreePlace:
        """A place of the chosen session with a chart about it.

        Raises:
            ValueError: a named coordinate stands at a dead centre there.
        """
        session, layout = self.chosen, self.chosen.layout
        state = place.state.copy()
        # a free motion's states have the whole turns of the tree's angles
        for slot, row in session.structure.tree_slots.items():
            state[slot] += 2.0 * pi * place.turns[row]
        closing = place.turns.size - len(session.structure.tree_slots)
        turns = np.zeros(turn_count(self.forces.session.plan))
        turns[:closing] = place.turns[:closing]
        for number, (edge, freedom) in enumerate(session.graph.inputs):
            state[layout.state(edge, freedom)] = place.inputs[number]
        tangents = statics.tangents(place.inputs[:, None], place.state[:, None])[:, :, 0]
        return self.forces.place(state, turns, tangents)

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
        return coordinates_at(self.forces, self.coordinates, place)


def coordinates_at(
    forces: Forces, coordinates: list[Coordinate], place: FreePlace
) -> tuple[Floats, Floats]:
    """Some coordinates (coordinates,) at a place in kernel units, and their rates (coordinates,
    freedoms) where one direction of its chart after the other has unit rate."""
    session = forces.session
    known = session.problem.quantities()
    names = [f"{joint}.{name}" for joint, name in coordinates]
    wanted = [known[name + suffix] for suffix in ("", "_dot") for name in names]
    readout = session.readout(wanted)
    outputs = forces.read(place, readout)
    joints = session.layout.mechanism.joints
    values, rates = [], []
    for (joint, name), full in zip(coordinates, names, strict=True):
        unit = joints[joint].unit_of(name, session.layout.length)
        value = outputs[readout.slots[full].start][:1]
        if session.layout.joint_reference[joint] < 0:
            slot = session.structure.turn_slot(known[full])
            if slot is not None:
                value = forces.continuous(value, place, slot)
        values.append(float(value[0]) / unit)
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


_PARTS = np.array([0.0625, 0.125, 0.25, 0.5, 0.75, 1.0])
"""Parts of a step at which the forces are looked at."""


def search(balancing: Balancing, start: FreePlace) -> Search:
    """Searches for an equilibrium from a place."""
    place, steps = start, 0
    largest = balancing.largest(place)
    count = balancing.forces.freedoms
    forces, length, settled = np.full(count, np.nan), np.inf, False
    while True:
        found = slopes(balancing.forces, place)
        if found is None:
            return Search(place, forces, 0.0, SearchEnd.NO_FORCES, steps)
        forces, matrix = found
        size, slope = float(np.max(np.abs(forces))), float(np.max(np.abs(matrix)))
        wanted = newton_step(matrix, forces)
        near = length <= tolerances.EQUILIBRIUM_STEP
        balances = size <= tolerances.EQUILIBRIUM_ROUNDING * max(largest, slope)
        before, length = length, _length(wanted)
        # steps to a marginal place shrink slowly, and go on as long as forces become smaller
        lingers = tolerances.LINGERING_STEP * before < length < before
        is_last = steps == tolerances.MOST_EQUILIBRIUM_STEPS
        if near or (balances and (is_last or not lingers)):
            return Search(place, forces, max(largest, slope), SearchEnd.FOUND, steps)
        if is_last:
            return Search(place, forces, slope, SearchEnd.STEPS, steps)
        if tolerances.EQUILIBRIUM_REACH < length <= tolerances.WILD_STEP:
            wanted = wanted * (tolerances.EQUILIBRIUM_REACH / length)
        moved, end = None, SearchEnd.LEAST
        if length <= tolerances.WILD_STEP:
            moved, end = _moved(balancing.forces, place, wanted, forces)
        if moved is None and balances:
            return Search(place, forces, max(largest, slope), SearchEnd.FOUND, steps)
        if moved is None and not settled and length > tolerances.EQUILIBRIUM_STEP:
            lower = settle(balancing, place)
            settled, moved = True, None if lower is place else lower
        if moved is None:
            # rounding alone may be left
            largest = max(balancing.largest(place), slope)
            if size <= tolerances.EQUILIBRIUM_BALANCE * largest:
                end = SearchEnd.FOUND
            elif settled and length > tolerances.WILD_STEP:
                end = SearchEnd.RUNAWAY
            return Search(place, forces, largest, end, steps)
        steps += 1
        place = moved
        slide = float(np.max(np.abs(balancing.named(place)[0]))) if steps % 8 == 0 else 0.0
        if slide > tolerances.FAR_EQUILIBRIUM:
            return Search(place, forces, slope, SearchEnd.RUNAWAY, steps)


def _length(step: Floats) -> float:
    return float(np.sqrt(summed(step * step)))


def slopes(forces: Forces, place: FreePlace) -> tuple[Floats, Floats] | None:
    """Forces (freedoms,) and their slopes (freedoms, freedoms) at a place; None where there are
    none."""
    count, step = forces.freedoms, tolerances.NEWTON_DIFFERENCE
    u = np.zeros((count, 2 * count + 1))
    for k in range(count):
        u[k, 2 * k + 1], u[k, 2 * k + 2] = step, -step
    found = forces.at(place, u)
    if not found.good.all():
        return None
    return found.forces[:, 0], (found.forces[:, 1::2] - found.forces[:, 2::2]) / (2.0 * step)


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


def _moved(
    forces: Forces, place: FreePlace, wanted: Floats, before: Floats
) -> tuple[FreePlace | None, SearchEnd]:
    """The place along a step where the forces are least, if they are less than before; else why
    there is none."""
    found = forces.at(place, wanted[:, None] * _PARTS)
    reached = smooth_parts(place, found, _PARTS)
    if not reached:
        return None, SearchEnd.BRANCH_ENDS if not found.good[0] else SearchEnd.LEAST
    sizes = summed(found.forces * found.forces)[:reached]
    best = int(np.argmin(sizes))
    if not sizes[best] < float(summed(before * before)):
        return None, SearchEnd.LEAST if reached == _PARTS.size else SearchEnd.BRANCH_ENDS
    try:
        return forces.moved(place, found, best), SearchEnd.FOUND
    except ValueError:
        return None, SearchEnd.BRANCH_ENDS


def smooth_parts(place: FreePlace, found: ForcesAt, parts: Floats) -> int:
    """How many places along a step, in rising parts of it, lie on one smooth branch: the states go
    evenly from each to the next, as none do that jump to another branch."""
    good = int(np.argmin(np.append(found.good, False)))
    states = np.concatenate([place.state[:, None], found.states[:, :good]], axis=1)
    at = np.concatenate([[0.0], parts[:good]])
    pace = np.diff(states, axis=1) / np.diff(at)
    for k in range(1, good):
        change = float(np.max(np.abs(pace[:, k] - pace[:, k - 1])))
        if change > tolerances.SMOOTH_STEP * float(np.max(np.abs(pace[:, : k + 1]))):
            return k
    return good


def settle(balancing: Balancing, start: FreePlace) -> FreePlace:
    """A place lower than a start, near one where the mechanism would come to rest: steps against
    the forces, by slopes of either sign taken as positive, each as far as the forces still push."""
    place, forces = start, balancing.forces
    for _ in range(tolerances.MOST_SETTLING_STEPS):
        known = slopes(forces, place)
        if known is None:
            return place
        pushes, matrix = known
        values, vectors = eigen(0.5 * (matrix + matrix.T))
        scale = float(np.max(np.abs(values)))
        if not scale > 0.0:
            scale = _length(pushes)
        if not scale > 0.0:
            return place
        sizes = np.maximum(np.abs(values), tolerances.SETTLING_STIFFNESS * scale)
        wanted = np.zeros(forces.freedoms)
        for k in range(forces.freedoms):
            wanted = wanted - vectors[:, k] * (float(summed(vectors[:, k] * pushes)) / sizes[k])
        length = _length(wanted)
        if length < tolerances.SETTLED_STEP:
            return place
        wanted = wanted * min(1.0, tolerances.EQUILIBRIUM_REACH / length)
        found = forces.at(place, wanted[:, None] * _PARTS)
        reached = smooth_parts(place, found, _PARTS)
        if not reached:
            return place
        onward = summed(found.forces * wanted[:, None])[:reached] <= 0.0
        # as far as it still goes down
        last = max(int(np.argmin(np.append(onward, False))) - 1, 0)
        try:
            place = forces.moved(place, found, last)
        except ValueError:
            return place
    return place
