"""A double that knows the number it was rounded from.

Arithmetic on it is that of its double and gives plain doubles; only where a computation is written
down on a tape of exact numbers is the number itself taken (`tape.exact`).
"""

from __future__ import annotations

from fractions import Fraction
from math import tau


class Exact(float):
    """A double with the fraction that it stands for.

    Example:
        >>> third = Exact(1.0 / 3.0, Fraction(1, 3))
        >>> third + third == 2.0 / 3.0, third.fraction
        (True, Fraction(1, 3))
    """

    fraction: Fraction
    __slots__ = ("fraction",)

    def __new__(cls, value: float, fraction: Fraction) -> Exact:
        """The double `value` of the number `fraction`."""
        made = super().__new__(cls, value)
        made.fraction = fraction
        return made

    def __reduce__(self) -> tuple[type[Exact], tuple[float, Fraction]]:
        """Copied and pickled with its fraction."""
        return Exact, (float(self), self.fraction)

    def __neg__(self) -> Exact:
        """The opposite number, as exactly known."""
        return Exact(-float(self), -self.fraction)


PI = Fraction(3141592653589793238462643383279502884197169399375105820974945, 10**60)
"""Pi to 60 decimals."""

TURN = Exact(tau, 2 * PI)
"""A full turn in rad."""


def part(count: int) -> Exact:
    """One of `count` equal parts of 1."""
    return Exact(1.0 / count, Fraction(1, count))


def nearest(number: Fraction) -> Exact:
    """The double nearest to a number, which it knows."""
    return Exact(float(number), number)


def fraction_of(value: float) -> Fraction:
    """The number that a double stands for."""
    return value.fraction if isinstance(value, Exact) else Fraction(value)


def double_double(value: Fraction) -> tuple[float, float]:
    """A number as the nearest double and the nearest double to what is left.

    Example:
        >>> double_double(Fraction(1, 10))
        (0.1, -5.551115123125783e-18)
    """
    high = float(value)
    return high, float(value - Fraction(high))
