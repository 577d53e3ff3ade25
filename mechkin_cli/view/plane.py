"""Whether a mechanism moves in a plane square to a ground axis, and is drawn in it: then the page
looks along that axis first."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.view.limits import FLATNESS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mechkin_cli.arrays import Floats


def plane_of_motion(poses: Sequence[Floats], low: Floats, high: Floats) -> int | None:
    """The ground axis (0, 1, 2) square to the plane in which all points of a box from `low` to
    `high` (m) lie and all `poses` (poses, links, 7) of some branches move; None without one."""
    extents = high - low
    size = float(np.linalg.norm(extents))
    flat = np.flatnonzero(extents <= FLATNESS * size)
    if flat.size != 1 or not poses:
        return None
    axis = int(flat[0])
    others = [k for k in range(3) if k != axis]
    for found in poses:
        leaves = np.abs(found[:, :, axis]) > FLATNESS * size
        tilts = np.abs(found[:, :, [4 + k for k in others]]) > FLATNESS
        if leaves.any() or tilts.any():
            return None
    return axis


def upwards(gravity: Floats, axis: int | None) -> Floats:
    """The unit vector that is up on the page: against gravity, in a plane its part in it; without
    one z, or y where the page looks along z."""
    up = 0.0 - np.asarray(gravity, dtype=np.float64)
    if axis is not None:
        up[axis] = 0.0
    length = float(np.linalg.norm(up))
    if length > FLATNESS * float(np.linalg.norm(gravity)):
        return up / length + 0.0
    return np.array([0.0, 1.0, 0.0] if axis == 2 else [0.0, 0.0, 1.0])
