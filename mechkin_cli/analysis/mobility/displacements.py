"""Finite rotations and displacements as vectors, for questions of rank (messages, never cells)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.mobility.opened import Pose

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def between(pose: Pose, other: Pose) -> Floats:
    """The displacement (6,) that carries `other` onto `pose`: rotation vector, shift of the
    origin."""
    turn = pose.turn @ other.turn.T
    return np.concatenate([rotation_vector(turn), pose.place - turn @ other.place])


def rotation_vector(turn: Floats) -> Floats:
    """Axis times angle of a rotation; at half a turn any axis."""
    skew = 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )
    sine, cosine = float(np.sqrt(skew @ skew)), 0.5 * (float(np.trace(turn)) - 1.0)
    angle = float(np.arctan2(sine, cosine))
    if sine == 0.0:
        return np.array([angle, 0.0, 0.0])
    return np.asarray(skew * (angle / sine), dtype=np.float64)


def quaternion_of(turn: Floats) -> Floats:
    """Unit quaternion of a rotation, scalar first; exact where the angle is half a turn, too."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = turn.tolist()
    products = np.array(  # 4 q q^T
        [
            [1.0 + xx + yy + zz, zy - yz, xz - zx, yx - xy],
            [zy - yz, 1.0 + xx - yy - zz, xy + yx, xz + zx],
            [xz - zx, xy + yx, 1.0 - xx + yy - zz, yz + zy],
            [yx - xy, xz + zx, yz + zy, 1.0 - xx - yy + zz],
        ]
    )
    row = products[int(np.argmax(np.diag(products)))]
    return np.asarray(row / np.sqrt(row @ row), dtype=np.float64)


def turned(quaternion: Floats, vector: Floats) -> Floats:
    """A quaternion turned further by a rotation vector about the axes that stand still."""
    angle = float(np.sqrt(vector @ vector))
    half = 0.5 * vector * (np.sin(0.5 * angle) / (0.5 * angle) if angle > 0.0 else 1.0)
    c, q, v = np.cos(0.5 * angle), quaternion[0], quaternion[1:]
    found = np.array([c * q - half @ v, *(c * v + q * half + np.cross(half, v))])
    return np.asarray(found / np.sqrt(found @ found), dtype=np.float64)
