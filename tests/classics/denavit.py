"""Closed single loops from Denavit and Hartenberg's rows, by Newton's method on the closure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from classics.drawing import ring


def closed_loop(
    lengths: Sequence[float],
    twists: Sequence[float],
    offsets: Sequence[float],
    seed: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) and axes (n, 3) of an assembled loop of hinges; `seed` chooses the place.

    Row k: turn theta and shift `offsets` about z, then shift `lengths` and turn `twists` about the
    next x; the product over the loop is the identity.
    """
    count = len(lengths)
    random = np.random.default_rng(seed)
    for _ in range(400):
        angles = random.uniform(-np.pi, np.pi, count)
        for _ in range(60):
            miss, turned_back, slope, points, axes = _closure(lengths, twists, offsets, angles)
            if np.abs(miss).max() < 1e-14:
                break
            step = -np.linalg.lstsq(slope, miss, rcond=1e-9)[0]
            angles += step * min(1.0, 0.5 / np.abs(step).max())
        folded = np.abs(np.sin(angles)).min() < 0.05
        if np.abs(miss).max() < 1e-13 and turned_back < 1e-9 and not folded:
            return points, axes
    raise AssertionError("the loop does not close")


def _closure(lengths, twists, offsets, angles):
    pose, points, axes = np.eye(4), [], []
    for a, alpha, s, theta in zip(lengths, twists, offsets, angles, strict=True):
        points.append(pose[:3, 3])
        axes.append(pose[:3, 2])
        pose = pose @ _row(a, alpha, s, theta)
    turn = pose[:3, :3]
    spin = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    turned_back = 3.0 - np.trace(turn)  # half a turn has no skew part
    miss = np.concatenate([spin / 2, pose[:3, 3]])
    shift = pose[:3, 3]
    slope = [np.concatenate([z, np.cross(z, shift - p)]) for p, z in zip(points, axes, strict=True)]
    return miss, turned_back, np.array(slope).T, np.array(points), np.array(axes)


def _row(a: float, alpha: float, s: float, theta: float) -> np.ndarray:
    c, n, u, v = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array(
        [[c, -n * u, n * v, a * c], [n, c * u, -c * v, a * n], [0, v, u, s], [0, 0, 0, 1]]
    )


def hinges(lengths, twists, offsets=None, seed: int = 0) -> str:
    """The text of a ring of hinges."""
    points, axes = closed_loop(lengths, twists, offsets or [0.0] * len(lengths), seed)
    return ring("R" * len(lengths), points, axes)
