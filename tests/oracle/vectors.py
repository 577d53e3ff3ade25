"""Vectors and 3 x 3 matrices as lists, of numbers or of series; rotations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from oracle.numerics import Number, mp
from oracle.series import cosine_sine, reciprocal

Vector = Sequence[Any]
Matrix = Sequence[Sequence[Any]]

IDENTITY = [[mp.mpf(int(i == j)) for j in range(3)] for i in range(3)]


def add(a: Vector, b: Vector) -> list[Any]:
    return [x + y for x, y in zip(a, b, strict=True)]


def subtract(a: Vector, b: Vector) -> list[Any]:
    return [x - y for x, y in zip(a, b, strict=True)]


def scale(a: Vector, factor: Any) -> list[Any]:
    return [x * factor for x in a]


def dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> list[Any]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def norm(a: Vector) -> Number:
    return mp.sqrt(dot(a, a))


def unit(a: Vector) -> list[Number]:
    return scale(a, 1 / norm(a))


def transpose(m: Matrix) -> list[list[Any]]:
    return [list(row) for row in zip(*m, strict=True)]


def apply(m: Matrix, a: Vector) -> list[Any]:
    return [dot(row, a) for row in m]


def product(*matrices: Matrix) -> list[list[Any]]:
    result = [list(row) for row in matrices[0]]
    for m in matrices[1:]:
        columns = transpose(m)
        result = [[dot(row, column) for column in columns] for row in result]
    return result


def skew(a: Vector) -> list[list[Any]]:
    """The matrix of b -> a x b."""
    return [[a[0] * 0, -a[2], a[1]], [a[2], a[0] * 0, -a[0]], [-a[1], a[0], a[0] * 0]]


def axial(m: Matrix) -> list[Any]:
    """The vector of the skew part of a matrix: `axial(skew(a))` is a."""
    half = mp.mpf(1) / 2
    return [(m[2][1] - m[1][2]) * half, (m[0][2] - m[2][0]) * half, (m[1][0] - m[0][1]) * half]


def turn(axis: Vector, angle: Any) -> list[list[Any]]:
    """The rotation by `angle` about the unit vector `axis` (Rodrigues)."""
    c, s = cosine_sine(angle)
    k = skew(axis)
    kk = product(k, k)
    return [[s * k[i][j] + (1 - c) * kk[i][j] + IDENTITY[i][j] for j in range(3)] for i in range(3)]


def cayley(p: Vector) -> list[list[Any]]:
    """The rotation of the Rodrigues parameters p = axis tan(angle/2)."""
    k = skew(p)
    kk = product(k, k)
    factor = reciprocal(dot(p, p) + 1) * 2
    return [[(k[i][j] + kk[i][j]) * factor + IDENTITY[i][j] for j in range(3)] for i in range(3)]


def rodrigues_parameters(rotation: Matrix) -> list[Any]:
    """The inverse of `cayley`: axis tan(angle/2); raises ZeroDivisionError at half a turn."""
    trace = rotation[0][0] + rotation[1][1] + rotation[2][2]
    return scale(axial(rotation), reciprocal(trace + 1) * 2)


def shortest_turn(a: Vector, b: Vector) -> list[list[Number]]:
    """The rotation by the least angle that carries the unit vector `a` onto the unit vector `b`."""
    cosine = dot(a, b)
    if cosine < -1 + mp.mpf(10) ** (-mp.dps // 2):
        raise ValueError("opposite axes: say where the angle is zero")
    k = skew(cross(a, b))
    kk = product(k, k)
    return [
        [IDENTITY[i][j] + k[i][j] + kk[i][j] / (1 + cosine) for j in range(3)] for i in range(3)
    ]


def frame(axis: Vector, towards: Vector) -> list[list[Number]]:
    """The matrix whose columns are x (towards, made normal to the axis), z x x and z = axis."""
    x = unit(subtract(towards, scale(axis, dot(axis, towards))))
    return transpose([x, cross(axis, x), axis])
