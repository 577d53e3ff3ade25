"""Displacements as 4x4 matrices and their derivatives by operator matrices (Uicker, Denavit,
Hartenberg 1964).

A turn theta about a line and a slide s along it has the matrix M(theta, s); its derivatives are
dM/dtheta = D M and dM/ds = S M with the constant operators D (angular part [a]x) and S of the line,
which commute with M and with each other. Entries are numbers of any kind or arrays over the rows.
"""

from __future__ import annotations

from typing import Any

from benchmark.arithmetic import Arithmetic

Matrix = list[list[Any]]
Vector = list[Any]


def product(a: Matrix, b: Matrix) -> Matrix:
    """a b."""
    return [[_sum([x * b[k][j] for k, x in enumerate(row)]) for j in range(len(b[0]))] for row in a]


def plus(a: Matrix, b: Matrix) -> Matrix:
    """a + b."""
    return [[x + y for x, y in zip(*rows, strict=True)] for rows in zip(a, b, strict=True)]


def times(factor: Any, a: Matrix) -> Matrix:
    """factor a."""
    return [[factor * x for x in row] for row in a]


def image(a: Matrix, point: Vector) -> Vector:
    """Where a 4x4 matrix takes a point (of a derivative: the derivative of that place)."""
    return [_sum([*(row[k] * point[k] for k in range(3)), row[3]]) for row in a[:3]]


def rotation(a: Matrix) -> Matrix:
    """The upper left 3x3 part."""
    return [row[:3] for row in a[:3]]


def transpose(a: Matrix) -> Matrix:
    """The transpose."""
    return [list(column) for column in zip(*a, strict=True)]


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    x, y, z = a
    u, v, w = b
    return [y * w - z * v, z * u - x * w, x * v - y * u]


def dot(a: Vector, b: Vector) -> Any:
    """a . b."""
    return _sum([x * y for x, y in zip(a, b, strict=True)])


def skew(a: Vector) -> Matrix:
    """The 3x3 matrix of a x."""
    x, y, z = a
    zero = 0 * x
    return [[zero, -z, y], [z, zero, -x], [-y, x, zero]]


def turning(axis: Vector, point: Vector) -> Matrix:
    """The operator D of a turn about the line through `point` along the unit vector `axis`."""
    lever = cross(point, axis)
    zero = 0 * axis[0]
    return [[*row, lever[i]] for i, row in enumerate(skew(axis))] + [[zero] * 4]


def sliding(axis: Vector) -> Matrix:
    """The operator S of a slide along the unit vector `axis`."""
    zero = 0 * axis[0]
    return [[zero, zero, zero, a] for a in axis] + [[zero] * 4]


def displacement(axis: Vector, point: Vector, theta: Any, s: Any, arithmetic: Arithmetic) -> Matrix:
    """M(theta, s) for the line through `point` along the unit vector `axis` (Rodrigues)."""
    c, n = arithmetic.cos(theta), arithmetic.sin(theta)
    turn = [
        [c * (i == j) + (1 - c) * (axis[i] * axis[j]) + n * entry for j, entry in enumerate(row)]
        for i, row in enumerate(skew(axis))
    ]
    moved = [dot(row, point) for row in turn]
    rows = [[*turn[i], point[i] - moved[i] + s * axis[i]] for i in range(3)]
    return [*rows, [0 * c, 0 * c, 0 * c, 0 * c + 1]]


def solve_three(columns: list[Vector], right: Vector) -> Vector:
    """x with x0 columns[0] + x1 columns[1] + x2 columns[2] = right, by Cramer's rule."""
    a, b, c = columns
    determinant = dot(a, cross(b, c))
    return [
        dot(right, cross(b, c)) / determinant,
        dot(a, cross(right, c)) / determinant,
        dot(a, cross(b, right)) / determinant,
    ]


def _sum(terms: list[Any]) -> Any:
    total = terms[0]
    for term in terms[1:]:
        total = total + term
    return total
