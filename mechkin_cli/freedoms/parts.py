"""Parts of a mechanism whose loops have no joint in common: each moves on its own.

Loops of a spanning tree that share a joint, one after the other, are a part; its freedoms are those
of the joints passed. What no loop passes moves freely. Motions of the whole are products of
motions of the parts, so that dimensions add up.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mechanism.model import GROUND_NAME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.freedoms.loops import Loops
    from mechkin_cli.mechanism.model import Mechanism


class Part:
    """Loops of a mechanism that share joints: numbers of their equations `rows` and freedoms
    `columns`."""

    def __init__(
        self,
        mechanism: Mechanism,
        loops: Loops,
        cuts: NDArray[np.intp],
        columns: NDArray[np.intp],
    ) -> None:
        self.mechanism = mechanism
        self.loops = loops
        self.columns = columns
        self.rows = (6 * cuts[:, None] + np.arange(6)).ravel()
        self.count = columns.size

    def closing(self, states: Floats) -> tuple[Floats, Floats]:
        """Misses (places, rows) and Jacobian (places, rows, columns) at states (places, states)."""
        misses, jacobian = self.loops.closing(states)
        return misses[:, self.rows], jacobian[:, self.rows[:, None], self.columns]

    def moved(self, states: Floats, steps: Floats) -> Floats:
        """States displaced by steps (places, columns)."""
        every = np.zeros((len(steps), self.loops.count))
        every[:, self.columns] = steps
        return self.loops.moved(states, every)

    def steps(self, states: Floats, others: Floats) -> Floats:
        """The steps (places, columns) from `others` to `states`."""
        return self.loops.steps(states, others)[:, self.columns]

    def alone(self, state: Floats, motions: Floats) -> Floats:
        """An orthonormal basis (k, count) of those of some `motions` (columns, k) from a place that
        move but one link, or two that are joined."""
        numbers = self.loops.number
        twists = self.loops.twists(*self.loops.poses.at(np.empty((0, 1)), state[:, None]))
        seen = twists[0][:, :, self.columns] @ motions
        links = [link for link in self.mechanism.links if link != GROUND_NAME]
        groups = [{link} for link in links]
        groups += [{j.first, j.second} for j in self.mechanism.joints.values()]
        found = [np.zeros((motions.shape[1], 0))]
        for group in groups:
            rest = [numbers[link] for link in links if link not in group]
            found.append(null_space(seen[rest].reshape(-1, motions.shape[1])))
        left, values, _ = np.linalg.svd(np.concatenate(found, axis=1), full_matrices=False)
        return np.asarray(left[:, values > tolerances.MOBILITY_FORM])


def null_space(matrix: Floats) -> Floats:
    """An orthonormal basis (columns, count) of what a matrix of unit twists maps to none."""
    _, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > tolerances.MOBILITY_NO_WRENCH))
    return np.asarray(right[rank:].T)


def parts(mechanism: Mechanism, loops: Loops) -> tuple[Part, ...]:
    """The parts in the order of their first cuts."""
    passed = loops.signs != 0.0
    left = list(range(len(passed)))
    found = []
    while left:
        cuts, grown = [left.pop(0)], True
        columns = passed[cuts[0]].copy()
        while grown:
            grown = False
            for cut in list(left):
                if np.any(passed[cut] & columns):
                    left.remove(cut)
                    cuts.append(cut)
                    columns |= passed[cut]
                    grown = True
        found.append(Part(mechanism, loops, np.array(sorted(cuts)), np.flatnonzero(columns)))
    return tuple(found)
