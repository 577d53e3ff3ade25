"""Vectors of three floats as tuples, in a fixed order of operations so that bits are the same
everywhere."""

from __future__ import annotations

from mechkin_cli.tape.scalars import by_rounding, either, largest, nonzero, square_root
from mechkin_cli.tolerances import UNIT_SQUARE

Vector = tuple[float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)


def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(s: float, a: Vector) -> Vector:
    """s a."""
    return (s * a[0], s * a[1], s * a[2])


def dot(a: Vector, b: Vector) -> float:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a: Vector) -> float:
    """Length of a; scaled first, so that neither tiny nor huge vectors lose it."""
    longest = largest(abs(a[0]), abs(a[1]), abs(a[2]))
    b = scale(1.0 / nonzero(longest), a)
    return longest * square_root(dot(b, b))


def unit(a: Vector) -> Vector:
    """a / |a|; a vector that is a unit vector to rounding comes back unchanged.

    Raises:
        ZeroDivisionError: a is zero.
    """
    square = dot(a, a)
    as_given = by_rounding(abs(square - 1.0) <= UNIT_SQUARE)
    return either(as_given, lambda: a, lambda: _shortened(a))


def _shortened(a: Vector) -> Vector:
    longest = largest(abs(a[0]), abs(a[1]), abs(a[2]))
    b = (a[0] / longest, a[1] / longest, a[2] / longest)
    length = square_root(dot(b, b))
    return (b[0] / length, b[1] / length, b[2] / length)
