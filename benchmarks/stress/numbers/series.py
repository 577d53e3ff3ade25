"""Taylor series of second order in time over any numbers: value, rate and acceleration.

Numbers are double-double rows, or any others with + - * / and `sqrt`, `sin_cos`, `arctan2`, `exp`.
"""

from __future__ import annotations

from typing import Any

Number = Any
"""`DoubleDouble`, `Series`, or a test's numbers of 40 digits."""


class Series:
    """value + rate t + acceleration t^2 / 2."""

    __slots__ = ("acceleration", "rate", "value")
    __array_ufunc__ = None

    def __init__(self, value: Number, rate: Number, acceleration: Number) -> None:
        self.value = value
        self.rate = rate
        self.acceleration = acceleration

    @property
    def number(self) -> Number:
        """The value without its rates."""
        return self.value

    def __add__(self, other: Number) -> Series:
        if isinstance(other, Series):
            return Series(
                self.value + other.value,
                self.rate + other.rate,
                self.acceleration + other.acceleration,
            )
        return Series(self.value + other, self.rate, self.acceleration)

    __radd__ = __add__

    def __neg__(self) -> Series:
        return Series(-self.value, -self.rate, -self.acceleration)

    def __sub__(self, other: Number) -> Series:
        return self.__add__(-other)

    def __rsub__(self, other: Number) -> Series:
        return self.__neg__().__add__(other)

    def __mul__(self, other: Number) -> Series:
        if not isinstance(other, Series):
            return Series(self.value * other, self.rate * other, self.acceleration * other)
        bend = self.acceleration * other.value + self.value * other.acceleration
        return Series(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            bend + self.rate * other.rate * 2.0,
        )

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Series:
        if not isinstance(other, Series):
            return Series(self.value / other, self.rate / other, self.acceleration / other)
        value = self.value / other.value
        rate = (self.rate - value * other.rate) / other.value
        bend = self.acceleration - rate * other.rate * 2.0 - value * other.acceleration
        return Series(value, rate, bend / other.value)

    def __rtruediv__(self, other: Number) -> Series:
        return Series(self.value * 0.0 + other, self.value * 0.0, self.value * 0.0) / self

    def sqrt(self) -> Series:
        """The root of a positive number."""
        root = self.value.sqrt()
        rate = self.rate / root * 0.5
        return Series(root, rate, (self.acceleration * 0.5 - rate * rate) / root)

    def sin_cos(self) -> tuple[Series, Series]:
        """Sine and cosine of rad."""
        s, c = self.value.sin_cos()
        square = self.rate * self.rate
        sine = Series(s, c * self.rate, c * self.acceleration - s * square)
        return sine, Series(c, -(s * self.rate), -(s * self.acceleration) - c * square)

    def arctan2(self, x: Series) -> Series:
        """The angle of (x, self) in (-pi, pi]."""
        length = self.value * self.value + x.value * x.value
        rate = (x.value * self.rate - self.value * x.rate) / length
        bend = x.value * self.acceleration - self.value * x.acceleration
        growth = (x.value * x.rate + self.value * self.rate) * 2.0
        return Series(self.value.arctan2(x.value), rate, (bend - rate * growth) / length)
