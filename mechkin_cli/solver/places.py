"""The places of a course: its rows, and between them the ends of cells that the motion passes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.mechanism.course import Course, Parameter
from mechkin_cli.solver.cells import Cells, Formula
from mechkin_cli.tolerances import COURSE_JUMP


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
    rows: list[int] = [0]
    places: list[float] = [float(at[0])]
    columns: list[Floats] = [values[:, 0]]
    between: list[int] = []

    def put(row: int, place: float, column: Floats, cell: int) -> None:
        rows.append(row)
        places.append(place)
        columns.append(column)
        between.append(cell)

    for row in range(1, at.size):
        here, there = float(at[row - 1]), float(at[row])
        for edge in ends.passed(here, there):
            before, behind = ends.sides(edge, there > here)
            place = float(cells.edges[edge])
            put(-1, place, ends.value(before, place), before)
            if ends.jumps(edge):
                put(-1, place, ends.value(behind, place), -1)
        put(row, there, values[:, row], ends.cell(float(places[-1]), there))
    return Course(
        parameter,
        formula.tape,
        cells.edges,
        cells.kinds,
        cells.constants,
        cells.ways,
        cells.powers,
        np.array(rows),
        np.array(places),
        np.stack(columns, axis=1),
        np.array(between),
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
