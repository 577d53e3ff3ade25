"""Numbers with two derivatives by one parameter: f + f' t + f'' t^2/2, truncated.

Entries are anything that adds and multiplies, arrays over the rows for the most part. A formula
that is evaluated on jets gives its derivatives along a direction without a formula of their own.
"""

from __future__ import annotations

from typing import Any


class Jet:
    """A value with its first and second derivative."""

    __array_ufunc__ = None
    """Arrays leave their operators to the jet."""

    def __init__(self, value: Any, first: Any = 0.0, second: Any = 0.0) -> None:
        self.value, self.first, self.second = value, first, second

    def __add__(self, other: Any) -> Jet:
        o = jet(other)
        return Jet(self.value + o.value, self.first + o.first, self.second + o.second)

    def __neg__(self) -> Jet:
        return Jet(-self.value, -self.first, -self.second)

    def __sub__(self, other: Any) -> Jet:
        return self + -jet(other)

    def __rsub__(self, other: Any) -> Jet:
        return jet(other) - self

    def __mul__(self, other: Any) -> Jet:
        if not isinstance(other, Jet):
            return Jet(self.value * other, self.first * other, self.second * other)
        crossed = self.first * other.first
        return Jet(
            self.value * other.value,
            self.first * other.value + self.value * other.first,
            self.second * other.value + crossed + crossed + self.value * other.second,
        )

    __radd__ = __add__
    __rmul__ = __mul__

    def outer(self, value: Any, slope: Any, bend: Any) -> Jet:
        """f(self), with f, f' and f'' at its value."""
        return Jet(value, slope * self.first, slope * self.second + bend * self.first * self.first)


def jet(value: Any) -> Jet:
    """A number as a jet, a constant if it is none."""
    return value if isinstance(value, Jet) else Jet(value)
