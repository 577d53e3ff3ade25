"""Elementary functions of rows with their first three derivatives, each of shape (rows,)."""

from __future__ import annotations

from typing import Any

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.expressions import hyperbolic
from mechkin_cli.kernel import functions as kernel


def sin(x: Floats) -> tuple[Floats, ...]:
    """Sine."""
    sine, cosine = kernel.sin(x), kernel.cos(x)
    return sine, cosine, -sine, -cosine


def cos(x: Floats) -> tuple[Floats, ...]:
    """Cosine."""
    sine, cosine = kernel.sin(x), kernel.cos(x)
    return cosine, -sine, -cosine, sine


def tan(x: Floats) -> tuple[Floats, ...]:
    """Tangent."""
    tangent = kernel.tan(x)
    square = tangent * tangent
    return (
        tangent,
        1.0 + square,
        2.0 * tangent * (1.0 + square),
        (1.0 + square) * (2.0 + 6 * square),
    )


def asin(x: Floats) -> tuple[Floats, ...]:
    """Arcsine."""
    slope = 1.0 / np.sqrt((1.0 - x) * (1.0 + x))
    cube = slope * slope * slope
    return kernel.asin(x), slope, x * cube, cube * (1.0 + 3.0 * (x * slope) * (x * slope))


def acos(x: Floats) -> tuple[Floats, ...]:
    """Arccosine."""
    _, first, second, third = asin(x)
    return kernel.acos(x), -first, -second, -third


def atan(x: Floats) -> tuple[Floats, ...]:
    """Arctangent."""
    slope = 1.0 / (1.0 + x * x)
    square = slope * slope
    return kernel.atan(x), slope, -2.0 * x * square, (6.0 * x * x - 2.0) * (square * slope)


def sqrt(x: Floats) -> tuple[Floats, ...]:
    """Square root."""
    root = np.sqrt(x)
    first = 0.5 / root
    second = -0.5 * first / x
    return root, first, second, -1.5 * second / x


def sinh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic sine."""
    sine, cosine = hyperbolic.sinh(x), hyperbolic.cosh(x)
    return sine, cosine, sine, cosine  # type: ignore[return-value]


def cosh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic cosine."""
    sine, cosine, *_ = sinh(x)
    return cosine, sine, cosine, sine


def tanh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic tangent."""
    tangent: Any = hyperbolic.tanh(x)
    slope = 1.0 / (cosh(x)[0] * cosh(x)[0])
    return (
        tangent,
        slope,
        -2.0 * tangent * slope,
        slope * (4.0 * tangent * tangent - 2.0 * slope),
    )


def asinh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic sine."""
    slope = 1.0 / np.sqrt(x * x + 1.0)
    cube = slope * slope * slope
    third = cube * (3.0 * (x * slope) * (x * slope) - 1.0)
    return hyperbolic.asinh(x), slope, -x * cube, third  # type: ignore[return-value]


def acosh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic cosine."""
    slope = 1.0 / np.sqrt((x - 1.0) * (x + 1.0))
    cube = slope * slope * slope
    third = cube * (3.0 * (x * slope) * (x * slope) - 1.0)
    return hyperbolic.acosh(x), slope, -x * cube, third  # type: ignore[return-value]


def atanh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic tangent."""
    slope = 1.0 / ((1.0 - x) * (1.0 + x))
    square = slope * slope
    third = (6.0 * x * x + 2.0) * (square * slope)
    return hyperbolic.atanh(x), slope, 2.0 * x * square, third  # type: ignore[return-value]


def exp(x: Floats) -> tuple[Floats, ...]:
    """Exponential function."""
    value = kernel.exp(x)
    return value, value, value, value


def log(x: Floats) -> tuple[Floats, ...]:
    """Natural logarithm."""
    slope = 1.0 / x
    return kernel.log(x), slope, -(slope * slope), 2.0 * (slope * slope * slope)
