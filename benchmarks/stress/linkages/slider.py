"""R S S P: a crank, a rod and a slide; closed by a quadratic."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.stress.linkages.moving import Field, vector
from benchmarks.stress.linkages.writing import decimals, document, joint, swept
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Number
from benchmarks.stress.numbers.vectors import (
    ROUNDINGS,
    dot,
    minus,
    plus,
    slide,
    turn,
    unit,
)
from benchmarks.stress.quantity import Quantity, Rows
from benchmarks.stress.reach import Margin


@dataclass(frozen=True)
class Slider:
    """Points A, B, C and axes of the crank and the slide as drawn, (mechanisms, 3) each."""

    points: tuple[Rows, Rows, Rows]
    axes: tuple[Rows, Rows]
    field: Field = DoubleDouble

    def _slide(self, angle: Number) -> tuple[Number, Number, Number]:
        """Middle and discriminant of the slide, and the square of the rod."""
        a, b, c = (vector(self.field, p) for p in self.points)
        crank, way = (unit(vector(self.field, u)) for u in self.axes)
        end = plus(a, turn(crank, angle)(minus(b, a)))
        rod = minus(c, b)
        square = dot(rod, rod)
        return *slide(way, c, end, square), square

    def margin(self, angle: Number) -> Margin:
        """The discriminant at the crank's angle in rad."""
        middle, discriminant, square = self._slide(angle)
        rod = np.sqrt(square.high)
        across = np.sqrt(np.maximum(square.high - discriminant.number.high, 0.0))
        far = rod + across + np.abs(middle.number.high)
        return Margin(discriminant, ROUNDINGS * far * (rod + across))

    def sign(self) -> Rows:
        """Of the drawing's assembly, (mechanisms, 1)."""
        middle, *_ = self._slide(DoubleDouble(np.zeros((len(self.points[0]), 1))))
        return np.where(middle.high > 0.0, -1.0, 1.0)

    def quantities(self, angle: Number) -> tuple[Quantity, ...]:
        """The coordinates at angles of the input in rad."""
        middle, discriminant, _ = self._slide(angle)
        root = discriminant.sqrt() * self.sign()
        other = middle.number - root.number
        return (Quantity("P.s", "length", middle + root, other),)

    def as_written(self) -> Slider:
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
        links: Iterable[str] | Mapping[str, str] = ("crank", "rod", "slider"),
    ) -> str:
        """Mechanism k as a file, swept through the degrees; `sections` follow. `links` may have
        their texts."""
        a, b, c = (p[k] for p in self.points)
        joints = {
            "A": joint("R", ("ground", "crank"), point=a, axis=self.axes[0][k]),
            "B": joint("S", ("crank", "rod"), point=b),
            "C": joint("S", ("rod", "slider"), point=c),
            "P": joint("P", ("ground", "slider"), point=c, axis=self.axes[1][k]),
        }
        motion = swept("A.theta", degrees)
        return document(name, links, joints, motion, *sections)
