"""The loops of the opened mechanism at many states at once: how far they are open, and their
screws.

A state of the kernel holds the coordinates of all joints; a step (freedoms,) changes it, balls by
rotation vectors about the axes of the body before them. Twists are (angular, linear at the centre),
lengths in parts of the size. Arrays are (rows, ...).
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.freedoms.displacements import cross, displacement, turn_between, turned
from mechkin_cli.mechanism.elementary import screws_at
from mechkin_cli.mechanism.model import GROUND_NAME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.freedoms.opened import Opened, Poses
    from mechkin_cli.solver.layout import Layout


class Closing(NamedTuple):
    """Displacements of the copies against their links, `misses` (rows, 6 cuts), and how unit rates
    of the freedoms change them, `jacobian` (rows, 6 cuts, freedoms)."""

    misses: Floats
    jacobian: Floats


class Loops:
    """The closing of the cuts of an opened mechanism."""

    def __init__(self, opened: Opened, layout: Layout, poses: Poses) -> None:
        self.opened, self.layout, self.poses = opened, layout, poses
        number = {name: k for k, name in enumerate((GROUND_NAME, *poses.bodies))}
        self.number = number
        spins, slides, edges = [], [], []
        for k, edge in enumerate(opened.graph.edges):
            carrier = layout.carriers[k]
            origin = (np.array(carrier.part.before.o) - poses.centre) / poses.size
            frame = carrier.part.before._replace(o=tuple(origin.tolist()))
            for spin, slide in screws_at(carrier.part.letter, frame, edge.joint.pitch / poses.size):
                spins.append(spin)
                slides.append(slide)
                edges.append(k)
        self.count = len(edges)
        self._spins = np.array(spins, dtype=np.float64).reshape(-1, 3, 1)
        self._slides = np.array(slides, dtype=np.float64).reshape(-1, 3, 1)
        self._edges = np.array(edges, dtype=np.intp)
        parents = [number[edge.parent] for edge in opened.graph.edges]
        self._parents = np.array([parents[k] for k in edges], dtype=np.intp)
        self._copies = np.array([number[cut.copy] for cut in opened.cuts], dtype=np.intp)
        self._links = np.array([number[cut.link] for cut in opened.cuts], dtype=np.intp)

    @cached_property
    def passed(self) -> Floats:
        """Whether the way from ground to each body passes each edge (bodies, edges), 0 or 1."""
        edges = self.opened.graph.edges
        found = np.zeros((len(self.number), len(edges)))
        for k, edge in enumerate(edges):
            found[self.number[edge.child]] = found[self.number[edge.parent]]
            found[self.number[edge.child], k] = 1.0
        return found

    @cached_property
    def edge_signs(self) -> Floats:
        """How the loop of each cut passes each edge (cuts, edges): outward +1, back to ground
        -1."""
        return self.passed[self._copies] - self.passed[self._links]

    @cached_property
    def signs(self) -> Floats:
        """How the loop of each cut passes each freedom (cuts, freedoms)."""
        return self.edge_signs[:, self._edges]

    def closing(self, states: Floats) -> Closing:
        """Misses and Jacobian at states (rows, states)."""
        return self.closing_of(*self.poses.at(np.empty((0, len(states))), states.T))

    def closing_of(self, turns: Floats, places: Floats) -> Closing:
        """Misses and Jacobian at poses of all bodies."""
        one, two = self._copies, self._links
        misses = displacement(turns[:, one], places[:, one], turns[:, two], places[:, two])
        screws = np.swapaxes(self.screws(turns, places), 1, 2)
        jacobian = self.signs[:, None, :] * screws[:, None]
        rows = len(turns)
        return Closing(
            misses.reshape(rows, 6 * len(one)), jacobian.reshape(rows, 6 * len(one), self.count)
        )

    def screws(self, turns: Floats, places: Floats) -> Floats:
        """Unit screws (rows, freedoms, 6) of all freedoms where the bodies are."""
        turn, place = turns[:, self._parents], places[:, self._parents]
        spins = (turn @ self._spins)[..., 0]
        slides = (turn @ self._slides)[..., 0] + cross(place, spins)
        return np.concatenate([spins, slides], axis=2)

    def twists(self, turns: Floats, places: Floats) -> Floats:
        """Twists (rows, bodies, 6, freedoms) of all bodies for unit rates of the freedoms."""
        screws = np.swapaxes(self.screws(turns, places), 1, 2)
        return np.asarray(self.passed[:, self._edges][:, None, :] * screws[:, None])

    def moved(self, states: Floats, steps: Floats) -> Floats:
        """States (rows, states) displaced by steps (rows, freedoms)."""
        found = states.copy()
        columns, slots, units = self._scalars
        found[:, slots] += steps[:, columns] * units
        columns, slots = self._balls
        if slots.size:
            found[:, slots] = turned(found[:, slots], steps[:, columns])
        return found

    def steps(self, states: Floats, others: Floats) -> Floats:
        """The steps (rows, freedoms) that lead from `others` to `states`, both (rows, states)."""
        found = np.zeros((len(states), self.count))
        columns, slots, units = self._scalars
        found[:, columns] = (states[:, slots] - others[:, slots]) / units
        columns, slots = self._balls
        if slots.size:
            found[:, columns] = turn_between(states[:, slots], others[:, slots])
        return found

    @cached_property
    def _scalars(self) -> tuple[NDArray[np.intp], NDArray[np.intp], Floats]:
        """Columns, slots in the state and units of the freedoms that are no ball's."""
        columns, slots, units = [], [], []
        unit = self.poses.size / self.layout.length
        for carrier in self.layout.carriers:
            if carrier.part.type.is_ball:
                continue
            for k, freedom in enumerate(carrier.part.type.freedoms):
                columns.append(carrier.column + k)
                slots.append(carrier.state + k)
                units.append(unit if freedom.is_slide else 1.0)
        return np.array(columns, dtype=np.intp), np.array(slots, dtype=np.intp), np.array(units)

    @cached_property
    def _balls(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Columns (balls, 3) and slots in the state (balls, 4) of the balls."""
        balls = [c for c in self.layout.carriers if c.part.type.is_ball]
        columns = np.array([c.column for c in balls], dtype=np.intp)
        slots = np.array([c.state for c in balls], dtype=np.intp)
        return columns[:, None] + np.arange(3), slots[:, None] + np.arange(4)
