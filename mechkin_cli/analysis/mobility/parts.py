"""Parts of a mechanism whose loops have no joint in common: each moves on its own.

Loops of a spanning tree that share a joint, one after the other, are a part; its freedoms are those
of the joints passed. What no loop passes moves freely. Motions of the whole are products of
motions of the parts, so that dimensions add up.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.mobility.loops import Loops
    from mechkin_cli.arrays import Floats


class Part:
    """Loops that share joints: numbers of their equations `rows` and freedoms `columns`."""

    def __init__(self, loops: Loops, cuts: NDArray[np.intp], columns: NDArray[np.intp]) -> None:
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


def parts(loops: Loops) -> tuple[Part, ...]:
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
        found.append(Part(loops, np.array(sorted(cuts)), np.flatnonzero(columns)))
    return tuple(found)
