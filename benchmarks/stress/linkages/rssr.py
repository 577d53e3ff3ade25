"""R S S R: two turning arms and a rod; closed by half-angles.

A.theta is the input; D.theta has two roots, one for each sign of the discriminant's root.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.stress.linkages.moving import Field, vector
from benchmarks.stress.linkages.writing import decimals, document, joint, swept
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.numbers.vectors import Swing, dot, minus, plus, swing, turn, unit
from benchmarks.stress.quantity import Quantity, Rows
from benchmarks.stress.reach import Margin


@dataclass(frozen=True)
class Rssr:
    """Points A, B, C, D and axes of A and D as drawn, (mechanisms, 3) each."""

    points: tuple[Rows, Rows, Rows, Rows]
    axes: tuple[Rows, Rows]
    assembly: Rows | float = 1.0
    """1 for that of the drawing, -1 for the other one (mechanisms, 1)."""
    field: Field = DoubleDouble

    def swing(self, angle: Number) -> Swing:
        """Of the rocker, at the crank's angle in rad."""
        a, b, c, d = (vector(self.field, p) for p in self.points)
        crank, rocker = (unit(vector(self.field, u)) for u in self.axes)
        end = plus(a, turn(crank, angle)(minus(b, a)))
        rod = minus(c, b)
        return swing(rocker, minus(c, d), minus(end, d), dot(rod, rod))

    def margin(self, angle: Number) -> Margin:
        """The discriminant at the crank's angle in rad."""
        found = self.swing(angle)
        return Margin(found.discriminant, found.blur())

    def sign(self) -> Rows:
        """Of the discriminant's root, (mechanisms, 1)."""
        home = self.swing(DoubleDouble(np.zeros((len(self.points[0]), 1))))
        return np.where(home.b.high > 0.0, -1.0, 1.0) * self.assembly

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """The coordinates at angles of the input in rad."""
        found, sign = self.swing(angle), self.sign()
        sine, cosine = found.sine_cosine(sign)
        away_sine, away_cosine = found.sine_cosine(-sign)
        other = away_sine.number.arctan2(away_cosine.number)
        return (Quantity("D.theta", "angle", sine.arctan2(cosine), other),)

    def as_written(self) -> Rssr:
        """The same of the numbers that its files say, in place of their doubles."""
        return replace(self, field=decimals)

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.stack(self.points), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def text(
        self,
        k: int,
        name: str,
        degrees: Rows,
        *sections: str,
        links: Iterable[str] | Mapping[str, str] = ("crank", "rod", "rocker"),
    ) -> str:
        """Mechanism k as a file, swept through the degrees; `sections` follow. `links` may have
        their texts."""
        a, b, c, d = (p[k] for p in self.points)
        joints = {
            "A": joint("R", ("ground", "crank"), point=a, axis=self.axes[0][k]),
            "B": joint("S", ("crank", "rod"), point=b),
            "C": joint("S", ("rod", "rocker"), point=c),
            "D": joint("R", ("ground", "rocker"), point=d, axis=self.axes[1][k]),
        }
        motion = swept("A.theta", degrees)
        return document(name, links, joints, motion, *sections)
