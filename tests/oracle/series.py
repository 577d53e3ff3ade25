"""Truncated Taylor series c0 + c1 t + ... + cn t^n: exact differentiation with respect to t.

Products are convolutions; sine, cosine and the reciprocal follow from their differential equations
(s' = c x', c' = -s x', x y = 1). Coefficients are numbers of `oracle.numerics`; a plain number
stands for the constant series everywhere, which saves most of the products.
"""

from __future__ import annotations

from collections.abc import Iterable
from operator import add, neg
from typing import Any

from oracle.numerics import Number, mp


class Series:
    """A truncated Taylor series; both operands of an operation have the same order."""

    __slots__ = ("c",)

    def __init__(self, coefficients: Iterable[Number]) -> None:
        self.c = tuple(coefficients)

    def __add__(self, other: Any) -> Series:
        if isinstance(other, Series):
            return Series(map(add, self.c, self._of_this_order(other)))
        return Series((self.c[0] + other, *self.c[1:]))

    __radd__ = __add__

    def __neg__(self) -> Series:
        return Series(map(neg, self.c))

    def __sub__(self, other: Any) -> Series:
        return self + (-other)

    def __rsub__(self, other: Any) -> Series:
        return -self + other

    def __mul__(self, other: Any) -> Series:
        if not isinstance(other, Series):
            return Series([a * other for a in self.c])
        a, b = self.c, self._of_this_order(other)
        return Series([_convolution(a, b, k) for k in range(len(a))])

    __rmul__ = __mul__

    def _of_this_order(self, other: Series) -> tuple[Number, ...]:
        if len(other.c) != len(self.c):
            raise ValueError(f"series of {len(self.c)} and {len(other.c)} coefficients")
        return other.c


def coefficient(x: Any, k: int) -> Number:
    """The coefficient of t^k of a series or a number."""
    if isinstance(x, Series):
        return x.c[k]
    return x if k == 0 else mp.zero


def derivatives(x: Any, order: int) -> list[Number]:
    """The derivatives of a series or a number at t = 0, from order 0."""
    return [coefficient(x, k) * mp.factorial(k) for k in range(order + 1)]


def _convolution(a: tuple[Number, ...], b: tuple[Number, ...], k: int) -> Number:
    total = a[0] * b[k]
    for i in range(1, k + 1):
        total += a[i] * b[k - i]
    return total


def reciprocal(x: Any) -> Any:
    if not isinstance(x, Series):
        return 1 / x
    c = [1 / x.c[0]]
    for k in range(1, len(x.c)):
        c.append(-sum(x.c[i] * c[k - i] for i in range(1, k + 1)) / x.c[0])
    return Series(c)


def cosine_sine(x: Any) -> tuple[Any, Any]:
    if not isinstance(x, Series):
        return mp.cos_sin(x)
    first_cosine, first_sine = mp.cos_sin(x.c[0])
    c, s = [first_cosine], [first_sine]
    for k in range(1, len(x.c)):
        s.append(sum(i * x.c[i] * c[k - i] for i in range(1, k + 1)) / k)
        c.append(-sum(i * x.c[i] * s[k - i] for i in range(1, k + 1)) / k)
    return Series(c), Series(s)


def derivative(x: Any) -> Any:
    """The series of the derivative, one coefficient shorter."""
    if not isinstance(x, Series):
        return mp.zero
    return Series(k * x.c[k] for k in range(1, len(x.c)))


def cut(x: Any, order: int) -> Any:
    """The series up to t^order."""
    return Series(x.c[: order + 1]) if isinstance(x, Series) else x


def angle(cosine: Any, sine: Any, near: Number) -> Any:
    """The angle of a cosine and a sine of any common length, the one nearest to `near`.

    From a' (c^2 + s^2) = c s' - s c'.
    """
    first = mp.atan2(coefficient(sine, 0), coefficient(cosine, 0))
    first += 2 * mp.pi * mp.nint((near - first) / (2 * mp.pi))
    if not isinstance(cosine, Series) and not isinstance(sine, Series):
        return first
    square = cosine * cosine + sine * sine
    order = len(square.c) - 1
    right = cut(cosine, order - 1) * derivative(sine) - cut(sine, order - 1) * derivative(cosine)
    a = [first]
    for k in range(1, order + 1):
        known = mp.fsum(i * a[i] * square.c[k - i] for i in range(1, k))
        a.append((coefficient(right, k - 1) - known) / (k * square.c[0]))
    return Series(a)
