"""The datum of a drawing: the place from which the lengths of a mechanism are measured.

Where a mechanism is drawn in the ground's axes is no property of it, but a double that holds a
place far from their origin holds few digits of what lies around it. A drawing that is far away is
therefore measured from a datum near it: the difference of the place as written and the datum is
taken exactly, and then rounded to a double. Places that are told are those of the ground's axes
again, rounded once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from math import pi
from typing import Any

from mechkin_cli import tolerances
from mechkin_cli.exact import PI
from mechkin_cli.expressions import (
    Quantity,
    constant,
    evaluate_parameters,
    lookup,
    numbers_read_by,
)
from mechkin_cli.mechanism import ZERO, Mechanism, Vector, add, norm, scale
from mechkin_cli.tape import (
    ExactRecorder,
    NotEnclosed,
    Recorded,
    Traced,
    TraceLost,
    as_recorded,
    double_doubles,
)
from mechkin_cli.units import LENGTH, UnitSystem


def datum_of(mechanism: Mechanism) -> Vector:
    """The datum (m) of a mechanism that is drawn about the ground origin: the middle of its joint
    points where these are far from there, else the ground origin."""
    points = [at.vector for _, at in mechanism.joint_points()]
    total = ZERO
    for point in points:
        total = add(total, point)
    centre = scale(1.0 / len(points), total) if points else ZERO
    near = tolerances.FAR_DRAWING * mechanism.box_diagonal()
    return centre if norm(centre) > near else ZERO


@contextmanager
def exact_numbers(recorder: ExactRecorder) -> Iterator[None]:
    """Numbers that are read in this context are exactly those of their digits."""

    def read(digits: str) -> Traced:
        if digits == "pi":
            return recorder.written(pi, PI)
        return recorder.written(float(digits), Fraction(Decimal(digits)))

    with numbers_read_by(read):
        yield


class Datum:
    """Measures places from a datum.

    Args:
        at: the datum in the ground's axes, m.
        texts: the file's parameters as written.
        given: values of parameters that replace their texts.
        units: the file's units.
    """

    def __init__(
        self,
        at: Vector,
        texts: Mapping[str, str],
        given: Mapping[str, Quantity],
        units: UnitSystem,
    ) -> None:
        self.at, self._units = at, units
        self._recorder = ExactRecorder()
        lifted = {name: self._lifted(quantity) for name, quantity in given.items()}
        with exact_numbers(self._recorder):
            self._parameters = evaluate_parameters(texts, units, [], lifted)

    def _lifted(self, quantity: Quantity) -> Quantity:
        value: Any = as_recorded(quantity.value)  # type: ignore[arg-type]
        exact: Any = self._recorder.written(float(value), Fraction(value))
        return Quantity(exact, quantity.dimension)

    def measured(self, axis: int, text: str, value: float) -> float:
        """A component of a place from the datum, in m.

        Args:
            axis: the number of the component.
            text: that of the component, which has no error.
            value: what it says in the ground's axes, m; a recorded one gives a recorded one.
        """
        if isinstance(value, Recorded):
            return self._from_datum(axis, value)
        try:
            with exact_numbers(self._recorder):
                exact = constant(text, LENGTH, self._units, lookup(self._parameters))
        except TraceLost:  # of a number that no tape holds its double is all there is
            exact = value
        return as_recorded(self._from_datum(axis, exact))

    def _from_datum(self, axis: int, value: Any) -> float:
        difference = value - self.at[axis]
        if not (isinstance(difference, Traced) and isinstance(difference.recorder, ExactRecorder)):
            return difference  # type: ignore[no-any-return]
        recorder, number = difference.recorder, difference.register
        try:
            rounded = float(double_doubles(recorder.exact_tape([number]))[0, 0])
        except NotEnclosed:
            return difference  # type: ignore[return-value]
        double = recorder.constant(rounded)
        return recorder.number(recorder.with_double(number, double))  # type: ignore[return-value]
