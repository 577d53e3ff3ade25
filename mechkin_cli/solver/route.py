"""The way of the inputs along the rows as the kernel follows it: rows, the places between them
where the motion turns or bends, and their course in kernel units."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism.course import CellKind, Course
from mechkin_cli.tape.native import compiled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats

Piece = tuple[int, int, float, float, float, float]
"""First and last place, parameters there, scale and power (kernel/src/course.hpp)."""

LENGTH_SAMPLES = 33
"""Places from which the length of a cell's way is read: a scale only."""


class Way(NamedTuple):
    """Places in the order in which they are followed.

    Attributes:
        rows: (places,) the row, -1 between rows.
        at: (places,) the course's parameter, nan where it has none.
        values: (inputs, places) in kernel units.
        course: the kernel's, None where all is straight.
        cells: (places - 1,) the cell from each place to the next, -1 for none.
        route: that it is part of.
    """

    rows: NDArray[np.int64]
    at: Floats
    values: Floats
    course: _kernel.Course | None
    cells: NDArray[np.int64]
    route: Route

    @property
    def real(self) -> NDArray[np.int64]:
        """Places that are rows."""
        return np.flatnonzero(self.rows >= 0)

    def parameter_of(self, place: int, inputs: Floats) -> float:
        """The course's parameter between a place and the next, where the inputs are as given."""
        cell = int(self.cells[place]) if place < self.cells.size else -1
        if cell < 0:
            return float(self.at[place])
        low, high = float(self.at[place]), float(self.at[place + 1])
        for _ in range(16):
            at = low + (high - low) * np.linspace(0.0, 1.0, 33)
            miss = np.max(
                np.abs(self.route.jets(cell, at)[:, :, 0] - inputs[: self.route.units.size]), axis=1
            )
            best = int(np.argmin(miss))
            low, high = float(at[max(best - 1, 0)]), float(at[min(best + 1, 32)])
        return 0.5 * (low + high)


class Route:
    """All ways along the rows of a motion.

    Args:
        course: of the inputs.
        values: (inputs, rows) in kernel units; inputs beyond those of the course are held.
        units: (inputs of the course,) SI values of the kernel's units.
    """

    def __init__(self, course: Course, values: Floats, units: Floats) -> None:
        self.course, self.units = course, units
        held = np.repeat(values[units.size :, :1], course.rows.size, axis=1)
        self.values = np.concatenate([course.values / units[:, None], held])
        real = course.rows >= 0
        self.values[:, real] = values[:, course.rows[real]]

    def way(self, row: int, step: int = 1) -> Way:
        """From a row on, or with step -1 back from it."""
        course = self.course
        first = int(np.flatnonzero(course.rows == row)[0])
        if step > 0:
            chosen, cells = slice(first, None), course.cells[first:]
        else:
            chosen = slice(first, None, -1)
            cells = course.cells[:first][::-1]
        return self._way(course.rows[chosen], course.at[chosen], self.values[:, chosen], cells)

    def _way(
        self, rows: NDArray[np.int64], at: Floats, values: Floats, cells: NDArray[np.int64]
    ) -> Way:
        pieces, numbers = self._pieces(at, cells)
        course = self.course
        native = None
        if pieces:
            native = _kernel.Course(
                self._tape,
                pieces,
                np.ascontiguousarray(course.constants[numbers]),
                np.ascontiguousarray(course.ways[numbers]),
                self.units,
                np.ascontiguousarray(at),
            )
        return Way(rows, at, np.ascontiguousarray(values), native, cells, self)

    def _pieces(self, at: Floats, cells: NDArray[np.int64]) -> tuple[list[Piece], list[int]]:
        """Runs of places on one curved cell that are passed in one direction."""
        rising = at[1:] > at[:-1]
        curved = (cells >= 0) & (self.course.kinds[cells] == CellKind.CURVED)
        same = (cells[1:] == cells[:-1]) & (rising[1:] == rising[:-1])
        bounds = [0, *(np.flatnonzero(~same) + 1).tolist(), cells.size]
        pieces, numbers = [], []
        for first, last in pairwise(bounds):
            if last > first and curved[first]:
                cell = int(cells[first])
                pieces.append((first, last, *self._shape(cell, bool(rising[first]))))
                numbers.append(cell)
        return pieces, numbers

    def _shape(self, cell: int, rising: bool) -> tuple[float, float, float, float]:
        """Parameters at both ends, scale and power of a cell."""
        order = 1 if rising else -1
        ends = self.course.edges[cell : cell + 2][::order].tolist()
        here, there = self.course.powers[cell][::order].tolist()
        power = float(here) if here > 1 else -float(there) if there > 1 else 1.0
        return ends[0], ends[1], self._lengths[cell], power

    @cached_property
    def _tape(self) -> _kernel.Tape:
        return compiled(self.course.tape)

    @cached_property
    def _lengths(self) -> list[float]:
        """Of each cell: the sum of the largest change of an input from place to place."""
        edges = self.course.edges
        found = []
        for cell in range(edges.size - 1):
            at = edges[cell] + (edges[cell + 1] - edges[cell]) * np.linspace(0, 1, LENGTH_SAMPLES)
            changes = np.abs(np.diff(self.jets(cell, at)[:, :, 0], axis=0))
            length = sum(np.max(changes, axis=1, initial=0.0).tolist())
            found.append(length if 0.0 < length < np.inf else 1.0)
        return found

    def jets(self, cell: int, at: Floats) -> Floats:
        """Inputs and two derivatives by the parameter (places, inputs, 3) in kernel units."""
        constants = self.course.constants[cell]
        given = np.concatenate([at[None], np.repeat(constants[:, None], at.size, axis=1)])
        found = self._tape.jets(np.ascontiguousarray(given), self.course.ways[cell])
        return found / self.units[:, None]
