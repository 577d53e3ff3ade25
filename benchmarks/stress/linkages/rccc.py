"""R C C C: the axes' directions are a spherical four-bar, the slides follow linearly.

The spherical four-bar is an R S S R of the tips of unit axes about one centre, closed by the same
half-angles.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.stress.linkages.moving import Field, vector
from benchmarks.stress.linkages.writing import decimals, document, joint, swept
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.numbers.vectors import (
    Swing,
    Turn,
    Vector,
    angle_about,
    cross,
    dot,
    minus,
    plus,
    swing,
    turn,
    unit,
)
from benchmarks.stress.quantity import Quantity, Rows
from benchmarks.stress.reach import Margin

Four = tuple[Rows, Rows, Rows, Rows]


@dataclass(frozen=True)
class Rccc:
    """Points and axes of A, B, C, D as drawn, (mechanisms, 3) each."""

    points: Four
    axes: Four
    field: Field = DoubleDouble

    def _directions(self) -> tuple[Vector, Vector, Vector, Vector]:
        one, two, three, four = (unit(vector(self.field, u)) for u in self.axes)
        return one, two, three, four

    def swing(self, angle: Number) -> Swing:
        """Of the axis C about D, at the crank's angle in rad."""
        one, two, three, four = self._directions()
        # differences of directions, so that axes next to each other keep their digits
        coupler = minus(three, two)
        target = minus(plus(one, turn(one, angle)(minus(two, one))), four)
        return swing(four, minus(three, four), target, dot(coupler, coupler))

    def margin(self, angle: Number) -> Margin:
        """The discriminant at the crank's angle in rad."""
        found = self.swing(angle)
        # rounding of directions is that of unit vectors, however near they are to each other
        ones = self.field(np.ones_like(found.far.number.high))
        return Margin(found.discriminant, found._replace(far=ones).blur())

    def sign(self) -> Rows:
        """Of the drawing's assembly, (mechanisms, 1)."""
        home = self.swing(DoubleDouble(np.zeros((len(self.points[0]), 1))))
        return np.where(home.b.high > 0.0, -1.0, 1.0)

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """The coordinates at angles of the input in rad."""
        one, two, three, four = self._directions()
        found, sign = self.swing(angle), self.sign()
        crank = turn(one, angle)
        sine, cosine = found.sine_cosine(sign)
        rocker = Turn(four, sine, cosine)
        away_sine, away_cosine = found.sine_cosine(-sign)
        other = away_sine.number.arctan2(away_cosine.number)
        second = angle_about(two, minus(three, two), minus(crank.back(rocker(three)), two))
        third = -angle_about(three, minus(two, three), minus(rocker.back(crank(two)), three))
        slides = self._slides(crank, turn(two, second), rocker)
        return (
            Quantity("B.theta", "angle", second),
            Quantity("C.theta", "angle", third),
            Quantity("D.theta", "angle", sine.arctan2(cosine), other),
            *(Quantity(f"{j}.s", "length", s) for j, s in zip("BCD", slides, strict=True)),
        )

    def _slides(self, crank: Turn, coupler: Turn, rocker: Turn) -> Vector:
        """Along the axes of B, C and D (Cramer's rule)."""
        _, two, three, four = self._directions()
        a, b, c, d = (vector(self.field, p) for p in self.points)
        along_two, along_three = crank(two), rocker(three)
        by_crank = plus(plus(a, crank(minus(b, a))), crank(coupler(minus(c, b))))
        gap = minus(plus(d, rocker(minus(c, d))), by_crank)
        # s2 u2 + s3 u3 - s4 u4 = gap
        normal = cross(along_two, along_three)
        volume = dot(normal, four)
        return (
            dot(gap, cross(along_three, four)) / volume,
            dot(gap, cross(four, along_two)) / volume,
            -(dot(gap, normal) / volume),
        )

    def as_written(self) -> Rccc:
        """The same of the numbers that its files say, in place of their doubles."""
        return replace(self, field=decimals)

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.stack(self.points), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file, swept through the degrees."""
        links = {"A": ("ground", "crank"), "B": ("crank", "coupler"), "C": ("coupler", "rocker")}
        links["D"] = ("ground", "rocker")
        joints = {
            name: joint("R" if name == "A" else "C", pair, point=point[k], axis=axis[k])
            for (name, pair), point, axis in zip(links.items(), self.points, self.axes, strict=True)
        }
        motion = swept("A.theta", degrees)
        return document(name, ("crank", "coupler", "rocker"), joints, motion)
