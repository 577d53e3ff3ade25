"""Columns of a table in double-double numbers: what their cells should be.

A column is evaluated as its cells are, with every number of its text taken exactly, and converted
by the exact factor of its unit.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.expressions import Quantity
from mechkin_cli.tape.double_doubles import DoubleDoubles, exactly

if TYPE_CHECKING:
    from mechkin_cli.expressions import Expression
    from mechkin_cli.expressions.nodes import Number
    from mechkin_cli.units import Dimension, UnitSystem


class TrueSource(Protocol):
    """The rows of a run in double-double (`analysis.errors.Repeated`)."""

    @property
    def rows(self) -> int:
        """Number of rows."""
        ...

    @property
    def units(self) -> UnitSystem:
        """Units of the mechanism file."""
        ...

    @property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """What the rows were given, in the file's units."""
        ...

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by its dotted name, in SI."""
        ...


def true_values(expression: Expression, source: TrueSource) -> list[DoubleDoubles]:
    """The true values of an expression in file units, (rows,) each: one, of a vector three."""
    given = source.written.get(expression.text.strip())
    if given is not None:
        return [given]
    found = expression.evaluate(source.quantity, source.units, _exact_literal)
    value: Any = found.value
    parts = [value.x, value.y, value.z] if hasattr(value, "components") else [value]
    return [_in_file_units(part, found.dimension, source) for part in parts]


def _in_file_units(value: Any, dimension: Dimension, source: TrueSource) -> DoubleDoubles:
    factor = source.units.unit(dimension).factor
    rows = exactly(value) + np.zeros(source.rows)
    return rows if factor == 1 else rows / DoubleDoubles.of_fraction(factor)


def _exact_literal(number: Number) -> Quantity:
    """The number as written: a double where it is one, else double-double."""
    if number.unit is None and number.text == "pi":
        from mechkin_cli.units.table import PI

        return Quantity(DoubleDoubles.of_fraction(PI))  # type: ignore[arg-type]
    exact = Fraction(number.text)
    if number.unit is None:
        if exact == Fraction(number.value):
            return Quantity(number.value)
        return Quantity(DoubleDoubles.of_fraction(exact))  # type: ignore[arg-type]
    value: Any = DoubleDoubles.of_fraction(exact * number.unit.factor)
    return Quantity(value, number.unit.dimension)
