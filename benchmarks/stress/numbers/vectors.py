"""Vectors of three numbers, and the closed forms that place one link after another."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.stress.numbers.series import Number
from benchmarks.stress.quantity import Rows

Vector = tuple[Number, Number, Number]


def plus(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(factor: Number, a: Vector) -> Vector:
    """factor a."""
    return factor * a[0], factor * a[1], factor * a[2]


def dot(a: Vector, b: Vector) -> Number:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """The vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a: Vector) -> Vector:
    """a over its length."""
    length = dot(a, a).sqrt()
    return a[0] / length, a[1] / length, a[2] / length


class Turn(NamedTuple):
    """About a unit axis through the origin, by sine and cosine."""

    axis: Vector
    sine: Number
    cosine: Number

    def __call__(self, a: Vector) -> Vector:
        """Rodrigues' formula by the part across the axis, so that small arms keep their digits."""
        along = times(dot(self.axis, a), self.axis)
        across = minus(a, along)
        turned = plus(times(self.cosine, across), times(self.sine, cross(self.axis, a)))
        return plus(along, turned)

    @property
    def back(self) -> Turn:
        """The opposite one."""
        return Turn(self.axis, -self.sine, self.cosine)


def turn(axis: Vector, angle: Number) -> Turn:
    """The turn by rad about a unit axis."""
    return Turn(axis, *angle.sin_cos())


def angle_about(axis: Vector, start: Vector, end: Vector) -> Number:
    """The angle about a unit axis from one direction to another, in (-pi, pi]."""
    first = minus(start, times(dot(axis, start), axis))
    last = minus(end, times(dot(axis, end), axis))
    return dot(axis, cross(first, last)).arctan2(dot(first, last))


ROUNDINGS = 64.0 * 2.0**-53
"""Of coordinates, in parts of the largest: what rounding leaves of a linkage's numbers."""


class Swing(NamedTuple):
    """Where a point on a circle is at a given distance from a target.

    With p the target from the circle's centre and the point at along + c cos(t) + s sin(t), these
    are the roots of a cos(t) + b sin(t) = d, one for either sign of the root of the discriminant
    (radius - d)(radius + d), radius^2 = a^2 + b^2; `square` is that of the distance, `far` the size
    of the vectors that the equation is made of.
    """

    a: Number
    b: Number
    d: Number
    radius: Number
    square: Number
    far: Number

    @property
    def discriminant(self) -> Number:
        """By factors, which keep the digits that squares lose next to a dead centre."""
        return (self.radius - self.d) * (self.radius + self.d)

    def sine_cosine(self, sign: Number) -> tuple[Number, Number]:
        """Of the root whose discriminant's root has the sign."""
        root = self.discriminant.sqrt() * sign
        scale = self.radius * self.radius
        sine = (self.b * self.d + self.a * root) / scale
        return sine, (self.a * self.d - self.b * root) / scale

    def blur(self) -> Rows:
        """What rounding of coordinates may change the discriminant by.

        radius - d is half the rod's square less that of the least distance, radius + d half that
        of the largest distance less the rod's; a coordinate's rounding changes a square by the
        length times it.
        """
        radius, d, square, far = (
            np.abs(item.number.high) for item in (self.radius, self.d, self.square, self.far)
        )
        near_gap = (self.radius - self.d).number.high
        far_gap = (self.radius + self.d).number.high
        rod = np.sqrt(square)
        least = np.sqrt(np.maximum(square - 2.0 * near_gap, 0.0))
        largest = np.sqrt(np.maximum(square + 2.0 * far_gap, 0.0))
        miss = ROUNDINGS * far
        changed = (rod + least) * np.abs(far_gap) + (rod + largest) * np.abs(near_gap)
        return np.asarray(miss * (changed + miss * (radius + d)))


def swing(axis: Vector, arm: Vector, target: Vector, square: Number) -> Swing:
    """For an arm about an axis through the origin; `square` is that of the distance."""
    along = times(dot(axis, arm), axis)
    a = dot(target, minus(arm, along))
    b = dot(target, cross(axis, arm))
    d = (dot(arm, arm) + dot(target, target) - square) * 0.5 - dot(target, along)
    far = dot(arm, arm).sqrt() + dot(target, target).sqrt()
    return Swing(a, b, d, (a * a + b * b).sqrt(), square, far)


def slide(
    direction: Vector, start: Vector, target: Vector, square: Number
) -> tuple[Number, Number]:
    """Middle s and discriminant of |start + s direction - target|^2 = square, |direction| = 1."""
    gap = minus(target, start)
    middle = dot(gap, direction)
    across = minus(gap, times(middle, direction))
    return middle, square - dot(across, across)
