"""Which end points of a search are the same assembly, and how many may still be unknown."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.kernel import functions
from mechkin_cli.solver.layout import Layout

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


class Clusters:
    """Representatives (columns of `states`) of the assemblies that the starts of a block ended on,
    and how often each was met."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        self.states = np.empty((layout.states, 0))
        self.keys = pose_keys(layout, self.states)
        self.met = np.empty(0, dtype=np.int64)
        self.tried = 0
        self.closed = 0
        self.free = 0
        self.closest = float("inf")

    def add(self, states: Floats) -> None:
        """Sorts assemblies (columns) into the clusters."""
        self.closed += states.shape[1]
        keys = pose_keys(self.layout, states)
        while keys.shape[1]:
            known = same_poses(self.keys, keys)
            self.met += np.count_nonzero(known, axis=1)
            left = np.flatnonzero(~known.any(axis=0))
            states, keys = states[:, left], keys[:, left]
            # the rest may be met by one of themselves: take in the first, look again
            self.states = np.concatenate([self.states, states[:, :1]], axis=1)
            self.keys = np.concatenate([self.keys, keys[:, :1]], axis=1)
            self.met = np.append(self.met, np.zeros(states[:, :1].shape[1], dtype=np.int64))

    @property
    def chance(self) -> float:
        """Estimated chance that one more closing start finds a new assembly."""
        return max(int(np.count_nonzero(self.met == 1)), 1) / self.closed if self.closed else 1.0

    @property
    def settled(self) -> bool:
        """Whether more starts are not worth it."""
        if not self.closed:
            return self.tried >= tolerances.SEARCH_HOPELESS_STARTS
        return self.chance < tolerances.SEARCH_NEW_MODE_CHANCE

    @property
    def exhausted(self) -> bool:
        """Whether the search gives up."""
        crowded = self.met.size > tolerances.SEARCH_MOST_MODES
        return crowded or self.tried >= tolerances.SEARCH_MOST_STARTS


def pose_keys(layout: Layout, states: Floats, left_out: Collection[tuple[int, int]] = ()) -> Floats:
    """What tells assemblies apart: cosines and sines of turns, slides, products of quaternions.

    `left_out` are freedoms (tree edge, number) that do not matter.
    """
    keys: list[Floats] = []
    for carrier in layout.carriers:
        state = carrier.state
        if (carrier.edge, carrier.first_freedom) in left_out:
            continue
        if carrier.part.type.is_ball:
            q = states[state : state + 4]
            keys.extend(q[i] * q[j] for i in range(4) for j in range(i, 4))
            continue
        for number, freedom in enumerate(carrier.part.type.freedoms):
            value = np.ascontiguousarray(states[state + number])
            if freedom.is_cyclic:
                keys.extend((functions.cos(value), functions.sin(value)))
            else:
                keys.append(value)
    return np.stack(keys) if keys else np.zeros((0, states.shape[1]))


def same_poses(
    known: Floats, keys: Floats, limit: float = tolerances.SAME_MODE
) -> NDArray[np.bool_]:
    """Which columns of `keys` are the poses of which columns of `known`: (known, keys)."""
    found = np.ones((known.shape[1], keys.shape[1]), dtype=bool)
    for one, other in zip(known, keys, strict=True):
        found &= np.abs(one[:, None] - other[None, :]) < limit
    return found
