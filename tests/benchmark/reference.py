"""The solution of RCSR that errors are measured against.

Quantities by name: `O2.theta` ... with `_dot` and `_ddot`, `O1.effort`, `J.force`, `J.moment`;
arrays over the rows, vectors (rows, 3), in m, rad, N and N m.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from benchmark.arithmetic import Arithmetic, extended
from benchmark.closure import Drawing, Kinematics, drawing, kinematics
from benchmark.dense_forces import equations, wrenches

from benchmarks.rcsr import COORDINATES, Dimensions
from mechkin_cli.tape.double_double import eliminate

POSITIONS = COORDINATES
VELOCITIES = tuple(f"{name}_dot" for name in COORDINATES)
ACCELERATIONS = tuple(f"{name}_ddot" for name in COORDINATES)


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
