"""Isometric projection: all three axes are shortened alike, seen from the corner (1, 1, 1).

With x', y', z' the axes turned so that z' points up, a point stands at (y' - x')/sqrt(2) to the
right and (2z' - x' - y')/sqrt(6) upwards, and is (x' + y' + z')/sqrt(3) near.
"""

from __future__ import annotations

from math import sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.view.joints import drawn_joints
from mechkin_cli.view.limits import FLATNESS

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.model import Mechanism


class Isometric(NamedTuple):
    """The axis (0, 1, 2) of ground that points up, and whether it does so backwards."""

    up: int = 2
    down: bool = False

    def seen(self, points: Floats) -> Floats:
        """Places (..., 3) on the picture: to the right, upwards, and how near."""
        x, y, z = (points[..., (self.up + k) % 3] for k in (1, 2, 3))
        if self.down:
            y, z = -y, -z
        return np.stack(
            [(y - x) / sqrt(2.0), (2.0 * z - x - y) / sqrt(6.0), (x + y + z) / sqrt(3.0)], axis=-1
        )


def isometric(mechanism: Mechanism) -> Isometric:
    """The projection of a mechanism: up is against gravity, else z, or y where all axes about which
    joints turn are along z, so that a plane linkage stands upright."""
    gravity = np.array(mechanism.gravity)
    if gravity.any():
        axis = int(np.argmax(np.abs(gravity)))
        return Isometric(axis, bool(gravity[axis] > 0.0))
    turning = [
        joint.on_first.z
        for joint in drawn_joints(mechanism)
        if not all(joint.type.slides) or joint.type.is_oriented
    ]
    flat = [max(abs(axis[0]), abs(axis[1])) <= FLATNESS for axis in turning]
    return Isometric(1) if flat and all(flat) else Isometric(2)
