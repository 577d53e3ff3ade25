"""A spindle turns, its nut slides and drives a rocker by a rod: H and P on one line, then S S R."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.stress.linkages.moving import Field, vector
from benchmarks.stress.linkages.writing import decimals, document, joint, number, swept
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.numbers.vectors import Swing, dot, minus, plus, swing, times, unit
from benchmarks.stress.quantity import Quantity, Rows
from benchmarks.stress.reach import TURN


@dataclass(frozen=True)
class Screw:
    """Points of the nut's end B, the rocker's end C and its foot D, (mechanisms, 3); the axes of
    spindle and rocker; leads (mechanisms, 1) in m per turn."""

    points: tuple[Rows, Rows, Rows]
    axes: tuple[Rows, Rows]
    leads: Rows
    field: Field = DoubleDouble

    def advance(self, angle: Number) -> Number:
        """Of the nut, which does not turn, at the spindle's angle in rad."""
        return -(angle * self.field(self.leads) / TURN)

    def swing(self, advance: Number) -> Swing:
        """Of the rocker."""
        b, c, d = (vector(self.field, p) for p in self.points)
        way, rocker = (unit(vector(self.field, u)) for u in self.axes)
        rod = minus(c, b)
        target = minus(plus(b, times(advance, way)), d)
        return swing(rocker, minus(c, d), target, dot(rod, rod))

    def sign(self) -> Rows:
        """Of the drawing's assembly, (mechanisms, 1)."""
        home = self.swing(DoubleDouble(np.zeros((len(self.points[0]), 1))))
        return np.where(home.b.high > 0.0, -1.0, 1.0)

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """The coordinates at angles of the input in rad."""
        advance, sign = self.advance(angle), self.sign()
        found = self.swing(advance)
        sine, cosine = found.sine_cosine(sign)
        away_sine, away_cosine = found.sine_cosine(-sign)
        other = away_sine.number.arctan2(away_cosine.number)
        return (
            Quantity("P.s", "length", advance),
            Quantity("H.theta", "whole turns", -angle),
            Quantity("D.theta", "angle", sine.arctan2(cosine), other),
        )

    def as_written(self) -> Screw:
        """The same of the numbers that its files say, in place of their doubles."""
        return replace(self, field=decimals)

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.stack(self.points), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file, swept through the degrees."""
        b, c, d = (p[k] for p in self.points)
        way = self.axes[0][k]
        lead = f", axis: [{', '.join(map(number, way))}], lead: {number(self.leads[k, 0])}"
        joints = {
            "A": joint("R", ("ground", "spindle"), point=b, axis=way),
            "H": joint("H", ("spindle", "nut"), point=b, axis=lead),
            "P": joint("P", ("ground", "nut"), point=b, axis=way),
            "B": joint("S", ("nut", "rod"), point=b),
            "C": joint("S", ("rod", "rocker"), point=c),
            "D": joint("R", ("ground", "rocker"), point=d, axis=self.axes[1][k]),
        }
        motion = swept("A.theta", degrees)
        return document(name, ("spindle", "nut", "rod", "rocker"), joints, motion)
