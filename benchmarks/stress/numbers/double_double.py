"""Rows of numbers of about 31 digits: unevaluated sums of two doubles (Dekker 1971; Knuth, 4.2.2).

Sums are the accurate ones, bounded by 2^-104 of the result also where signs differ and operands
cancel. Functions err by some 1e-30 of their largest value.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.float64]
SPLITTER = 2.0**27 + 1.0
"""Veltkamp: cuts 53 bits into 26 and 26."""
PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899")
HALVINGS = 3
"""Of an angle below pi/4 before its series: ten terms are then 1e-34 of the first."""
TERMS = 11
EXPONENT_HALVINGS = 9
EXPONENT_TERMS = 10


def two_sum(a: Rows, b: Rows) -> tuple[Rows, Rows]:
    """a + b = sum + error, exactly."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def quick_two_sum(a: Rows, b: Rows) -> tuple[Rows, Rows]:
    """The same for |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


def split(a: Rows) -> tuple[Rows, Rows]:
    """Two halves of a."""
    big = SPLITTER * a
    high = big - (big - a)
    return high, a - high


def two_product(a: Rows, b: Rows) -> tuple[Rows, Rows]:
    """a b = product + error, exactly."""
    product = a * b
    ah, al = split(a)
    bh, bl = split(b)
    return product, ((ah * bh - product) + ah * bl + al * bh) + al * bl


class DoubleDouble:
    """high + low, arrays of one shape; other operands are floats or float64 arrays, exactly."""

    __slots__ = ("high", "low")
    __array_ufunc__ = None

    def __init__(self, high: Rows | float, low: Rows | float | None = None) -> None:
        self.high: Rows = np.asarray(high, float)
        self.low: Rows = np.zeros_like(self.high) if low is None else np.asarray(low, float)

    @classmethod
    def of(cls, value: Fraction) -> DoubleDouble:
        """The number nearest to a fraction."""
        high = float(value)
        return cls(high, float(value - Fraction(high)))

    def __add__(self, other: Operand) -> DoubleDouble:
        b = _number(other)
        if b is None:
            return NotImplemented
        s, e = two_sum(self.high, b.high)
        t, f = two_sum(self.low, b.low)
        s, e = quick_two_sum(s, e + t)
        return DoubleDouble(*quick_two_sum(s, e + f))

    __radd__ = __add__

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __sub__(self, other: Operand) -> DoubleDouble:
        b = _number(other)
        return NotImplemented if b is None else self + (-b)

    def __rsub__(self, other: Operand) -> DoubleDouble:
        return (-self) + other

    def __mul__(self, other: Operand) -> DoubleDouble:
        b = _number(other)
        if b is None:
            return NotImplemented
        p, e = two_product(self.high, b.high)
        return DoubleDouble(*quick_two_sum(p, e + (self.high * b.low + self.low * b.high)))

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> DoubleDouble:
        b = _number(other)
        if b is None:
            return NotImplemented
        first = self.high / b.high
        rest = self - b * first
        second = rest.high / b.high
        rest = rest - b * second
        return DoubleDouble(*quick_two_sum(first, second)) + rest.high / b.high

    def __rtruediv__(self, other: Operand) -> DoubleDouble:
        return DoubleDouble(_array(other)) / self

    def __getitem__(self, key: Any) -> DoubleDouble:
        return DoubleDouble(self.high[key], self.low[key])

    @property
    def shape(self) -> tuple[int, ...]:
        """Of its rows."""
        return self.high.shape

    @property
    def number(self) -> DoubleDouble:
        """Itself: what a series is about."""
        return self

    def sqrt(self) -> DoubleDouble:
        """The root, 0 of what is not positive."""
        positive = self.high > 0.0
        square = where(positive, self, DoubleDouble(np.ones_like(self.high)))
        root = DoubleDouble(np.sqrt(square.high))
        for _ in range(2):
            root = root + (square - root * root) * (0.5 / root.high)
        return root * np.where(positive, 1.0, 0.0)

    def sin_cos(self) -> tuple[DoubleDouble, DoubleDouble]:
        """Sine and cosine of rad, to an absolute 1e-30 up to a million turns."""
        quarters = np.rint(self.high * (2.0 / float(PI)))
        rest = self
        for part in _HALF_PI:
            rest = rest - DoubleDouble(quarters) * part
        sine, cosine = _series(rest * 2.0**-HALVINGS)
        for _ in range(HALVINGS):
            sine, cosine = sine * cosine * 2.0, 1.0 - sine * sine * 2.0
        turn = np.mod(quarters, 4.0)
        swapped = np.mod(turn, 2.0) == 1.0
        s, c = where(swapped, cosine, sine), where(swapped, sine, cosine)
        below, left = turn >= 2.0, (turn == 1.0) | (turn == 2.0)
        return s * np.where(below, -1.0, 1.0), c * np.where(left, -1.0, 1.0)

    def arctan2(self, x: DoubleDouble) -> DoubleDouble:
        """The angle of (x, self) in (-pi, pi]; 0 at the origin."""
        guess = DoubleDouble(np.arctan2(self.high, x.high))
        length = (self * self + x * x).sqrt()
        there = where(length.high > 0.0, length, DoubleDouble(np.ones_like(length.high)))
        for _ in range(2):  # each trebles the digits, as the sine lacks its cube
            s, c = guess.sin_cos()
            guess = guess + (self * c - x * s) / there
        return guess

    def exp(self) -> DoubleDouble:
        """The exponential, for arguments that neither overflow nor matter where they underflow."""
        twos = np.rint(self.high / _LN2.high)
        rest = (self - _LN2 * twos) * 2.0**-EXPONENT_HALVINGS
        term, total = rest, rest
        for n in range(2, EXPONENT_TERMS):
            term = term * rest / float(n)
            total = total + term
        for _ in range(EXPONENT_HALVINGS):  # e^2x - 1 of e^x - 1
            total = total * 2.0 + total * total
        total = total + 1.0
        scale = np.ldexp(1.0, np.clip(twos, -1000, 1000).astype(int))
        return DoubleDouble(total.high * scale, total.low * scale)


Operand = DoubleDouble | Rows | float


def _array(value: Operand) -> Rows:
    return np.asarray(value, float)


def _number(value: object) -> DoubleDouble | None:
    if isinstance(value, DoubleDouble):
        return value
    if isinstance(value, float | int | np.ndarray | np.floating):
        return DoubleDouble(np.asarray(value, float))
    return None


def where(mask: NDArray[np.bool_], yes: DoubleDouble, no: DoubleDouble) -> DoubleDouble:
    """Row by row one of two."""
    return DoubleDouble(np.where(mask, yes.high, no.high), np.where(mask, yes.low, no.low))


def _reciprocal_factorial(n: int) -> DoubleDouble:
    product = Fraction(1)
    for k in range(2, n + 1):
        product /= k
    return DoubleDouble.of(product)


def _series(x: DoubleDouble) -> tuple[DoubleDouble, DoubleDouble]:
    """Taylor's series by Horner's rule, |x| < 0.1."""
    square = x * x
    sine, cosine = _FACTORIALS[2 * TERMS + 1], _FACTORIALS[2 * TERMS]
    for n in range(TERMS - 1, -1, -1):
        sine = _FACTORIALS[2 * n + 1] - sine * square
        cosine = _FACTORIALS[2 * n] - cosine * square
    return sine * x, cosine


class _Parts(NamedTuple):
    one: float
    two: float
    three: float


def _parts(value: Fraction) -> _Parts:
    one = float(value)
    two = float(value - Fraction(one))
    return _Parts(one, two, float(value - Fraction(one) - Fraction(two)))


_HALF_PI = _parts(PI / 2)
_LN2 = DoubleDouble.of(
    Fraction("0.693147180559945309417232121458176568075500134360255254120680009493393621969694716")
)
_FACTORIALS = [_reciprocal_factorial(n) for n in range(2 * TERMS + 2)]
DEGREE = DoubleDouble.of(PI / 180)
"""One degree in rad."""


def radians(degrees: Rows | DoubleDouble) -> DoubleDouble:
    """Angles in degrees, of which arrays are exact doubles, in rad."""
    exact = degrees if isinstance(degrees, DoubleDouble) else DoubleDouble(degrees)
    return exact * DEGREE
