"""What a linkage is made of: bodies, what places them, and where they are placed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from random_families.no_wrong_row.field import Field, Vector, dot, minus, plus, times

Floats = tuple[float, float, float]
GROUND = "ground"
ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Point:
    """A point of a body as drawn, base + offset: both are written numbers."""

    body: str
    base: Floats
    offset: Floats = ORIGIN

    def drawn(self, numbers: Field) -> Vector:
        return plus(exact(self.base, numbers), exact(self.offset, numbers))


@dataclass(frozen=True)
class Rod:
    """A constant distance, as drawn, between a body's own point and one placed before."""

    own: Point
    other: Point


@dataclass(frozen=True)
class Level:
    """The component along a direction of the body of another body's point, from the axis's foot,
    or of another body's direction, that stays as drawn."""

    own: Floats
    other: Point
    free: bool
    """Whether `other.base` is a direction."""


@dataclass(frozen=True)
class Aim:
    """What of the body has the heading of another body's point or direction; both as drawn."""

    own: Floats
    other: Point
    free: bool


@dataclass(frozen=True)
class Body:
    """A link, or a part of one, with one coordinate about or along the axis in its parent.

    `drive` is the factor of the input; without it the rod or the aim places the body.
    """

    name: str
    parent: str
    slides: bool
    foot: Floats
    axis: Floats
    drive: float | None = None
    rod: Rod | Level | None = None
    aim: Aim | None = None

    @property
    def others(self) -> list[str]:
        """Bodies that it is placed by, its parent left out."""
        return [item.other.body for item in (self.rod, self.aim) if item]


@dataclass
class Pose:
    """x = turn x_drawn + shift."""

    turn: tuple[Vector, Vector, Vector]
    shift: Vector

    def place(self, point: Vector) -> Vector:
        return plus(self.along(point), self.shift)

    def along(self, v: Vector) -> Vector:
        return tuple(dot(row, v) for row in self.turn)  # type: ignore[return-value]

    def seen(self, point: Vector) -> Vector:
        return self.heading(minus(point, self.shift))

    def heading(self, d: Vector) -> Vector:
        rows = self.turn
        return tuple(  # type: ignore[return-value]
            rows[0][k] * d[0] + rows[1][k] * d[1] + rows[2][k] * d[2] for k in range(3)
        )


@dataclass
class Placed:
    """By body: coordinates, discriminants in parts of their scale, what a rounding changes in them
    in roundings, poses, and how far a value of the coordinate misses the condition, in parts."""

    value: dict[str, Any] = field(default_factory=dict)
    margin: dict[str, Any] = field(default_factory=dict)
    blur: dict[str, Any] = field(default_factory=dict)
    pose: dict[str, Pose] = field(default_factory=dict)
    miss: dict[str, Callable[[Any], Any]] = field(default_factory=dict)


def exact(v: Floats, numbers: Field) -> Vector:
    return tuple(numbers.number(c) for c in v)  # type: ignore[return-value]


def unit_vector(v: Vector, numbers: Field) -> Vector:
    return times(1 / numbers.root(dot(v, v)), v)
