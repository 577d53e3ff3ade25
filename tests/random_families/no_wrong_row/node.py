"""A point at three distances from points that are placed before it; legs have laws of the input."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from random_families.no_wrong_row.bodies import (
    GROUND,
    Floats,
    Placed,
    Point,
    Pose,
    exact,
    unit_vector,
)
from random_families.no_wrong_row.field import EXACT, Field, Vector, cross, dot, minus, plus, times


@dataclass(frozen=True)
class Leg:
    """Length as drawn and stroke * sin(turns * input), to another point."""

    other: Point
    stroke: float = 0.0
    turns: int = 1

    def square(self, own: Vector, t: Any, numbers: Field) -> Any:
        d = minus(own, self.other.drawn(numbers))
        length = numbers.root(dot(d, d)) + 0 * t
        if self.stroke:
            length = length + numbers.number(self.stroke) * numbers.sin(self.turns * t)
        return length * length


@dataclass(frozen=True)
class Node:
    """A point with three legs; its coordinates are the values `name.x`, `name.y` and `name.z`."""

    name: str
    drawn: Floats
    rod: tuple[Leg, Leg, Leg]
    size: float = 1.0

    drive = None
    slides = True
    parent = GROUND

    @property
    def others(self) -> list[str]:
        return [leg.other.body for leg in self.rod]

    def solve(self, t: Any, placed: Placed, side: int, numbers: Field) -> Any:
        """Places the point; its discriminant: the squared volume that it spans with its feet."""
        own = exact(self.drawn, numbers)
        feet = [placed.pose[leg.other.body].place(leg.other.drawn(numbers)) for leg in self.rod]
        r1, r2, r3 = (leg.square(own, t, numbers) for leg in self.rod)
        e1, e2, e3, d, i, j = axes(feet, numbers)
        x = (r1 - r2 + d * d) / (2 * d)
        y = (r1 - r3 + i * i + j * j - 2 * i * x) / (2 * j)
        square = r1 - x * x - y * y
        out = plus(times(x, e1), plus(times(y, e2), times(side * numbers.root(square), e3)))
        here = plus(feet[0], out)
        zero, one = numbers.number(0), numbers.number(1)
        unit = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
        placed.pose[self.name] = Pose(unit, minus(here, own))
        for letter, value in zip("xyz", here, strict=True):
            placed.value[f"{self.name}.{letter}"] = value
        return square * (d * j) ** 2 / numbers.number(self.size) ** 6


def axes(feet: list[Vector], numbers: Field) -> tuple[Vector, Vector, Vector, Any, Any, Any]:
    """e1 along the first two feet, e3 normal to their plane; the third at i, j in it."""
    one, two = minus(feet[1], feet[0]), minus(feet[2], feet[0])
    e1, d = unit_vector(one, numbers), numbers.root(dot(one, one))
    i = dot(two, e1)
    rest = minus(two, times(i, e1))
    e2, j = unit_vector(rest, numbers), numbers.root(dot(rest, rest))
    return e1, e2, cross(e1, e2), d, i, j


def drawn_height(node: Node) -> Any:
    """The height over the plane of the feet, as drawn."""
    feet = [leg.other.drawn(EXACT) for leg in node.rod]
    return dot(minus(exact(node.drawn, EXACT), feet[0]), axes(feet, EXACT)[2])
