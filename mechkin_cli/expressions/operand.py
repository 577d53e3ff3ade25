"""What operations work on: operands with their origin, and the site that knows how to complain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.limits import MAX_QUOTED
from mechkin_cli.expressions.nodes import Number
from mechkin_cli.expressions.quantity import Quantity, Scalar, Value, Vector
from mechkin_cli.units import ANGLE, Dimension, UnitSystem

Resolve = Callable[[str], Quantity]
"""A quantity by its dotted name; raises `UnknownName` for a name that it does not have."""


@dataclass(frozen=True, slots=True, eq=False)
class Operand:
    """A value with the place of its text, and the number literal it comes from if it is one."""

    quantity: Quantity
    offset: int
    number: Number | None = None

    @property
    def value(self) -> Value:
        """The value in SI."""
        return self.quantity.value

    @property
    def dimension(self) -> Dimension:
        """The dimension of the value."""
        return self.quantity.dimension

    @property
    def phrase(self) -> str:
        """What the operand is, in words."""
        return self.quantity.phrase


class Site(NamedTuple):
    """An operation in its text: its name, where it stands, and the units of its hints."""

    symbol: str
    offset: int
    units: UnitSystem

    def error(
        self, message: str, hint: str | None = None, at: Operand | None = None
    ) -> ExpressionError:
        """An error at an operand, or at the operation itself."""
        return ExpressionError(message, at.offset if at else self.offset, hint)

    def scalar(self, operand: Operand) -> Scalar:
        """The value of an operand that must not be a vector.

        Raises:
            ExpressionError: it is a vector.
        """
        if isinstance(operand.value, Vector):
            raise self.error(
                f"{self.symbol} takes a number, not {operand.phrase}",
                "take a component with .x, .y or .z, or norm(...)",
                operand,
            )
        return operand.value

    def periodic(self, operand: Operand) -> Scalar:
        """The value of an operand of which whole turns do not matter.

        Raises:
            ExpressionError: it is a vector.
        """
        value = self.scalar(operand)
        return value if operand.quantity.rest is None else operand.quantity.rest

    def vector(self, operand: Operand) -> Vector:
        """The value of an operand that must be a vector.

        Raises:
            ExpressionError: it is a scalar.
        """
        if not isinstance(operand.value, Vector):
            raise self.error(
                f"{self.symbol} takes a vector, not {operand.phrase}",
                "write a vector as [x, y, z]",
                operand,
            )
        return operand.value

    def require(self, operand: Operand, dimension: Dimension) -> None:
        """Check the dimension of an operand.

        Raises:
            ExpressionError: it has another one.
        """
        if not operand.dimension.compatible(dimension):
            raise self.error(
                f"{self.symbol} takes {dimension.phrase}, not {operand.phrase}",
                self.unit_hint(operand, dimension),
                operand,
            )

    def unit_hint(self, operand: Operand, dimension: Dimension) -> str:
        """How to give an operand a wanted dimension."""
        label = self.units.label(dimension)
        number = operand.number
        bare = number is not None and number.unit is None and number.text != "pi"
        if number is not None and bare and label and len(number.text) <= MAX_QUOTED:
            return f"write the number with a unit: {number.text} {label}"
        if operand.dimension.dimensionless:
            return _multiply_hint(dimension, label)
        if (operand.dimension / ANGLE).compatible(dimension):
            return f"it is per angle: write its unit as {label}"
        if dimension.dimensionless:
            return f"divide it by 1 {self.units.label(operand.dimension)}"
        return f"give a value such as 1 {label}"


def _multiply_hint(dimension: Dimension, label: str) -> str:
    if dimension == ANGLE:
        return "multiply it by 1 deg if it is in degrees, by 1 rad if it is in radians"
    return f"multiply it by 1 {label}"
