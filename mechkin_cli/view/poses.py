"""Poses of links in the rows of a run, read off its states.

The columns of a link's rotation are the ground axes as drawn on it, its shift is that of one of its
joint points: x = R x0 + t with t = p - R p0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.derived.basis import displacement, rotation_of, vector_of
from mechkin_cli.analysis.derived.rotations import quaternion
from mechkin_cli.mechanism.derived_quantities import reference_point
from mechkin_cli.mechanism.model import GROUND_NAME

if TYPE_CHECKING:
    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.arrays import Floats
    from mechkin_cli.mechanism.vectors import Vector

HOME = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
"""The pose of what is where it was drawn."""


def link_poses(result: Result, links: Sequence[str]) -> Floats:
    """Shift (m) and unit quaternion (scalar first) of links, shape (rows, links, 7).

    Rows without a solution are nan; ground, and links of loops that were not followed, are at home.
    Quaternions have q0 >= 0; `continuous` joins them.
    """
    poses = np.full((result.rows, len(links), 7), np.nan)
    poses[result.solved] = HOME
    own = result.problem.mechanism
    moving = [name for name in links if name != GROUND_NAME and name in own.links]
    wanted = [quantity for name in moving for quantity in displacement(name)]
    if not (wanted and result.solved.any()):
        return poses
    columns = result.evaluated(wanted)
    for name in moving:
        at, rotation = links.index(name), rotation_of(columns, name)
        drawn = reference_point(own, name).vector
        place = vector_of(columns[f"{name} place"])
        for axis in range(3):
            carried = sum(rotation[k][axis] * drawn[k] for k in range(3))
            poses[:, at, axis] = place[axis] - carried
        poses[:, at, 3:] = np.stack(quaternion(rotation), axis=1)
    poses[~result.solved] = np.nan
    return poses


def continuous(poses: Floats) -> Floats:
    """The same poses (poses, links, 7), each quaternion with the sign that is nearer to the one
    before it."""
    turns = poses[:, :, 3:]
    back = np.einsum("plk,plk->pl", turns[1:], turns[:-1]) < 0.0
    signs = np.cumprod(np.where(back, -1.0, 1.0), axis=0)
    found = poses.copy()
    found[1:, :, 3:] *= signs[:, :, None]
    return found


def carried(poses: Floats, point: Vector) -> Floats:
    """Where a point as drawn on a link is in its poses (..., 7), shape (..., 3): t + R x0 with
    R x0 = x0 + 2 q0 (v x x0) + 2 v x (v x x0), v the vector part."""
    start = np.asarray(point, dtype=np.float64)
    v = poses[..., 4:]
    across = np.cross(v, start)
    moved: Floats = poses[..., :3] + start + 2.0 * (poses[..., 3:4] * across + np.cross(v, across))
    return moved
