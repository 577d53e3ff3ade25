"""The rows of a sweep while it runs: inputs in kernel units, guesses, what is known of each row."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, Number
from mechkin_cli.mechanism.joint_table import dimension_of
from mechkin_cli.mechanism.problem import Problem
from mechkin_cli.solver.layout import Layout
from mechkin_cli.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats

MAY_BE_RIGID = (
    "an overconstrained loop moves only if its dimensions are exact (write expressions); else "
    "this is a branch point or a special position"
)


@dataclass
class RowStates:
    """Guesses for the rows and what is known about those that have none; `numbers` counts them
    from 0 as the file does."""

    guess: Floats
    limit: Floats
    reached: NDArray[np.bool_]
    status: NDArray[np.int8]
    nodes: int
    diagnostics: list[Diagnostic]
    numbers: NDArray[np.int64]

    @classmethod
    def without_guesses(cls, states: int, rows: int) -> RowStates:
        """Rows of which nothing is known yet; none is reached."""
        return cls(
            guess=np.zeros((states, rows)),
            limit=np.zeros(rows),
            reached=np.zeros(rows, dtype=bool),
            status=np.full(rows, int(Status.ok), dtype=np.int8),
            nodes=0,
            diagnostics=[],
            numbers=np.arange(rows),
        )

    def part(self, rows: slice) -> RowStates:
        """Some of the rows, in the slice's order: views of the same arrays."""
        arrays = (self.guess[:, rows], self.limit[rows], self.reached[rows], self.status[rows])
        return RowStates(*arrays, self.nodes, self.diagnostics, self.numbers[rows])


class KernelInputs(NamedTuple):
    """Values and their derivatives (inputs, rows) in kernel units."""

    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats


def kernel_inputs(problem: Problem, layout: Layout) -> KernelInputs:
    """Inputs as the kernel takes them: slides in length units, a helical joint by its angle."""
    inputs, rows = problem.motion.inputs, problem.motion.rows

    def table(name: str) -> Floats:
        columns = []
        for item in inputs:
            unit = problem.mechanism.joints[item.joint].unit_of(item.coordinate, layout.length)
            columns.append(getattr(item, name) / unit)
        return np.ascontiguousarray(np.stack(columns)) if columns else np.empty((0, rows))

    return KernelInputs(table("values"), table("rates"), table("accelerations"), table("jerks"))


def input_number(problem: Problem, layout: Layout, number: int, value: float) -> Number:
    """A value of input `number` in kernel units as a number in the file's units."""
    item = problem.motion.inputs[number]
    dimension = dimension_of(item.coordinate)
    si = value * problem.mechanism.joints[item.joint].unit_of(item.coordinate, layout.length)
    in_file = float(problem.units.from_si(si, dimension))
    return Number(item.name, in_file, problem.units.label(dimension))


def input_numbers(problem: Problem, layout: Layout, values: Floats) -> tuple[Number, ...]:
    """Values of all inputs in kernel units, shape (inputs,), as numbers in the file's units."""
    return tuple(input_number(problem, layout, k, float(v)) for k, v in enumerate(values))


def input_text(number: Number) -> str:
    """An input's value as messages show it.

    >>> input_text(Number("O1.theta", 205.1376, "deg"))
    'O1.theta = 205.1376 deg'
    """
    return f"{number.name} = {number.value:.12g} {number.unit}"
