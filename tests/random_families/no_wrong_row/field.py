"""Two kinds of numbers for one formula: float64 over many places, and 60 digits at one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from oracle.numerics import mp

Vector = tuple[Any, Any, Any]


class Field(NamedTuple):
    """Functions of one kind of numbers; `root` of what is not positive is 0."""

    number: Callable[[float], Any]
    cos: Callable[[Any], Any]
    sin: Callable[[Any], Any]
    root: Callable[[Any], Any]
    atan2: Callable[[Any, Any], Any]


FAST = Field(float, np.cos, np.sin, lambda x: np.sqrt(np.maximum(x, 0.0)), np.arctan2)
EXACT = Field(mp.mpf, mp.cos, mp.sin, lambda x: mp.sqrt(x) if x > 0 else mp.zero, mp.atan2)


def plus(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(factor: Any, a: Vector) -> Vector:
    return factor * a[0], factor * a[1], factor * a[2]


def dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )
