"""Links on axes and slides, each placed by an input or by one distance: all assemblies known.

A *body* turns about an axis of its parent, or slides along it, by one coordinate that is 0 in the
drawing. It is driven, or a *rod* keeps the distance of one of its points from a point of a body
that is placed before. With m from the axis's foot to that other point and w to its own, as seen in
the parent, |m - Rot(theta) w|^2 = L^2 is

    A cos(theta) + B sin(theta) = C,     theta = atan2(B, A) + side atan2(sqrt(D), C),
    D = A^2 + B^2 - C^2,

and a slide has s = m.u + side sqrt(D) with D = (m.u)^2 - m.m + L^2. A branch keeps its side as long
as D is positive; a simple zero of D is a dead centre, a double one a branch point. Nothing is
stepped. Planar and spherical four-bars, RSSR, slider-cranks, wheels under rods and bodies on two
legs are made of such bodies.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from random_families.no_wrong_row.field import (
    EXACT,
    Field,
    Vector,
    cross,
    dot,
    minus,
    plus,
    times,
)

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
class Body:
    """A link, or a part of one, with one coordinate about or along the axis in its parent.

    `drive` is the factor of the input; without it the rod places the body.
    """

    name: str
    parent: str
    slides: bool
    foot: Floats
    axis: Floats
    drive: float | None = None
    rod: Rod | None = None


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
        d, rows = minus(point, self.shift), self.turn
        return tuple(  # type: ignore[return-value]
            rows[0][k] * d[0] + rows[1][k] * d[1] + rows[2][k] * d[2] for k in range(3)
        )


@dataclass
class Placed:
    """Coordinates, discriminants in parts of their scale, and poses by body."""

    value: dict[str, Any] = field(default_factory=dict)
    margin: dict[str, Any] = field(default_factory=dict)
    pose: dict[str, Pose] = field(default_factory=dict)


def exact(v: Floats, numbers: Field) -> Vector:
    return tuple(numbers.number(c) for c in v)  # type: ignore[return-value]


class Linkage:
    """Bodies in the order of solution; `size` is the scale of lengths."""

    def __init__(self, bodies: list[Body], size: float) -> None:
        self.bodies, self.size = bodies, size
        self._needs: dict[str, set[str]] = {GROUND: set()}
        for body in bodies:
            before = {body.parent, *([body.rod.other.body] if body.rod else [])}
            self._needs[body.name] = {body.name}.union(*(self._needs[name] for name in before))
        self._carriers = {b.parent for b in bodies} | {b.rod.other.body for b in bodies if b.rod}
        self.side = {body.name: self._side(body) for body in bodies if body.rod}

    def _side(self, body: Body) -> int:
        """The side of the drawn assembly: the sign of d(A cos + B sin)/d(theta) at 0, negative."""
        assert body.rod
        m = minus(body.rod.other.drawn(EXACT), exact(body.foot, EXACT))
        u = exact(body.axis, EXACT)
        w = minus(body.rod.own.drawn(EXACT), exact(body.foot, EXACT))
        slope = dot(minus(m, w), u) if body.slides else dot(m, cross(u, w))
        return -1 if slope > 0 else 1

    def at(self, t: Any, numbers: Field, until: str | None = None) -> Placed:
        """The drawn branch at the input's values t, an array or a number.

        `until`: the coordinate and the margin of that body alone, with what it needs.
        """
        placed = Placed()
        zero, one = numbers.number(0), numbers.number(1)
        unit = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
        placed.pose[GROUND] = Pose(unit, (zero, zero, zero))
        needed = self._needs[until] if until else None
        for body in self.bodies:
            if needed is not None and body.name not in needed:
                continue
            if body.drive is not None:
                value = numbers.number(body.drive) * t
            else:
                value, margin = self._solved(body, placed, numbers)
                placed.margin[body.name] = margin
            placed.value[body.name] = value
            if body.name == until:
                break
            if until is None or body.name in self._carriers:
                placed.pose[body.name] = moved(body, value, placed.pose[body.parent], numbers)
        return placed

    def _solved(self, body: Body, placed: Placed, numbers: Field) -> tuple[Any, Any]:
        rod = body.rod
        assert rod
        u = unit_vector(exact(body.axis, numbers), numbers)
        own, other = rod.own.drawn(numbers), rod.other.drawn(numbers)
        d = minus(own, other)
        square = dot(d, d)
        there = placed.pose[rod.other.body].place(other)
        seen = placed.pose[body.parent].seen(there)
        side, size = self.side[body.name], numbers.number(self.size)
        if body.slides:
            m = minus(seen, own)
            along = dot(m, u)
            D = along * along - dot(m, m) + square
            return along + side * numbers.root(D), D / square
        foot = exact(body.foot, numbers)
        m, w = minus(seen, foot), minus(own, foot)
        a = dot(m, w) - dot(m, u) * dot(w, u)
        b = dot(m, cross(u, w))
        c = (dot(m, m) + dot(w, w) - square) / 2 - dot(m, u) * dot(w, u)
        D = a * a + b * b - c * c
        theta = numbers.atan2(b, a) + side * numbers.atan2(numbers.root(D), c)
        return theta, D / (square * size * size)


def unit_vector(v: Vector, numbers: Field) -> Vector:
    return times(1 / numbers.root(dot(v, v)), v)


def moved(body: Body, value: Any, parent: Pose, numbers: Field) -> Pose:
    """The pose after the body's own displacement, then the parent's."""
    u = unit_vector(exact(body.axis, numbers), numbers)
    if body.slides:
        return Pose(parent.turn, plus(parent.along(times(value, u)), parent.shift))
    foot = exact(body.foot, numbers)
    c, s = numbers.cos(value), numbers.sin(value)
    rows = tuple(
        tuple(
            (c if i == j else 0) + s * cross_matrix(u, i, j) + (1 - c) * u[i] * u[j]
            for j in range(3)
        )
        for i in range(3)
    )
    own = Pose(rows, (0, 0, 0))  # type: ignore[arg-type]
    shift = minus(foot, own.along(foot))
    columns = tuple(parent.along((rows[0][k], rows[1][k], rows[2][k])) for k in range(3))
    turn = tuple((columns[0][i], columns[1][i], columns[2][i]) for i in range(3))
    return Pose(turn, parent.place(shift))  # type: ignore[arg-type]


def cross_matrix(u: Vector, i: int, j: int) -> Any:
    if i == j:
        return 0
    k = 3 - i - j
    return u[k] if (j - i) % 3 == 2 else -u[k]
