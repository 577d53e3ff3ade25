"""Finite rotations and displacements as vectors, for questions of rank (messages, never cells).

Arrays may have any leading dimensions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats


def displacement(turn: Floats, place: Floats, to_turn: Floats, to_place: Floats) -> Floats:
    """The displacement (..., 6) that carries the pose `to_turn` (..., 3, 3), `to_place` (..., 3)
    onto `turn`, `place`: rotation vector, shift of the origin."""
    by = turn @ np.swapaxes(to_turn, -1, -2)
    shift = place - (by @ to_place[..., None])[..., 0]
    return np.concatenate([rotation_vector(by), shift], axis=-1)


def rotation_vector(turn: Floats) -> Floats:
    """Axis times angle (..., 3) of a rotation (..., 3, 3); at half a turn any axis."""
    skew = 0.5 * np.stack(
        [
            turn[..., 2, 1] - turn[..., 1, 2],
            turn[..., 0, 2] - turn[..., 2, 0],
            turn[..., 1, 0] - turn[..., 0, 1],
        ],
        axis=-1,
    )
    sine = np.sqrt(np.sum(skew * skew, axis=-1))
    cosine = 0.5 * (np.trace(turn, axis1=-2, axis2=-1) - 1.0)
    angle = np.arctan2(sine, cosine)
    still = sine == 0.0
    found = skew * (angle / np.where(still, 1.0, sine))[..., None]
    found[..., 0] += np.where(still, angle, 0.0)
    return np.asarray(found, dtype=np.float64)


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
    """Quaternions (..., 4) turned further by rotation vectors (..., 3) about axes that stand
    still."""
    angle = np.sqrt(np.sum(vector * vector, axis=-1, keepdims=True))
    half = 0.5 * vector * np.sinc(angle / (2.0 * np.pi))
    found = product(np.concatenate([np.cos(0.5 * angle), half], axis=-1), quaternion)
    return np.asarray(found / np.sqrt(np.sum(found * found, axis=-1, keepdims=True)))


def turn_between(quaternion: Floats, other: Floats) -> Floats:
    """The rotation vectors (..., 3) that turn `other` (..., 4) on to `quaternion`."""
    back = other * np.array([1.0, -1.0, -1.0, -1.0])
    by = product(quaternion, back)
    by = np.where(by[..., :1] < 0.0, -by, by)
    sine = np.sqrt(np.sum(by[..., 1:] ** 2, axis=-1, keepdims=True))
    angle = 2.0 * np.arctan2(sine, by[..., :1])
    return np.asarray(by[..., 1:] * np.where(sine > 0.0, angle / np.where(sine > 0.0, sine, 1), 2))


def product(one: Floats, two: Floats) -> Floats:
    """Products of quaternions (..., 4), scalar first."""
    a, v = one[..., :1], one[..., 1:]
    b, w = two[..., :1], two[..., 1:]
    scalar = a * b - np.sum(v * w, axis=-1, keepdims=True)
    return np.concatenate([scalar, a * w + b * v + cross(v, w)], axis=-1)


def cross(one: Floats, two: Floats) -> Floats:
    """Cross products (..., 3), with less ado than NumPy's."""
    return np.asarray(
        one[..., [1, 2, 0]] * two[..., [2, 0, 1]] - one[..., [2, 0, 1]] * two[..., [1, 2, 0]]
    )
