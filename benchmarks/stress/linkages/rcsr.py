"""R C S R: a crank, a coupler on its cylinder, a rocker; three equations close it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.stress.linkages.moving import Field, turning, vector
from benchmarks.stress.linkages.writing import document, joint, swept
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.numbers.vectors import minus, plus, times, turn, unit
from benchmarks.stress.quantity import Quantity, Rows


@dataclass(frozen=True)
class Rcsr:
    """Points A, B, C, D and axes of A, B and D as drawn, (mechanisms, 3) each."""

    points: tuple[Rows, Rows, Rows, Rows]
    axes: tuple[Rows, Rows, Rows]
    unknowns: int = 3

    def inputs(self, places: Rows, field: Field) -> list[Series]:
        """The crank's angle, of places in degrees."""
        return [turning(field(places))]

    def gaps(
        self, inputs: Sequence[Number], unknowns: Sequence[Number], field: Field
    ) -> list[Number]:
        """Between the sphere of the coupler and that of the rocker."""
        a, b, c, d = (vector(field, p) for p in self.points)
        crank, cylinder, rocker = (unit(vector(field, u)) for u in self.axes)
        angle, advance, swing = unknowns
        size = field(self.size())
        moved = plus(b, turn(cylinder, angle)(minus(c, b)))
        moved = plus(moved, times(advance * size, cylinder))
        moved = plus(a, turn(crank, inputs[0])(minus(moved, a)))
        gap = minus(moved, plus(d, turn(rocker, swing)(minus(c, d))))
        return [x / size for x in gap]

    def quantities(self, unknowns: Sequence[Series], field: Field) -> tuple[Quantity, ...]:
        """The coordinates."""
        angle, advance, swing = unknowns
        return (
            Quantity("B.theta", "angle", angle),
            Quantity("B.s", "length", advance * field(self.size())),
            Quantity("D.theta", "angle", swing),
        )

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.stack(self.points), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file, swept through the degrees."""
        a, b, c, d = (p[k] for p in self.points)
        joints = {
            "A": joint("R", ("ground", "crank"), point=a, axis=self.axes[0][k]),
            "B": joint("C", ("crank", "coupler"), point=b, axis=self.axes[1][k]),
            "C": joint("S", ("coupler", "rocker"), point=c),
            "D": joint("R", ("ground", "rocker"), point=d, axis=self.axes[2][k]),
        }
        return document(name, ("crank", "coupler", "rocker"), joints, swept("A.theta", degrees))
