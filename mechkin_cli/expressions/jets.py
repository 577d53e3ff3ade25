"""Jets: a number that moves, as value and first three derivatives over a parameter.

A jet is an array of shape (4, rows), or (4, 1) for a constant. Sums, products (Leibniz), quotients
and functions of jets (Faa di Bruno) are exact: nothing is differenced. Source: A. Griewank and
A. Walther, Evaluating Derivatives, chapter 13.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.arrays import Floats

Jet = NDArray[np.float64]

ORDERS = 4
"""The value and three derivatives."""


def constant(value: float) -> Jet:
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


def chosen(condition: NDArray[np.bool_], a: Jet, b: Jet) -> Jet:
    """a in the rows where the condition holds, b in the others."""
    return np.where(condition, a, b)


def is_constant(jet: Jet) -> bool:
    """Whether no row moves."""
    return not jet[1:].any()


def _stacked(orders: list[Floats]) -> Jet:
    return np.stack(np.broadcast_arrays(*orders))
