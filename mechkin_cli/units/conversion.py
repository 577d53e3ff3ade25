"""Conversion of values by an exact factor, with as few roundings as double arithmetic allows.

A factor is a `Fraction`. If it is a double (12 in a foot) values are multiplied by it; if its
inverse is one (1000 mm in a metre) they are divided by that; a factor of one leaves values
untouched. Only in the other cases is the factor itself rounded; it knows then from what.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.exact import Exact
from mechkin_cli.tolerances import LARGEST_CONVERSION
from mechkin_cli.units.errors import UnitError

Number = TypeVar("Number", float, NDArray[np.float64])


class Conversion(NamedTuple):
    """Values times `multiplier` over `divisor`, of which at least one is exactly 1."""

    multiplier: float
    divisor: float

    def apply(self, value: Number) -> Number:
        """The value in the target unit."""
        if self.divisor != 1.0:
            return value / self.divisor
        return value * self.multiplier if self.multiplier != 1.0 else value

    def reverse(self, value: Number) -> Number:
        """The value in the source unit."""
        if self.divisor != 1.0:
            return value * self.divisor
        return value / self.multiplier if self.multiplier != 1.0 else value


def conversion(factor: Fraction) -> Conversion:
    """The conversion by a positive factor.

    Raises:
        UnitError: the factor is outside the range of double numbers.
    """
    multiplier = _double(factor)
    if factor != multiplier:
        divisor = _double(1 / factor)
        if factor * Fraction(divisor) == 1:
            return Conversion(1.0, divisor)
        multiplier = Exact(multiplier, factor)
    return Conversion(multiplier, 1.0)


def _double(factor: Fraction) -> float:
    """The nearest double."""
    try:
        value = float(factor)
    except OverflowError:
        value = 0.0
    if not 1.0 / LARGEST_CONVERSION <= value <= LARGEST_CONVERSION:
        raise UnitError("the conversion factor of this unit is outside the range of numbers")
    return value
