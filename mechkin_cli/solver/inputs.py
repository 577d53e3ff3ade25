"""The inputs of a motion as the kernel takes them, and its numbers in words for messages.

Slides are in the kernel's length unit; a helical joint is driven by its angle. An angle that may
turn for ever is its part within half a turn and its whole turns; their sum is for ways and
messages, and rounds by its size.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism.joint_table import dimension_of
from mechkin_cli.solver.whole_turns import without_turns
from mechkin_cli.units import ANGLE
from mechkin_cli.units.table import PI

if TYPE_CHECKING:
    from fractions import Fraction

    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.motion import DrivenInput
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.solver.layout import Layout
    from mechkin_cli.solver.session import Session
    from mechkin_cli.units.compound import CompoundUnit


class KernelInputs(NamedTuple):
    """Values and their derivatives over time (inputs, rows) in kernel units.

    `reduced` are the values without the `whole` turns of angles, which threads keep.
    """

    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    reduced: Floats
    whole: Floats

    @classmethod
    def of(
        cls, problem: Problem, values: Floats, rates: Floats, accelerations: Floats, jerks: Floats
    ) -> KernelInputs:
        """Of a problem's inputs in kernel units."""
        return cls(values, rates, accelerations, jerks, *_reduced(problem, values))

    @property
    def orders(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Values, rates, accelerations and jerks."""
        return (self.values, self.rates, self.accelerations, self.jerks)

    def at_unit_rate(self, number: int) -> KernelInputs:
        """The same places, where input `number` moves at unit rate and all others are held."""
        rates = np.zeros_like(self.rates)
        rates[number] = 1.0
        still = np.zeros_like(rates)
        return self._replace(rates=rates, accelerations=still, jerks=still)

    def at_unit_acceleration(self, number: int) -> KernelInputs:
        """The same places at rest, where input `number` has unit acceleration and no other has."""
        accelerations, still = np.zeros_like(self.rates), np.zeros_like(self.rates)
        accelerations[number] = 1.0
        return self._replace(rates=still, accelerations=accelerations, jerks=still)

    def at_rest(self) -> KernelInputs:
        """The same places at rest."""
        still = np.zeros_like(self.rates)
        return self._replace(rates=still, accelerations=still, jerks=still)

    def without_accelerations(self) -> KernelInputs:
        """The same places and rates, with no acceleration."""
        still = np.zeros_like(self.rates)
        return self._replace(accelerations=still, jerks=still)

    def part(self, rows: slice | Floats) -> KernelInputs:
        """Some of the rows."""
        return KernelInputs(*(np.ascontiguousarray(array[:, rows]) for array in self))


def kernel_inputs(problem: Problem, layout: Layout) -> KernelInputs:
    """The inputs of all rows, then the coordinates that hold idle freedoms, at rest."""
    inputs, rows = problem.motion.inputs, problem.motion.rows
    units = [input_unit(layout, item) for item in inputs]
    held = held_values(problem, layout)

    def table(name: str, at: list[float]) -> Floats:
        moving = [getattr(i, name) / unit for i, unit in zip(inputs, units, strict=True)]
        still = [np.full(rows, value) for value in at]
        return np.array([*moving, *still]) if moving or still else np.empty((0, rows))

    rest = [0.0] * len(held)
    rates, accelerations, jerks = (
        table(name, rest) for name in ("rates", "accelerations", "jerks")
    )
    return KernelInputs.of(problem, table("values", held), rates, accelerations, jerks)


def held_values(problem: Problem, layout: Layout) -> list[float]:
    """The held coordinates in kernel units."""
    joints = layout.mechanism.joints
    return [
        value / joints[name].unit_of(coordinate, layout.length)
        for (name, coordinate), value in problem.held_at.items()
    ]


def turn_of(problem: Problem, item: DrivenInput) -> Fraction | None:
    """A full turn of an input in the file's unit; None where a turn is not the same place."""
    kind = problem.mechanism.joints[item.joint].type
    if not kind.chain[kind.freedom_of[item.coordinate]].is_cyclic:
        return None
    return _turn(problem.units.angle)


@cache
def _turn(unit: CompoundUnit) -> Fraction:
    return 2 * PI / unit.factor


def input_rest(session: Session, name: str) -> Floats | None:
    """An input (rows,) without its whole turns in rad, None if it has none."""
    for number, item in enumerate(session.problem.motion.inputs):
        if name == item.name and session.inputs.whole[number].any():
            rest: Floats = session.inputs.reduced[number]
            return rest
    return None


def _reduced(problem: Problem, values: Floats) -> tuple[Floats, Floats]:
    """The values without whole turns, and these; recorded numbers as they are."""
    whole = np.zeros(values.shape)
    reduced = values
    for number, item in enumerate(problem.motion.inputs):
        turn = turn_of(problem, item)
        if turn is None or item.written.dtype != np.float64:
            continue
        rest, turns = without_turns(item.written, turn)
        if turns.any():
            reduced = values.copy() if reduced is values else reduced
            reduced[number] = problem.units.to_si(rest, ANGLE)
            whole[number] = turns
    return reduced, whole


def input_unit(layout: Layout, item: DrivenInput) -> float:
    """The SI value of one kernel unit of an input."""
    return layout.mechanism.joints[item.joint].unit_of(item.coordinate, layout.length)


def input_number(problem: Problem, layout: Layout, number: int, value: float) -> Number:
    """A value of input `number` in kernel units as a number in the file's units."""
    item = problem.motion.inputs[number]
    dimension = dimension_of(item.coordinate)
    in_file = float(problem.units.from_si(value * input_unit(layout, item), dimension))
    return Number(item.name, in_file, problem.units.label(dimension))


def input_numbers(problem: Problem, layout: Layout, values: Floats) -> tuple[Number, ...]:
    """Values of all inputs in kernel units, shape (inputs,), as numbers in the file's units; what
    is held is no input of the file."""
    count = len(problem.motion.inputs)
    return tuple(input_number(problem, layout, k, float(v)) for k, v in enumerate(values[:count]))


def input_text(number: Number) -> str:
    """An input's value as messages show it.

    >>> input_text(Number("O1.theta", 205.1376, "deg"))
    'O1.theta = 205.1376 deg'
    """
    return f"{number.name} = {number.value:.12g} {number.unit}"
