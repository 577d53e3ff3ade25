"""The solution that errors are measured against, and the measure.

Quantities by name: `O2.theta` ... with `_dot` and `_ddot`, `O1.effort`, `J.force`, `J.moment`;
arrays over the rows, vectors (rows, 3), in m, rad, N and N m.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mechkin_cli.benchmark.arithmetic import Arithmetic, extended
from mechkin_cli.benchmark.closure import Drawing, Kinematics, drawing, kinematics
from mechkin_cli.benchmark.dense_forces import equations, wrenches
from mechkin_cli.benchmark.rcsr import COORDINATES, JOINTS, Dimensions

POSITIONS = COORDINATES
VELOCITIES = tuple(f"{name}_dot" for name in COORDINATES)
ACCELERATIONS = tuple(f"{name}_ddot" for name in COORDINATES)
WRENCHES = tuple(f"{joint}.{part}" for joint in JOINTS for part in ("force", "moment"))
LOADS = ("O1.effort", *WRENCHES)
EVERYTHING = (*POSITIONS, *VELOCITIES, *ACCELERATIONS, *LOADS)
ZERO_COLUMNS = frozenset({"O3.moment"})
"""A sphere transmits no moment; what rounding leaves there has no size to be compared with."""


def solution(size: Dimensions, theta1: Any, guess: Any) -> dict[str, Any]:
    """Everything in extended precision; theta1 (rows), guess (3, rows) of theta2, s, theta4."""
    d = drawing(size, extended())
    values = np.asarray(theta1, dtype=np.longdouble)
    k = kinematics(d, values, [np.asarray(x, dtype=np.longdouble) for x in guess])
    return named_motion(k) | loads(size, d, k, values.size, np.longdouble)


def row_by_row(size: Dimensions, theta1: Any, guess: Any, arithmetic: Arithmetic) -> dict[str, Any]:
    """As `solution` in any arithmetic; the arrays hold its numbers as objects."""
    d, number = drawing(size, arithmetic), arithmetic.number
    rows = []
    for i, value in enumerate(theta1):
        k = kinematics(d, number(value), [number(column[i]) for column in guess])
        motion = {name: np.array([x], dtype=object) for name, x in named_motion(k).items()}
        rows.append(motion | loads(size, d, k, 1, object))
    return {name: np.concatenate([row[name] for row in rows]) for name in rows[0]}


def named_motion(k: Kinematics) -> dict[str, Any]:
    """Coordinates, rates and accelerations by name."""
    found: dict[str, Any] = {}
    for names, columns in (
        (POSITIONS, k.coordinates),
        (VELOCITIES, k.rates),
        (ACCELERATIONS, k.accelerations),
    ):
        found |= dict(zip(names, columns, strict=True))
    return found


def loads(size: Dimensions, d: Drawing, k: Kinematics, rows: int, dtype: Any) -> dict[str, Any]:
    """Effort and wrenches from the 24 x 24 system in the numbers of the kinematics."""
    matrix, right = equations(size, d, k).arrays(rows, dtype)
    return wrenches(d, k, eliminate(matrix, right))


def eliminate(matrix: Any, right: Any) -> Any:
    """Solutions (rows, n) of systems (rows, n, n) by Gaussian elimination with partial pivoting."""
    a = np.concatenate([matrix, right[:, :, None]], axis=2)
    rows, n = right.shape
    every = np.arange(rows)
    for k in range(n):
        pivot = k + np.argmax(np.abs(a[:, k:, k]), axis=1)
        a[every, pivot], a[:, k] = a[:, k].copy(), a[every, pivot]
        a[:, k] /= a[:, k, k][:, None]
        factors = a[:, :, k].copy()
        factors[:, k] = 0
        a -= factors[:, :, None] * a[:, k][:, None, :]
    return a[:, :, n]


@dataclass(frozen=True)
class Errors:
    """Largest errors in parts of their quantity's largest value; None where there is nothing."""

    position: float | None
    velocity: float | None
    acceleration: float | None
    loads: float | None


def errors(found: Mapping[str, Any], exact: Mapping[str, Any]) -> Errors:
    """Errors of the quantities that were found."""
    groups = (POSITIONS, VELOCITIES, ACCELERATIONS, LOADS)
    return Errors(*(_largest(found, exact, names) for names in groups))


def _largest(
    found: Mapping[str, Any], exact: Mapping[str, Any], names: tuple[str, ...]
) -> float | None:
    present = [name for name in names if name in found and name not in ZERO_COLUMNS]
    if not present:
        return None
    return max(relative_error(found[name], exact[name]) for name in present)


def relative_error(found: Any, exact: Any) -> float:
    """Largest difference in parts of the largest value; angles are not wrapped."""
    return float(np.max(np.abs(found - exact)) / np.max(np.abs(exact)))
