"""The way of the inputs along the rows as the kernel follows it: rows, the places between them
where the motion turns or bends, and their course in kernel units.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.functions import total
from mechkin_cli.mechanism import CellKind, Course, Parameter
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.session.cells import Cells, Formula
from mechkin_cli.show import Floats
from mechkin_cli.tape import compiled, tape_values
from mechkin_cli.tolerances import COURSE_JUMP

if TYPE_CHECKING:
    from numpy.typing import NDArray


Piece = tuple[int, int, float, float, float, float]
"""First and last place, parameters there, scale and power (kernel/core/stepping/course.hpp)."""

LENGTH_SAMPLES = 33
"""Places from which the length of a cell's way is read: a scale only."""


class FollowedPath(NamedTuple):
    """Places in the order in which they are followed.

    Attributes:
        rows: (places,) the row, -1 between rows.
        at: (places,) the course's parameter, nan where it has none.
        values: (inputs, places) in kernel units.
        course: the kernel's, None where all is straight.
        cells: (places - 1,) the cell from each place to the next, -1 for none.
        route: that it is part of.
        pieces: of the course.
        numbers: the cell of each.
    """

    rows: NDArray[np.int64]
    at: Floats
    values: Floats
    course: _kernel.Course | None
    cells: NDArray[np.int64]
    route: Route
    pieces: Sequence[Piece] = ()
    numbers: Sequence[int] = ()

    @property
    def real(self) -> NDArray[np.int64]:
        """Places that are rows."""
        return np.flatnonzero(self.rows >= 0)

    @property
    def course_values(self) -> tuple[Any, ...]:
        """The course as its text has it (kernel/plan_text.py): tape, pieces and arrays."""
        course, numbers = self.route.course, self.numbers
        arrays = (course.constants[numbers], course.ways[numbers], self.route.units, self.at)
        lists = (array.ravel().tolist() for array in arrays)
        return (tape_values(course.tape), self.pieces, *lists)

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

    def way(self, row: int, step: int = 1, last: int | None = None) -> FollowedPath:
        """From a row on, or with step -1 back from it, to the last row or to the end."""
        course = self.course
        first = int(np.flatnonzero(course.rows == row)[0])
        end = course.rows.size - 1 if step > 0 else 0
        if last is not None:
            end = int(np.flatnonzero(course.rows == last)[0])
        if step > 0:
            chosen, cells = slice(first, end + 1), course.cells[first:end]
        else:
            chosen = slice(first, end - 1 if end else None, -1)
            cells = course.cells[end:first][::-1]
        return self._way(course.rows[chosen], course.at[chosen], self.values[:, chosen], cells)

    def _way(
        self, rows: NDArray[np.int64], at: Floats, values: Floats, cells: NDArray[np.int64]
    ) -> FollowedPath:
        pieces, numbers = self._pieces(at, cells)
        course = self.course
        native = None
        if pieces:
            arrays = (course.constants[numbers], course.ways[numbers], self.units, at)
            native = _kernel.Course(self._tape, pieces, *map(np.ascontiguousarray, arrays))
        values = np.ascontiguousarray(values)
        return FollowedPath(rows, at, values, native, cells, self, pieces, numbers)

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
            length = total(np.max(changes, axis=1, initial=0.0).tolist())
            found.append(length if 0.0 < length < np.inf else 1.0)
        return found

    def jets(self, cell: int, at: Floats) -> Floats:
        """Inputs and two derivatives by the parameter (places, inputs, 3) in kernel units."""
        constants = self.course.constants[cell]
        given = np.concatenate([at[None], np.repeat(constants[:, None], at.size, axis=1)])
        found = self._tape.jets(np.ascontiguousarray(given), self.course.ways[cell])
        return found / self.units[:, None]


# The places of a course: its rows, and between them the ends of cells that the motion passes.


def places_of(
    formula: Formula,
    cells: Cells,
    parameter: Parameter,
    at: Floats,
    values: Floats,
) -> Course:
    """Rows at the parameters `at` (rows,), where the inputs are `values` (inputs, rows) in SI, with
    the ends of cells between them."""
    ends = _Ends(formula, cells)
    between = ends.cells_between(at[:-1], at[1:])
    # rows as they are, up to a step that passes ends of cells, which come between
    rows, places, columns, passed = [], [], [], []
    begin = 0
    for step in ends.steps_that_pass(at):
        here, there = float(at[step]), float(at[step + 1])
        own = ends.places(here, there)
        rows += [np.arange(begin, step + 1), np.full(len(own), -1)]
        places += [at[begin : step + 1], np.array([place for place, _, _ in own])]
        columns += [values[:, begin : step + 1], *(column[:, None] for _, column, _ in own)]
        onto = ends.cell(own[-1][0], there)
        passed += [between[begin:step], np.array([*(cell for _, _, cell in own), onto])]
        begin = step + 1
    rows.append(np.arange(begin, at.size))
    places.append(at[begin:])
    columns.append(values[:, begin:])
    passed.append(between[begin:])
    return Course(
        parameter,
        formula.tape,
        cells.edges,
        cells.kinds,
        cells.constants,
        cells.ways,
        cells.powers,
        np.concatenate(rows),
        np.concatenate(places),
        np.concatenate(columns, axis=1),
        np.concatenate(passed),
    )


