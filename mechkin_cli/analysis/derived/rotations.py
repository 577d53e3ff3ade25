"""Unit quaternions and rotation vectors of rotations over rows.

The symmetric matrix 4 q q^T is linear in the entries of a rotation (Shepperd, Quaternion from
rotation matrix, J. Guidance and Control 1, 1978); its row with the largest diagonal, made a unit
vector, is q to rounding at every angle. The angle is 2 atan2(|q1 q2 q3|, |q0|).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli import tolerances
from mechkin_cli.analysis.derived.row_vectors import dot, length, scale
from mechkin_cli.tape.scalars import of_two

if TYPE_CHECKING:
    from mechkin_cli.analysis.derived.row_vectors import RowVector
    from mechkin_cli.arrays import Floats

    Quaternion = tuple[Floats, Floats, Floats, Floats]
    Rotation = tuple[RowVector, RowVector, RowVector]


def relative(first: Rotation, second: Rotation) -> Rotation:
    """R1^T R2 of rotations that are given by their columns, again by columns."""
    x, y, z = ((dot(first[0], c), dot(first[1], c), dot(first[2], c)) for c in second)
    return (x, y, z)


def quaternion(rotation: Rotation) -> Quaternion:
    """Unit quaternion (scalar first) of a rotation's columns, with `upright` sign."""
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = rotation
    q01, q02, q03 = m21 - m12, m02 - m20, m10 - m01
    q12, q13, q23 = m10 + m01, m20 + m02, m21 + m12
    outer = (
        (1.0 + m00 + m11 + m22, q01, q02, q03),
        (q01, 1.0 + m00 - m11 - m22, q12, q13),
        (q02, q12, 1.0 - m00 + m11 - m22, q23),
        (q03, q13, q23, 1.0 - m00 - m11 + m22),
    )
    best, row = outer[0][0], outer[0]
    for k in (1, 2, 3):
        larger = outer[k][k] > best
        best = np.where(larger, outer[k][k], best)
        a, b, c, d = (np.where(larger, p, q) for p, q in zip(outer[k], row, strict=True))
        row = (a, b, c, d)
    size = np.sqrt(inner(row, row))
    return upright((row[0] / size, row[1] / size, row[2] / size, row[3] / size))


def inner(p: Quaternion, q: Quaternion) -> Floats:
    """Sum of the products of the components."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]


def times(sign: Floats, q: Quaternion) -> Quaternion:
    """A quaternion with each row's sign."""
    return (sign * q[0], sign * q[1], sign * q[2], sign * q[3])


def upright(q: Quaternion) -> Quaternion:
    """The one of q and -q with positive scalar part; at half a turn the first other component that
    is not zero is positive."""
    sign = np.ones_like(q[0])
    for component in reversed(q):
        told = np.abs(component) > tolerances.HALF_TURN
        sign = np.where(told, np.where(component < 0.0, -1.0, 1.0), sign)
    return times(sign, q)


def angle(q: Quaternion) -> Floats:
    """Angle in [0, pi]."""
    found: Floats = 2.0 * of_two("ATAN2", length(q[1:]), np.abs(q[0]))
    return found


def rotation_vector(q: Quaternion) -> RowVector:
    """Axis times angle of an upright quaternion; the angle is in [0, pi]."""
    size = length(q[1:])
    none = size == 0.0
    return scale(np.where(none, 2.0, angle(q) / np.where(none, 1.0, size)), q[1:])
