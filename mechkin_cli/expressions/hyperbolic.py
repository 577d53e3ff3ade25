"""Hyperbolic functions and their inverses, of exponentials and logarithms; near zero, where these
cancel, by their series.

The series are as long as double-double numbers need them, their coefficients exact. Source: M.
Abramowitz and I. Stegun, Handbook of Mathematical Functions, 4.5 and 4.6.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import accumulate

from mechkin_cli.exact import nearest
from mechkin_cli.expressions.quantity import Scalar
from mechkin_cli.expressions.scalar_functions import branch, square_root
from mechkin_cli.tape.scalars import of_one

_NEAR_ZERO = 0.5
"""Up to here sinh goes by its series; the 13 terms leave 0.5^26/27! = 1e-36 of it."""

_SINH = list(
    map(
        nearest,
        accumulate(range(1, 13), lambda c, k: c / (2 * k * (2 * k + 1)), initial=Fraction(1)),
    )
)

_NEAR_ZERO_INVERSE = 0.125
"""Up to here artanh goes by its series; the 19 terms leave 0.125^38/39 = 1e-36 of it."""

_ATANH = [nearest(Fraction(1, 2 * k + 1)) for k in range(19)]


def sinh(x: Scalar) -> Scalar:
    """(e^x - e^-x)/2."""
    far = (of_one("EXP", x) - of_one("EXP", -x)) * 0.5
    return _near_zero(x, _NEAR_ZERO, _SINH, far)


def cosh(x: Scalar) -> Scalar:
    """(e^x + e^-x)/2."""
    cosine: Scalar = (of_one("EXP", x) + of_one("EXP", -x)) * 0.5
    return cosine


def tanh(x: Scalar) -> Scalar:
    """sinh(x)/cosh(x), by 1 - 2/(e^2x + 1) where that does not cancel."""
    far = 1.0 - 2.0 / (of_one("EXP", 2.0 * x) + 1.0)
    return branch(x * x < _NEAR_ZERO * _NEAR_ZERO, sinh(x) / cosh(x), far)


def asinh(x: Scalar) -> Scalar:
    """artanh(x/sqrt(x^2 + 1)), by a logarithm where that does not cancel."""
    is_negative = x < 0.0
    root = square_root(x * x + 1.0)
    far = of_one("LOG", branch(is_negative, -x, x) + root)
    near = _NEAR_ZERO_INVERSE * _NEAR_ZERO_INVERSE
    return branch(x * x < near, atanh(x / root), branch(is_negative, -far, far))


def acosh(x: Scalar) -> Scalar:
    """2 arsinh(sqrt((x - 1)/2)), which is zero at 1; nan below."""
    return 2.0 * asinh(square_root((x - 1.0) * 0.5))


def atanh(x: Scalar) -> Scalar:
    """log((1 + x)/(1 - x))/2; infinite at 1 and -1, nan beyond."""
    far = of_one("LOG", (1.0 + x) / (1.0 - x)) * 0.5
    return _near_zero(x, _NEAR_ZERO_INVERSE, _ATANH, far)


def _near_zero(x: Scalar, limit: float, coefficients: Sequence[float], far: Scalar) -> Scalar:
    """An odd function by its series up to a limit, else `far`."""
    square = x * x
    series: Scalar = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        series = series * square + coefficient
    return branch(square < limit * limit, x * series, far)
