"""Vectors over rows: three arrays of shape (rows,), elementwise in a fixed order."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats

    RowVector = tuple[Floats, Floats, Floats]


def add(a: RowVector, b: RowVector) -> RowVector:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: RowVector, b: RowVector) -> RowVector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(s: Floats | float, a: RowVector) -> RowVector:
    """s a."""
    return (s * a[0], s * a[1], s * a[2])


def divide(a: RowVector, s: Floats | float) -> RowVector:
    """a / s."""
    return (a[0] / s, a[1] / s, a[2] / s)


def dot(a: RowVector, b: RowVector) -> Floats:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: RowVector, b: RowVector) -> RowVector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a: RowVector) -> Floats:
    """|a|."""
    return np.sqrt(dot(a, a))


def choose(condition: NDArray[np.bool_], a: RowVector, b: RowVector | float) -> RowVector:
    """a in the rows where the condition holds, else b."""
    bx, by, bz = b if isinstance(b, tuple) else (b, b, b)
    return (
        np.where(condition, a[0], bx),
        np.where(condition, a[1], by),
        np.where(condition, a[2], bz),
    )


def off(axis: RowVector, a: RowVector) -> RowVector:
    """The part of a square to a unit vector."""
    return subtract(a, scale(dot(axis, a), axis))
