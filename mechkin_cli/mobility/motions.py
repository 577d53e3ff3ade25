"""The finite motions of the whole from those of its parts."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, reduce
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.mobility.configurations import Body, Configuration, LoopPart
from mechkin_cli.mobility.dimension import LocalFreedom
from mechkin_cli.mobility.opened import rank_of

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class Motions:
    """Motions from a `start` whose parts have the `freedoms`; every part has a component."""

    def __init__(
        self, body: Body, start: Configuration, freedoms: Sequence[tuple[LoopPart, LocalFreedom]]
    ) -> None:
        self.body, self.start, self.freedoms = body, start, freedoms

    @cached_property
    def dimensions(self) -> tuple[int, ...]:
        """Dimensions of all components that meet at the start, the largest first."""
        sums = reduce(
            lambda known, part: {a + b for a in known for b in part[1].dimensions},
            self.freedoms,
            {int(self.body.free.size)},
        )
        return tuple(sorted(sums, reverse=True))

    @property
    def mobility(self) -> int:
        """The largest dimension."""
        return self.dimensions[0]

    @property
    def places(self) -> int:
        """How many places beside the start were looked at."""
        return max((len(f.components) for _, f in self.freedoms if f.dimensions != (0,)), default=0)

    @cached_property
    def general(self) -> Configuration:
        """A general configuration of the largest component."""
        return self._at([freedom.components[0].state for _, freedom in self.freedoms])

    @cached_property
    def others(self) -> tuple[Configuration, ...]:
        """General configurations of more components, one of each dimension first."""
        every = [
            [c.state for c in freedom.components]
            + [place for c in freedom.components for place in c.places[1:]]
            for _, freedom in self.freedoms
        ]
        most = min(max(map(len, every), default=0), tolerances.MOBILITY_OTHERS)
        return tuple(
            self._at([p[k] if k < len(p) else p[0] for p in every]) for k in range(1, most)
        )

    def _at(self, states: Sequence[Floats]) -> Configuration:
        """The configuration whose parts are as in a state each."""
        loops, start = self.body.loops, self.start.state[None]
        steps = np.zeros((1, self.body.count))
        for (part, _), state in zip(self.freedoms, states, strict=True):
            steps[:, part.columns] = part.steps(state[None], start)
        return Configuration(self.body, loops.moved(start, steps)[0])

    @cached_property
    def stresses(self) -> Floats:
        """Stresses (6 cuts, redundant) at the general configuration."""
        jacobian = self.general.jacobian
        if not self.body.mechanism.plane:
            return rank_of(jacobian, tolerances.MOBILITY_RANK_REACHED).stresses
        # what the plane holds is no constraint: of each cut the moment about z, forces along x, y
        rows = (6 * np.arange(len(jacobian) // 6)[:, None] + (2, 3, 4)).ravel()
        inside = rank_of(jacobian[rows], tolerances.MOBILITY_RANK_REACHED).stresses
        stresses = np.zeros((len(jacobian), inside.shape[1]))
        stresses[rows] = inside
        return stresses

    @cached_property
    def tangents(self) -> Floats:
        """Motions (freedoms, mobility) of the largest component at the general configuration."""
        motions = np.zeros((self.body.count, self.mobility))
        free = self.body.free
        motions[free, np.arange(free.size)] = 1.0
        column = free.size
        for part, freedom in self.freedoms:
            tangents = freedom.components[0].tangents
            motions[part.columns, column : column + tangents.shape[1]] = tangents
            column += tangents.shape[1]
        return motions

    @cached_property
    def doubt(self) -> float:
        """How far entries of the tangents may be off."""
        doubts = (c.doubt for _, freedom in self.freedoms for c in freedom.components)
        return max(doubts, default=tolerances.RANK_ZERO)

    @cached_property
    def fixed(self) -> tuple[str, ...]:
        """Coordinates that no motion changes."""
        moving = np.zeros(self.body.count, dtype=np.bool_)
        moving[self.body.free] = True
        for part, freedom in self.freedoms:
            for component in freedom.components:
                rates = np.abs(component.tangents).max(axis=1, initial=0.0)
                moving[part.columns] |= rates > max(component.doubt, tolerances.RANK_ZERO)
        return self.body.coordinates(~moving)
