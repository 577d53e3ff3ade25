"""Continuous angles and orientations of closing joints.

The kernel has the angle of a closing joint from an arctangent and its orientation from a rotation
matrix: whole turns and the quaternion's sign are lost. Following carries both along from node to
node by their derivatives (`follow(..., turns=True)`), so each row only has to take the value that
is nearest to what following says.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.kernel._kernel import Plan
    from mechkin_cli.mechanism.frames import Frame
    from mechkin_cli.mechanism.model import Joint

ORIENTATION = -1
"""Stands for the freedom of an orientation, which has four slots."""

Four = tuple["Floats", "Floats", "Floats", "Floats"]


def turn_slots(plan: Plan) -> dict[tuple[int, int], int]:
    """First row of `Followed.turns` of each (closing joint, freedom); freedom `ORIENTATION` of a
    joint that has no angles."""
    return {(joint, freedom): slot for joint, freedom, slot, _ in _kernel.closing_turns(plan)}


def turn_count(plan: Plan) -> int:
    """Number of rows of `Followed.turns`."""
    return sum(width for _, _, _, width in _kernel.closing_turns(plan))


def continuous_angle(values: Floats, followed: Floats, first: int) -> Floats:
    """An angle without jumps by whole turns; as given at row `first`.

    Args:
        values: (rows,) from an arctangent, rad.
        followed: (rows,) the same angle out of `Followed.turns`; nan where a row was not filled in
            between two nodes: it takes the turn of the nearest row before it that was, or the first
            after it.
        first: a row that keeps its value.
    """
    turns = np.rint((values - followed) / (2.0 * pi))
    for row in _unfollowed(followed):
        beside = row - 1 if row and not np.isnan(turns[row - 1]) else _next_known(turns, row)
        turns[row] = turns[beside] + np.rint((values[row] - values[beside]) / (2.0 * pi))
    continuous: Floats = values - (turns - turns[first]) * (2.0 * pi)
    return continuous


def continuous_signs(q: Four, followed: Four, first: int) -> Floats:
    """Signs (rows,) that make unit quaternions continuous, 1 at row `first`.

    Args:
        q: four arrays (rows,), scalar first, of either sign.
        followed: as `drawn_quaternion` gives them; nan as in `continuous_angle`.
        first: a row that keeps its sign.
    """
    product = _inner(q, followed)
    signs = np.where(product < 0.0, -1.0, 1.0)
    known = ~np.isnan(product)
    signs[~known] = np.nan
    for row in _unfollowed(product):
        beside = row - 1 if row and not np.isnan(signs[row - 1]) else _next_known(signs, row)
        between = sum(float(part[row]) * float(part[beside]) for part in q)
        signs[row] = signs[beside] * (-1.0 if between < 0.0 else 1.0)
    alike: Floats = signs * signs[first]
    return alike


def drawn_quaternion(joint: Joint, turns: Floats) -> Four:
    """The orientation that following carries along, (4, rows), about the axes as drawn.

    The kernel turns the joint's frame on the second link against the one on the first, R = A^T B;
    against the drawing that is A0 R B0^T.
    """
    a, b = _frame_quaternion(joint.on_first), _frame_quaternion(joint.on_second)
    r = (turns[0], turns[1], turns[2], turns[3])
    return _product(_product(a, r), (b[0], -b[1], -b[2], -b[3]))


def _unfollowed(followed: Floats) -> list[int]:
    rows: list[int] = np.flatnonzero(np.isnan(followed)).tolist()
    return rows


def _next_known(values: Floats, row: int) -> int:
    known = ~np.isnan(values[row:])
    return row + int(np.argmax(known)) if known.any() else row


def _inner(p: Four, q: Four) -> Floats:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]


def _product(p: Four, q: Four) -> Four:
    (a, b, c, d), (e, f, g, h) = p, q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


def _frame_quaternion(frame: Frame) -> Four:
    """The rotation whose columns are the frame's axes, as arrays of no dimension."""
    (m00, m10, m20), (m01, m11, m21), (m02, m12, m22) = frame.x, frame.y, frame.z
    a, b, c = m21 - m12, m02 - m20, m10 - m01
    d, e, f = m10 + m01, m20 + m02, m21 + m12
    rows = (
        (1.0 + m00 + m11 + m22, a, b, c),
        (a, 1.0 + m00 - m11 - m22, d, e),
        (b, d, 1.0 - m00 + m11 - m22, f),
        (c, e, f, 1.0 - m00 - m11 + m22),
    )
    best = max(range(4), key=lambda k: rows[k][k])
    size = sqrt(sum(part * part for part in rows[best]))
    w, x, y, z = (np.asarray(part / size) for part in rows[best])
    return (w, x, y, z)
