"""The polynomial of a loop of a sphere and three other motions x1 x2 x3 (Pieper 1968).

x2 carries the place y of the sphere after x3 to the place w before x1. A turn keeps its height
along the axis and its distance from a point of the axis, a slide two heights: two equations affine
in (cos, sin) of x1 and of x3, or in (s, s^2). Solved for those of x1, cos^2 + sin^2 = 1, or
s^2 = s s, is of fourth degree in x3.
"""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.mechanism.vectors import Vector, cross, dot, subtract, unit
from mechkin_cli.solver.block_bounds import WITH_SPHERE
from mechkin_cli.solver.loop_chain import Chain, Motion, square_to
from mechkin_cli.solver.real_roots import Trigonometric

Row = tuple[float, float, float]
"""Coefficients of 1, f1, f2: f = (cos, sin) of a turn, (s, s^2) of a slide."""


class Reduced(NamedTuple):
    """The polynomial (in a slide: its coefficients, lowest power first), how regular its derivation
    was (0 to 1), the most assemblies."""

    polynomial: Trigonometric | tuple[float, ...] | None
    regularity: float
    most: int


def with_sphere(motions: tuple[Motion, ...], chain: Chain) -> Reduced | None:
    """The equation of three motions between the sphere's places on the chain's ends."""
    if len(motions) != 3:
        return None
    x1, x2, x3 = motions
    most = WITH_SPHERE[sum(not x.slide for x in motions)]
    before, after = _invariants(x2, x1, chain.first.o), _invariants(x2, x3, chain.second.o)
    options = [(x3, after, x1, before), (x1, before, x3, after)]
    keep = max(options, key=lambda option: _regularity(option[3]))
    regularity = _regularity(keep[3])
    return Reduced(_eliminated(*keep) if regularity > 0.0 else None, regularity, most)


def _invariants(middle: Motion, x: Motion, point: Vector) -> tuple[Row, Row]:
    """What the middle motion keeps of a point moved by x."""
    if middle.slide:
        one = _square_direction(middle.axis)
        other = cross(middle.axis, one)
        return heights(x, point, one), heights(x, point, other)
    return heights(x, point, middle.axis), squares(x, point, middle.point)


def _square_direction(axis: Vector) -> Vector:
    smallest = min(range(3), key=lambda i: abs(axis[i]))
    ground = (float(smallest == 0), float(smallest == 1), float(smallest == 2))
    return unit(square_to(axis, ground))


def _moved(x: Motion, point: Vector) -> tuple[Vector, Vector, Vector]:
    """Y0, Y1, Y2 of the place Y0 + Y1 f1 + Y2 f2."""
    if x.slide:
        return point, x.axis, (0.0, 0.0, 0.0)
    arm = square_to(x.axis, subtract(point, x.point))
    return subtract(point, arm), arm, cross(x.axis, arm)


def heights(x: Motion, point: Vector, direction: Vector) -> Row:
    """The height along a direction of a point moved by x."""
    y0, y1, y2 = _moved(x, point)
    return dot(direction, y0), dot(direction, y1), dot(direction, y2)


def squares(x: Motion, point: Vector, centre: Vector) -> Row:
    """The squared distance of the place from `centre`."""
    y0, y1, y2 = _moved(x, point)
    away = subtract(y0, centre)
    constant, first = dot(away, away), 2.0 * dot(away, y1)
    if x.slide:
        return constant, first, 1.0
    return constant + dot(y1, y1), first, 2.0 * dot(away, y2)


def _determinant(rows: tuple[Row, Row]) -> float:
    return rows[0][1] * rows[1][2] - rows[0][2] * rows[1][1]


def _regularity(rows: tuple[Row, Row]) -> float:
    """How far the equations are from having no solution for f: 0 to 1."""
    sizes = [abs(row[1]) + abs(row[2]) for row in rows]
    return abs(_determinant(rows)) / (sizes[0] * sizes[1]) if min(sizes) > 0.0 else 0.0


def _eliminated(
    kept: Motion, known: tuple[Row, Row], solved: Motion, unknown: tuple[Row, Row]
) -> Trigonometric | tuple[float, ...]:
    """The constraint between f1 and f2 of the motion solved for, in the motion kept: 1 = f1^2 +
    f2^2 of a turn, f2 = f1^2 of a slide."""
    determinant = _determinant(unknown)
    (e, a, b), (f, c, d) = unknown
    p = (known[0][0] - e, *known[0][1:])
    q = (known[1][0] - f, *known[1][1:])
    f1 = [(d * x - b * y) / determinant for x, y in zip(p, q, strict=True)]
    f2 = [(a * y - c * x) / determinant for x, y in zip(p, q, strict=True)]
    if kept.slide:
        first, second = _product(f1, f1), _product(f2, f2)
        if solved.slide:
            return tuple(x - y for x, y in zip(first, (*f2, 0.0, 0.0), strict=True))
        one = (1.0, 0.0, 0.0, 0.0, 0.0)
        return tuple(x + y - z for x, y, z in zip(first, second, one, strict=True))
    cosine, sine = Trigonometric(*f1), Trigonometric(*f2)
    if solved.slide:
        return cosine.times(cosine).plus(sine, -1.0)
    return cosine.times(cosine).plus(sine.times(sine)).plus(Trigonometric(1.0), -1.0)


def _product(p: list[float], q: list[float]) -> tuple[float, ...]:
    """Coefficients of the product of two polynomials of second degree."""
    found = [0.0] * 5
    for i, x in enumerate(p):
        for j, y in enumerate(q):
            found[i + j] += x * y
    return tuple(found)