def places_at(course: Course, at: Floats, values: Floats) -> Course:
    """A course of which the rows are at other rising parameters `at` (rows,), within those of its
    rising rows, where the inputs are `values` (inputs, rows) in SI."""
    between = course.rows < 0
    order = np.argsort(np.concatenate([course.at[between], at]), kind="stable")
    ends = np.count_nonzero(between)
    places = np.concatenate([course.at[between], at])[order]
    columns = np.concatenate([course.values[:, between], values], axis=1)[:, order]
    first, last = np.flatnonzero(order >= ends)[[0, -1]]
    kept = slice(int(first), int(last) + 1)
    rows = np.where(order >= ends, order - ends, -1)[kept]
    cells = np.searchsorted(course.edges, 0.5 * (places[:-1] + places[1:])) - 1
    cells = np.clip(cells, 0, course.edges.size - 2)
    cells[places[:-1] == places[1:]] = -1
    return replace(
        course,
        rows=rows,
        at=places[kept],
        values=columns[:, kept],
        cells=cells[int(first) : int(last)],
    )


class _Ends:
    """What the motion meets at the edges of cells."""

    def __init__(self, formula: Formula, cells: Cells) -> None:
        self.formula, self.cells = formula, cells
        self._jumps: dict[int, bool] = {}

    def steps_that_pass(self, at: Floats) -> list[int]:
        """The numbers of the rows behind which edges lie strictly between a row and the next."""
        low, high = np.minimum(at[:-1], at[1:]), np.maximum(at[:-1], at[1:])
        edges = self.cells.edges
        steps: list[int] = np.flatnonzero(
            edges.searchsorted(high) > edges.searchsorted(low, side="right")
        ).tolist()
        return steps

    def places(self, here: float, there: float) -> list[tuple[float, Floats, int]]:
        """The places at the edges between two parameters in the order in which they are passed,
        with the inputs there and the cell in front; twice where the inputs jump, with -1."""
        found = []
        for edge in self.passed(here, there):
            before, behind = self.sides(edge, there > here)
            place = float(self.cells.edges[edge])
            found.append((place, self.value(before, place), before))
            if self.jumps(edge):
                found.append((place, self.value(behind, place), -1))
        return found

    def cells_between(self, here: Floats, there: Floats) -> NDArray[np.int64]:
        """The cell in which each row and the next lie (steps,), as `cell`."""
        edges = self.cells.edges
        cells = np.clip(edges.searchsorted(0.5 * (here + there)) - 1, 0, edges.size - 2)
        return np.where(here == there, -1, cells)

    def passed(self, here: float, there: float) -> list[int]:
        """Edges strictly between two parameters, in the order in which they are passed."""
        edges = self.cells.edges
        low, high = min(here, there), max(here, there)
        found = list(range(edges.searchsorted(low, side="right"), edges.searchsorted(high)))
        return found if there > here else found[::-1]

    def sides(self, edge: int, rising: bool) -> tuple[int, int]:
        """The cells before and behind an edge."""
        return (edge - 1, edge) if rising else (edge, edge - 1)

    def cell(self, here: float, there: float) -> int:
        """The cell in which two neighbouring places lie, -1 for one place."""
        if here == there:
            return -1
        edges = self.cells.edges
        number = int(edges.searchsorted(0.5 * (here + there))) - 1
        return min(max(number, 0), edges.size - 2)

    def value(self, cell: int, place: float) -> Floats:
        """The inputs at a place as the formula on a cell has them."""
        constants = self.cells.constants[cell].tolist()
        jets = self.formula.jets(np.array([place]), constants, self.cells.ways[cell])
        return jets[0, :, 0]

    def jumps(self, edge: int) -> bool:
        """Whether the inputs are not continuous at an edge."""
        if edge not in self._jumps:
            place = float(self.cells.edges[edge])
            one, other = self.value(edge - 1, place), self.value(edge, place)
            scale = COURSE_JUMP * (1.0 + np.abs(one))
            self._jumps[edge] = not bool((np.abs(other - one) <= scale).all())
        return self._jumps[edge]


# Inputs that follow one that moves: all of them as a function of it, for any of its values.
