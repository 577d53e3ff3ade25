"""Numbers of an expression as its text says them, in double-double."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mechkin_cli.expressions import Quantity
from mechkin_cli.tape.double_doubles import DoubleDoubles
from mechkin_cli.units.table import PI

if TYPE_CHECKING:
    from mechkin_cli.expressions.nodes import Number


def exact_literal(number: Number) -> Quantity:
    """The number as written, so that a function of it has all its digits, too."""
    if number.unit is None and number.text == "pi":
        return Quantity(DoubleDoubles.of_fraction(PI))  # type: ignore[arg-type]
    exact = Fraction(number.text)
    if number.unit is None:
        return Quantity(DoubleDoubles.of_fraction(exact))  # type: ignore[arg-type]
    value: Any = DoubleDoubles.of_fraction(exact * number.unit.factor)
    return Quantity(value, number.unit.dimension)
