"""A platform on six driven legs between spheres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.stress.linkages.moving import Field, vector
from benchmarks.stress.linkages.writing import (
    ACCELERATION,
    RATE,
    document,
    joint,
    number,
    place,
)
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.numbers.vectors import Vector, cross, dot, minus, plus, times
from benchmarks.stress.quantity import Quantity, Rows

LEGS = range(6)
TOOL = "tool"


@dataclass(frozen=True)
class Platform:
    """Feet, heads and the tool as drawn, (mechanisms, 3) each; how far the legs go at the place 1
    (mechanisms, 6), in m."""

    feet: tuple[Rows, ...]
    heads: tuple[Rows, ...]
    tool: Rows
    strokes: Rows
    unknowns: int = 6

    def inputs(self, places: Rows, field: Field) -> list[Series]:
        """The slides of all legs."""
        found = []
        for k in LEGS:
            stroke = self.strokes[:, k : k + 1]
            ones = np.ones(places.shape)
            rates = (field(stroke * rate * ones) for rate in (RATE, ACCELERATION))
            found.append(Series(field(stroke * places), *rates))
        return found

    def gaps(
        self, inputs: Sequence[Number], unknowns: Sequence[Number], field: Field
    ) -> list[Number]:
        """Differences of squared lengths over twice the length as drawn, in sizes."""
        size, found = field(self.size()), []
        for k in LEGS:
            foot, head = vector(field, self.feet[k]), vector(field, self.heads[k])
            drawn = minus(head, foot)
            length = dot(drawn, drawn).sqrt()
            moved = minus(self._moved(head, unknowns, field), foot)
            wanted = length + inputs[k]
            found.append((dot(moved, moved) - wanted * wanted) / (length * size) * 0.5)
        return found

    def _moved(self, point: Vector, unknowns: Sequence[Number], field: Field) -> Vector:
        """By the turn of Cayley's vector w about the tool as drawn, and a shift in sizes: the arm
        becomes a + 2 (w x a + w x (w x a)) / (1 + w.w)."""
        w, shift = tuple(unknowns[:3]), tuple(unknowns[3:])
        tool, size = vector(field, self.tool), field(self.size())
        arm = minus(point, tool)
        first = cross(w, arm)
        turned = plus(first, cross(w, first))
        factor = 2.0 / (dot(w, w) + 1.0)
        return plus(plus(plus(arm, times(factor, turned)), tool), times(size, shift))

    def quantities(self, unknowns: Sequence[Series], field: Field) -> tuple[Quantity, ...]:
        """The tool, and the head of the first leg."""
        found = []
        for name, drawn in ((TOOL, self.tool), ("head", self.heads[0])):
            moved = self._moved(vector(field, drawn), unknowns, field)
            found += [Quantity(name, "length", x, component=k) for k, x in enumerate(moved)]
        return tuple(found)

    def size(self) -> Rows:
        """The diagonal of the box of the drawn points, (mechanisms, 1)."""
        spans = np.ptp(np.stack([*self.feet, *self.heads]), axis=0)
        size: Rows = np.sqrt((spans * spans).sum(axis=1, keepdims=True))
        return size

    def text(self, k: int, name: str, places: Rows) -> str:
        """Mechanism k as a file, driven through the places."""
        links, joints, inputs = ["platform"], {}, []
        for leg in LEGS:
            foot, head = self.feet[leg][k], self.heads[leg][k]
            tube, rod = f"tube{leg + 1}", f"rod{leg + 1}"
            links += [tube, rod]
            joints[f"A{leg + 1}"] = joint("S", ("ground", tube), point=foot)
            along = (f"{number(b)} - ({number(a)})" for a, b in zip(foot, head, strict=True))
            axis = f", axis: [{', '.join(along)}]"
            joints[f"L{leg + 1}"] = joint("P", (tube, rod), point=foot, axis=axis)
            joints[f"B{leg + 1}"] = joint("S", (rod, "platform"), point=head)
            stroke = self.strokes[k, leg]
            listed = ", ".join(number(stroke * p) for p in places)
            inputs.append(
                f"L{leg + 1}.s: {{values: [{listed}], rate: {number(stroke * RATE)}, "
                f"acceleration: {number(stroke * ACCELERATION)}}}"
            )
        points = ", ".join(
            f"{name}: {{link: platform, at: {place(at)}}}"
            for name, at in ((TOOL, self.tool[k]), ("head", self.heads[0][k]))
        )
        sections = f"points: {{{points}}}", f"motion: {{inputs: {{{', '.join(inputs)}}}}}"
        return document(name, links, joints, *sections)
