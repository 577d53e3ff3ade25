"""The loop of seven revolutes, closed at its fourth link, which either half of it carries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.stress.linkages.moving import Field, turning, vector
from benchmarks.stress.linkages.writing import document, joint, swept
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.numbers.vectors import Vector, cross, minus, plus, turn, unit
from benchmarks.stress.quantity import Quantity, Rows

JOINTS = "ABCDEFG"
FIRST = 4
"""Joints of the half that begins with the input."""
X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
Placed = tuple[Vector, Vector, Vector]
"""Where two directions and a point of a link are."""


@dataclass(frozen=True)
class SevenR:
    """Points and axes of all joints as drawn, (mechanisms, 3) each."""

    points: tuple[Rows, ...]
    axes: tuple[Rows, ...]
    unknowns: int = 6

    def inputs(self, places: Rows, field: Field) -> list[Series]:
        """The crank's angle, of places in degrees."""
        return [turning(field(places))]

    def gaps(
        self, inputs: Sequence[Number], unknowns: Sequence[Number], field: Field
    ) -> list[Number]:
        """The turn between both places of the link, in rad, and their distance in sizes."""
        angles = [*inputs, *unknowns]
        one = self._placed(angles, range(FIRST - 1, -1, -1), field)
        two = self._placed([-x for x in angles], range(FIRST, len(JOINTS)), field)
        x, y, point = zip(one, two, strict=True)
        z = cross(x[0], y[0]), cross(x[1], y[1])
        turned = plus(plus(cross(*x), cross(*y)), cross(*z))
        size = field(self.size())
        return [*(t * 0.5 for t in turned), *(s / size for s in minus(*point))]

    def _placed(self, angles: Sequence[Number], order: Sequence[int], field: Field) -> Placed:
        """The fourth link, turned about joints one after the other."""
        ones = np.ones((len(self.points[0]), 1))
        x, y = (vector(field, ones * np.array([d])) for d in (X, Y))
        point = vector(field, self.points[FIRST])
        for k in order:
            about = turn(unit(vector(field, self.axes[k])), angles[k])
            foot = vector(field, self.points[k])
            x, y, point = about(x), about(y), plus(foot, about(minus(point, foot)))
        return x, y, point

    def quantities(self, unknowns: Sequence[Series], field: Field) -> tuple[Quantity, ...]:
        """The coordinates."""
        return tuple(
            Quantity(f"{name}.theta", "angle", q)
            for name, q in zip(JOINTS[1:], unknowns, strict=True)
        )

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.stack(self.points), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def text(self, k: int, name: str, degrees: Rows) -> str:
        """Mechanism k as a file, swept through the degrees."""
        links = [f"link{n}" for n in range(1, len(JOINTS))]
        ends = zip(("ground", *links), (*links, "ground"), strict=True)
        joints = {
            letter: joint("R", pair, point=point[k], axis=axis[k])
            for letter, pair, point, axis in zip(JOINTS, ends, self.points, self.axes, strict=True)
        }
        return document(name, links, joints, swept("A.theta", degrees))
