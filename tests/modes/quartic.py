"""RCSR and R-Sp-R loops at fixed input by closed forms at 40 digits (mpmath).

The sphere's centre turns about the last axis; in RCSR it must keep its distance to the axis of C
(a quartic in tan(theta/2)), in R-Sp-R it must stay in a plane.
"""

from __future__ import annotations

import random
from typing import Any

from mpmath import MPContext

mp = MPContext()
mp.dps = 40

Vector = list[Any]


def vector(rng: random.Random) -> Vector:
    return [mp.mpf(repr(round(rng.uniform(-1, 1), 3))) for _ in range(3)]


def minus(a: Vector, b: Vector) -> Vector:
    return [x - y for x, y in zip(a, b, strict=True)]


def dot(a: Vector, b: Vector) -> Any:
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def circle(point: Vector, axis: Vector, start: Vector) -> tuple[Vector, Vector, Vector]:
    """Centre and two vectors: the place after theta is c + cos(theta) u + sin(theta) v."""
    length = mp.sqrt(dot(axis, axis))
    z = [x / length for x in axis]
    arm = minus(start, point)
    along = dot(arm, z)
    u = [x - along * y for x, y in zip(arm, z, strict=True)]
    centre = minus(start, u)
    return centre, u, cross(z, u)


def polynomial(centre: Vector, u: Vector, v: Vector) -> list[list[Any]]:
    """(1 + t^2) times each coordinate of the circle as a polynomial in t, highest power first."""
    return [[c - a, 2 * b, c + a] for c, a, b in zip(centre, u, v, strict=True)]


def product(p: list[Any], q: list[Any]) -> list[Any]:
    out = [mp.mpf(0)] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            out[i + j] += x * y
    return out


def angles(coefficients: list[Any]) -> list[Any]:
    """2 atan(t) of the real roots, sorted."""
    roots = mp.polyroots(coefficients[::-1], maxsteps=500, extraprec=400, asc=True)
    return sorted(2 * mp.atan(mp.re(r)) for r in roots if abs(mp.im(r)) < mp.mpf(10) ** -15)


def cylinder_angles(
    point: Vector, axis: Vector, radius_point: Vector, path: tuple[Vector, Vector, Vector]
) -> list[Any]:
    """Angles at which the circle meets the cylinder about an axis through `radius_point`."""
    length = mp.sqrt(dot(axis, axis))
    a = [x / length for x in axis]
    arm = cross(a, minus(radius_point, point))
    x, y, z = polynomial(minus(path[0], point), path[1], path[2])
    crossed = [
        [a[1] * k - a[2] * j for j, k in zip(y, z, strict=True)],
        [a[2] * i - a[0] * k for i, k in zip(x, z, strict=True)],
        [a[0] * j - a[1] * i for i, j in zip(x, y, strict=True)],
    ]
    weight = product([1, 0, 1], [1, 0, 1])
    squares = [product(c, c) for c in crossed]
    return angles([mp.fsum(s) - dot(arm, arm) * w for *s, w in zip(*squares, weight, strict=True)])


def plane_angles(contact: Vector, normal: Vector, path: tuple[Vector, Vector, Vector]) -> list[Any]:
    """Angles at which the circle meets a plane."""
    coordinates = polynomial(minus(path[0], contact), path[1], path[2])
    return angles([dot(normal, list(c)) for c in zip(*coordinates, strict=True)])
