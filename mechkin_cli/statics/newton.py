"""The search for one equilibrium: Newton's steps towards any place at which the forces vanish,
stable or not, down along the forces where their slopes say nothing.

A step goes along the branch of the assembly, as far as the forces become smaller; where the branch
ends on the way, as far as it leads.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism import eliminated
from mechkin_cli.record import NamedTuple
from mechkin_cli.statics.places import Place, Statics, eigen

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class SearchEnd(Enum):
    """Why a search ended."""

    FOUND = "found"
    LEAST = "no step makes the forces smaller"
    RUNAWAY = "the mechanism runs away"
    BRANCH_ENDS = "the branch of its assembly ends"
    NO_FORCES = "the loads have no value there"
    STEPS = "steps ran out"


class Search(NamedTuple):
    """The last place of a search, the forces there (free,), the largest force of one load, the
    length of its last step, and why it ended."""

    place: Place
    forces: Floats
    largest: float
    step: float
    end: SearchEnd
    steps: int

    @property
    def found(self) -> bool:
        """Whether the loads balance there."""
        return self.end is SearchEnd.FOUND


_PARTS = np.array([0.0, 0.0625, 0.125, 0.25, 0.5, 0.75, 1.0])
"""Parts of a step at which the forces are looked at."""


def search(statics: Statics, start: Place, time: float) -> Search:
    """Searches for an equilibrium from a place, at a moment (s)."""
    place, free = start, statics.free
    largest = statics.largest(place, time)
    steps, forces = 0, np.zeros(statics.count)
    length = 0.0
    while True:
        found = slopes(statics, place, time)
        if found is None:
            return Search(place, forces, largest, length, SearchEnd.NO_FORCES, steps)
        forces, matrix = found
        size = float(np.max(np.abs(forces)))
        scale = max(largest, float(np.max(np.abs(matrix))))
        wanted = newton_step(matrix, forces)
        length = float(np.sqrt((wanted * wanted).sum()))
        if size <= tolerances.EQUILIBRIUM_ROUNDING * scale:
            return Search(place, forces, largest, length, SearchEnd.FOUND, steps)
        if steps == tolerances.MOST_EQUILIBRIUM_STEPS:
            return Search(place, forces, largest, length, SearchEnd.STEPS, steps)
        if length > tolerances.WILD_STEP:
            wanted = -forces * (tolerances.EQUILIBRIUM_REACH / np.sqrt((forces * forces).sum()))
        elif length > tolerances.EQUILIBRIUM_REACH:
            wanted = wanted * (tolerances.EQUILIBRIUM_REACH / length)
        moved, end = _moved(statics, place, wanted, forces, time)
        if end is SearchEnd.LEAST and length > tolerances.EQUILIBRIUM_STEP:
            down = -forces * (tolerances.EQUILIBRIUM_REACH / np.sqrt((forces * forces).sum()))
            moved, end = _moved(statics, place, down, forces, time)
        if moved is None:
            # rounding alone may be left
            largest = statics.largest(place, time)
            scale = max(largest, float(np.max(np.abs(matrix))))
            if end is SearchEnd.LEAST and size <= tolerances.EQUILIBRIUM_BALANCE * scale:
                end = SearchEnd.FOUND
            return Search(place, forces, largest, length, end, steps)
        steps += 1
        place, forces = moved
        off = np.abs(place.inputs[free] - start.inputs[free])
        if float(np.max(np.where(statics.cyclic[free], 0.0, off))) > tolerances.FAR_EQUILIBRIUM:
            return Search(place, forces, largest, length, SearchEnd.RUNAWAY, steps)
        if length <= tolerances.EQUILIBRIUM_STEP:
            return Search(
                place, forces, statics.largest(place, time), length, SearchEnd.FOUND, steps
            )


def slopes(statics: Statics, place: Place, time: float) -> tuple[Floats, Floats] | None:
    """Forces (free,) and their slopes (free, free) at a place; None where there are none."""
    count, step = statics.count, tolerances.NEWTON_DIFFERENCE
    steps = np.zeros((count, 2 * count + 1))
    for k in range(count):
        steps[k, 2 * k + 1], steps[k, 2 * k + 2] = step, -step
    found = statics.beside(place, steps, time)
    if not found.good.all():
        return None
    forces = found.forces[:, 0]
    matrix = (found.forces[:, 1::2] - found.forces[:, 2::2]) / (2.0 * step)
    return forces, matrix


def newton_step(matrix: Floats, forces: Floats) -> Floats:
    """The step (free,) at whose end forces would vanish if they were linear; of singular slopes a
    damped one."""
    scale = float(np.max(np.abs(matrix), initial=0.0))
    solved = None
    if np.max(np.abs(matrix), axis=1).min() > tolerances.MARGINAL_STIFFNESS * scale:
        solved = eliminated(matrix.tolist(), (-forces).tolist(), tolerances.MARGINAL_STIFFNESS)
    if solved is not None:
        return np.array(solved)
    if not scale > 0.0:
        return np.full(forces.size, np.inf)
    # least squares with a little damping: along what is indifferent nothing moves
    count = forces.size
    normal = np.zeros((count, count))
    right = np.zeros(count)
    for k in range(count):
        normal += matrix[k][:, None] * matrix[k][None, :]
        right -= matrix[k] * forces[k]
    normal += np.eye(count) * (tolerances.MARGINAL_STIFFNESS * scale * scale)
    damped = eliminated(normal.tolist(), right.tolist(), 0.0)
    return np.full(count, np.inf) if damped is None else np.array(damped)


def _moved(
    statics: Statics, place: Place, wanted: Floats, forces: Floats, time: float
) -> tuple[tuple[Place, Floats] | None, SearchEnd]:
    """The place along a step where the forces are least, and these, if they are less than before;
    else why there is none."""
    inputs = np.repeat(place.inputs[:, None], _PARTS.size, axis=1)
    inputs[statics.free] += wanted[:, None] * _PARTS
    way = statics.way(inputs, place)
    if way.reached < 2:
        return None, SearchEnd.BRANCH_ENDS
    reached = slice(1, way.reached)
    found = statics.forces(
        inputs[:, reached], way.states[:, reached], way.turns[:, reached],
        np.full(way.reached - 1, time),
    )
    sizes = np.where(found.good, (found.forces * found.forces).sum(axis=0), np.inf)
    if not found.good.any():
        return None, SearchEnd.NO_FORCES
    best = int(np.argmin(sizes))
    if not sizes[best] < (forces * forces).sum():
        ends = way.reached < _PARTS.size
        return None, SearchEnd.BRANCH_ENDS if ends else SearchEnd.LEAST
    at = best + 1
    moved = Place(inputs[:, at], found.states[:, best], way.turns[:, at])
    return (moved, found.forces[:, best]), SearchEnd.FOUND


def settle(statics: Statics, start: Place, time: float) -> Place:
    """A place lower than a start, near one where the mechanism would come to rest: steps against
    the forces, by slopes of either sign taken as positive, each as far as the forces still push."""
    place = start
    for _ in range(tolerances.MOST_SETTLING_STEPS):
        found = slopes(statics, place, time)
        if found is None:
            return place
        forces, matrix = found
        values, vectors = eigen(0.5 * (matrix + matrix.T))
        scale = float(np.max(np.abs(values)))
        if not scale > 0.0:
            return place
        sizes = np.maximum(np.abs(values), tolerances.SETTLING_STIFFNESS * scale)
        wanted = np.zeros(statics.count)
        for k in range(statics.count):
            wanted = wanted - vectors[:, k] * (float((vectors[:, k] * forces).sum()) / sizes[k])
        length = float(np.sqrt((wanted * wanted).sum()))
        if length < tolerances.SETTLED_STEP:
            return place
        wanted = wanted * min(1.0, tolerances.EQUILIBRIUM_REACH / length)
        inputs = np.repeat(place.inputs[:, None], _PARTS.size, axis=1)
        inputs[statics.free] += wanted[:, None] * _PARTS
        way = statics.way(inputs, place)
        if way.reached < 2:
            return place
        reached = slice(1, way.reached)
        there = statics.forces(
            inputs[:, reached],
            way.states[:, reached],
            way.turns[:, reached],
            np.full(way.reached - 1, time),
        )
        pushes = (there.forces * wanted[:, None]).sum(axis=0)
        onward = there.good & (pushes <= 0.0)
        # as far as it still goes down
        count = int(np.argmin(np.append(onward, False)))
        if not count:
            count = 1
        place = Place(inputs[:, count], there.states[:, count - 1], way.turns[:, count])
    return place
