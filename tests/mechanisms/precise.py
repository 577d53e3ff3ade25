"""Closed forms at 40 digits: functions of time to values and two derivatives, over all rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from mpmath import MPContext

mp = MPContext()
mp.dps = 60  # derivatives by differences lose a third of the digits

Number = Any
Vector = list[Number]
DEGREE = mp.pi / 180


def course(value: str | float, rate: Any = 0, acceleration: Any = 0) -> Callable[[Number], Number]:
    """An input over time from its row's value, rate and acceleration."""
    first, second = mp.mpf(rate), mp.mpf(acceleration) / 2
    return lambda t: value + first * t + second * t * t


def rows(functions: Sequence[Callable[[Number], Number]]) -> tuple[np.ndarray, ...]:
    """Value, rate and acceleration at time 0 of one function per row, each (rows,)."""
    series = [mp.taylor(function, 0, 2) for function in functions]
    return tuple(np.array([float(mp.factorial(k) * s[k]) for s in series]) for k in range(3))


def vector(*components: Any) -> Vector:
    return [mp.mpf(c) for c in components]


def dot(a: Vector, b: Vector) -> Number:
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def unit(a: Vector) -> Vector:
    length = mp.sqrt(dot(a, a))
    return [x / length for x in a]


def plus(a: Vector, b: Vector, factor: Number = 1) -> Vector:
    return [x + factor * y for x, y in zip(a, b, strict=True)]


def turned(a: Vector, axis: Vector, angle: Number) -> Vector:
    """A vector turned about a unit axis through the origin (Rodrigues)."""
    c, s = mp.cos(angle), mp.sin(angle)
    along, across = dot(a, axis) * (1 - c), cross(axis, a)
    return [c * x + s * y + along * z for x, y, z in zip(a, across, axis, strict=True)]
