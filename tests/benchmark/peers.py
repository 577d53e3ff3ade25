"""What engineers write by hand: fsolve on 4x4 matrices, differences, a dense system per row."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmark.closure import Drawing, Kinematics
from benchmark.dense_forces import equations, wrenches

from benchmarks.rcsr import ACCELERATION, COORDINATES, RATE, Dimensions

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

STEP = 1e-4
"""Step of the differences, rad: rounding (1e-16 / step^2) and truncation (step^2 times a derivative
that grows towards the dead centre) meet here."""


def matrix(axis: Floats, point: Floats, theta: float, s: float) -> Floats:
    """The 4x4 matrix of a turn about and a slide along a line, in double precision."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    M = np.eye(4)
    M[:3, :3] += sin(theta) * K + (1.0 - cos(theta)) * (K @ K)
    M[:3, 3] = point - M[:3, :3] @ point + s * axis
    return M


class Closure:
    """The gap of the RCSR loop as a function for scipy."""

    def __init__(self, d: Drawing) -> None:
        self.axis = {k: np.array(v, float) for k, v in ((1, d.axis1), (2, d.axis2), (4, d.axis4))}
        points = ((1, d.point1), (2, d.point2), (4, d.point4))
        self.point = {k: np.array(v, float) for k, v in points}
        self.left = np.array([*map(float, d.on_coupler), 1.0])
        self.right = np.array([*map(float, d.on_rocker), 1.0])

    def gap(self, unknown: Floats, theta1: float) -> Floats:
        """Difference of the two places of the sphere's centre (3)."""
        theta2, s, theta4 = unknown
        M1 = matrix(self.axis[1], self.point[1], theta1, 0.0)
        M2 = matrix(self.axis[2], self.point[2], theta2, s)
        M4 = matrix(self.axis[4], self.point[4], theta4, 0.0)
        gap: Floats = (M1 @ M2 @ self.left - M4 @ self.right)[:3]
        return gap


def fsolve_positions(closure: Closure, theta1: Floats, start: Floats) -> Floats:
    """(3, rows): every row starts from the one before, the first from `start` (3)."""
    from scipy.optimize import fsolve

    found, guess = np.empty((3, theta1.size)), start
    for i, value in enumerate(theta1):
        guess = fsolve(closure.gap, guess, args=(float(value),))
        found[:, i] = guess
    return found


def differences(positions: Callable[[Floats], Floats], theta1: Floats) -> dict[str, Any]:
    """Coordinates and their derivatives from positions (3, rows) at theta1 and one step aside."""
    before, here, after = (positions(theta1 + k * STEP) for k in (-1, 0, 1))
    first = (after - before) / (2.0 * STEP)
    second = (after - 2.0 * here + before) / (STEP * STEP)
    found: dict[str, Any] = {}
    for i, name in enumerate(COORDINATES):
        found[name] = here[i]
        found[f"{name}_dot"] = RATE * first[i]
        found[f"{name}_ddot"] = ACCELERATION * first[i] + RATE * RATE * second[i]
    return found


def dense_loads(size: Dimensions, d: Drawing, k: Kinematics) -> dict[str, Any]:
    """Effort and wrenches from the 24 x 24 system, one numpy.linalg.solve per row."""
    rows = len(k.coordinates[0])
    system, right = equations(size, d, k).arrays(rows, np.float64)
    unknown = np.stack([np.linalg.solve(system[i], right[i]) for i in range(rows)])
    return wrenches(d, k, unknown)
