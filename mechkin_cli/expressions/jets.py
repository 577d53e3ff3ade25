"""Jets: a number that moves, as value and first three derivatives over a parameter.

A jet is an array of shape (4, rows), or (4, 1) for a constant. Sums, products (Leibniz), quotients
and functions of jets (Faa di Bruno) are exact: nothing is differenced. Source: A. Griewank and
A. Walther, Evaluating Derivatives, chapter 13.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.expressions import operations
from mechkin_cli.show import Floats

Jet = NDArray[np.float64]

ORDERS = 4
"""The value and three derivatives."""


def constant_jet(value: float) -> Jet:
    """A number that does not move."""
    jet = np.zeros((ORDERS, 1))
    jet[0] = value
    return jet


def product(a: Jet, b: Jet) -> Jet:
    """a b."""
    return _stacked(
        [
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            (a[2] * b[0] + a[0] * b[2]) + 2.0 * (a[1] * b[1]),
            (a[3] * b[0] + a[0] * b[3]) + 3.0 * (a[2] * b[1] + a[1] * b[2]),
        ]
    )


def quotient(a: Jet, b: Jet) -> Jet:
    """a / b, from a = (a/b) b order by order."""
    q0 = a[0] / b[0]
    q1 = (a[1] - q0 * b[1]) / b[0]
    q2 = (a[2] - 2.0 * (q1 * b[1]) - q0 * b[2]) / b[0]
    q3 = (a[3] - 3.0 * (q2 * b[1] + q1 * b[2]) - q0 * b[3]) / b[0]
    return _stacked([q0, q1, q2, q3])


def of(outer: Sequence[Floats], inner: Jet) -> Jet:
    """f(inner) from f, f', f'', f''' at inner[0]; what does not move needs no derivative of f."""
    f0, *slopes = outer
    g1, g2, g3 = inner[1], inner[2], inner[3]
    still = (inner[1:] == 0.0).all(axis=0)
    f1, f2, f3 = (np.where(still, 0.0, slope) for slope in slopes)
    return _stacked(
        [
            f0,
            f1 * g1,
            f2 * (g1 * g1) + f1 * g2,
            f3 * (g1 * g1 * g1) + 3.0 * f2 * (g1 * g2) + f1 * g3,
        ]
    )


def _stacked(orders: list[Floats]) -> Jet:
    return np.stack(np.broadcast_arrays(*orders))


# Hyperbolic functions of rows with their first three derivatives, each of shape (rows,). Those of
# other elementary functions are `tape.SLOPES`.


def sinh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic sine."""
    sine, cosine = operations.sinh(x), operations.cosh(x)
    return sine, cosine, sine, cosine  # type: ignore[return-value]


def cosh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic cosine."""
    sine, cosine, *_ = sinh(x)
    return cosine, sine, cosine, sine


def tanh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic tangent."""
    tangent: Any = operations.tanh(x)
    slope = 1.0 / (cosh(x)[0] * cosh(x)[0])
    third = slope * (4.0 * tangent * tangent - 2.0 * slope)
    return tangent, slope, -2.0 * tangent * slope, third


def asinh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic sine."""
    slope = 1.0 / np.sqrt(x * x + 1.0)
    cube = slope * slope * slope
    third = cube * (3.0 * (x * slope) * (x * slope) - 1.0)
    return operations.asinh(x), slope, -x * cube, third  # type: ignore[return-value]


def acosh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic cosine."""
    slope = 1.0 / np.sqrt((x - 1.0) * (x + 1.0))
    cube = slope * slope * slope
    third = cube * (3.0 * (x * slope) * (x * slope) - 1.0)
    return operations.acosh(x), slope, -x * cube, third  # type: ignore[return-value]


def atanh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic tangent."""
    slope = 1.0 / ((1.0 - x) * (1.0 + x))
    square = slope * slope
    third = (6.0 * x * x + 2.0) * (square * slope)
    return operations.atanh(x), slope, 2.0 * x * square, third  # type: ignore[return-value]
