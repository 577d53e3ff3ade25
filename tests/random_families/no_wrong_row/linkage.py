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

Two more conditions serve arms and shafts. A *level* keeps n.m, of a direction n of the body with a
point or a direction m of another one: A cos + B sin = C again, with D zero where m comes to the
axis. An *aim* turns a body until one of its directions has the heading of another one about the
axis: theta = atan2(B, A), and nothing to choose. A node (`node.py`) is
a point at three given distances from others.
"""

from __future__ import annotations

from typing import Any

from random_families.no_wrong_row.bodies import (
    GROUND,
    ORIGIN,
    Aim,
    Body,
    Level,
    Placed,
    Pose,
    Rod,
    exact,
    unit_vector,
)
from random_families.no_wrong_row.field import EXACT, Field, Vector, cross, dot, minus, plus, times
from random_families.no_wrong_row.node import Node, drawn_height


class Linkage:
    """Bodies in the order of solution; `size` is the scale of lengths."""

    def __init__(self, bodies: list[Body | Node], size: float) -> None:
        self.bodies, self.size = bodies, size
        self._needs: dict[str, set[str]] = {GROUND: set()}
        for body in bodies:
            before = {body.parent, *body.others}
            self._needs[body.name] = {body.name}.union(*(self._needs[name] for name in before))
        self._carriers = {b.parent for b in bodies}.union(*(b.others for b in bodies))
        self.side = {body.name: self._side(body) for body in bodies if body.rod}

    def turns(self, name: str) -> bool:
        """Whether a body's coordinate is an angle."""
        return any(body.name == name and not body.slides for body in self.bodies)

    def _side(self, body: Body | Node) -> int:
        """The side of the drawn assembly: the sign of d(A cos + B sin)/d(theta) at 0, negative."""
        if isinstance(body, Node):
            return 1 if drawn_height(body) > 0 else -1
        assert body.rod
        m = drawn_target(body, body.rod, EXACT)
        u = exact(body.axis, EXACT)
        if isinstance(body.rod, Level):
            return -1 if dot(m, cross(u, exact(body.rod.own, EXACT))) > 0 else 1
        w = minus(body.rod.own.drawn(EXACT), exact(body.foot, EXACT))
        slope = dot(minus(m, w), u) if body.slides else dot(m, cross(u, w))
        return -1 if slope > 0 else 1

    def at(
        self, t: Any, numbers: Field, until: str | None = None, held: dict[str, Any] | None = None
    ) -> Placed:
        """The drawn branch at the input's values t, an array or a number.

        `until`: the coordinate and the margin of that body alone, with what it needs. `held`:
        coordinates that are given instead of solved for.
        """
        placed = Placed()
        zero, one = numbers.number(0), numbers.number(1)
        unit = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
        placed.pose[GROUND] = Pose(unit, (zero, zero, zero))
        needed = self._needs[until] if until else None
        for body in self.bodies:
            if needed is not None and body.name not in needed:
                continue
            if isinstance(body, Node):
                placed.margin[body.name] = body.solve(t, placed, self.side[body.name], numbers)
                continue
            if body.drive is not None:
                value = numbers.number(body.drive) * t
            elif body.aim is not None:
                value = aimed(body, body.aim, placed, numbers)
            else:
                value, placed.margin[body.name] = self._solved(body, placed, numbers)
                value = held.get(body.name, value) if held else value
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
        if isinstance(rod, Level):
            return self._levelled(body, rod, placed, numbers)
        own, other = rod.own.drawn(numbers), rod.other.drawn(numbers)
        d = minus(own, other)
        square = dot(d, d)
        there = placed.pose[rod.other.body].place(other)
        seen = placed.pose[body.parent].seen(there)
        on_sphere = own_is_direction(rod)
        side, size = self.side[body.name], numbers.number(1 if on_sphere else self.size)
        if body.slides:
            m = minus(seen, own)
            along = dot(m, u)
            D = along * along - dot(m, m) + square
            length = numbers.root(square)
            placed.miss[body.name] = lambda s: ((s - along) ** 2 - D) / (2 * length * size)
            return along + side * numbers.root(D), D / square
        foot = exact(body.foot, numbers)
        m, w = minus(seen, foot), minus(own, foot)
        a = dot(m, w) - dot(m, u) * dot(w, u)
        b = dot(m, cross(u, w))
        c = (dot(m, m) + dot(w, w) - square) / 2 - dot(m, u) * dot(w, u)
        D = a * a + b * b - c * c
        scale = numbers.root(square) * size
        placed.miss[body.name] = lambda q: (a * numbers.cos(q) + b * numbers.sin(q) - c) / scale
        theta = numbers.atan2(b, a) + side * numbers.atan2(numbers.root(D), c)
        return theta, D / (square * size * size)

    def _levelled(self, body: Body, level: Level, placed: Placed, numbers: Field) -> Any:
        u = unit_vector(exact(body.axis, numbers), numbers)
        n = unit_vector(exact(level.own, numbers), numbers)
        m, drawn = target(body, level, placed, numbers), drawn_target(body, level, numbers)
        size = numbers.number(1 if level.free else self.size)
        a = (dot(m, n) - dot(m, u) * dot(n, u)) / size
        b = dot(m, cross(u, n)) / size
        c = (dot(drawn, n) - dot(m, u) * dot(n, u)) / size
        D = a * a + b * b - c * c
        placed.miss[body.name] = lambda q: a * numbers.cos(q) + b * numbers.sin(q) - c
        placed.blur[body.name] = abs(a) + abs(b) + abs(c)
        return numbers.atan2(b, a) + self.side[body.name] * numbers.atan2(numbers.root(D), c), D


def own_is_direction(rod: Rod) -> bool:
    """Whether the rod joins two points of a unit sphere about one centre."""
    return rod.own.base == rod.other.base and ORIGIN not in (rod.own.offset, rod.other.offset)


def drawn_target(body: Body, item: Rod | Level | Aim, numbers: Field) -> Vector:
    """The other point from the axis's foot, or the other direction, as drawn."""
    if not isinstance(item, Rod) and item.free:
        return unit_vector(item.other.drawn(numbers), numbers)
    return minus(item.other.drawn(numbers), exact(body.foot, numbers))


def target(body: Body, item: Level | Aim, placed: Placed, numbers: Field) -> Vector:
    """The same where the other body is now, as seen in the parent."""
    other, parent = placed.pose[item.other.body], placed.pose[body.parent]
    if item.free:
        return parent.heading(other.along(unit_vector(item.other.drawn(numbers), numbers)))
    there = parent.seen(other.place(item.other.drawn(numbers)))
    return minus(there, exact(body.foot, numbers))


def aimed(body: Body, aim: Aim, placed: Placed, numbers: Field) -> Any:
    u = unit_vector(exact(body.axis, numbers), numbers)
    w, m = exact(aim.own, numbers), target(body, aim, placed, numbers)
    if not aim.free:
        w = minus(w, exact(body.foot, numbers))
    return numbers.atan2(dot(m, cross(u, w)), dot(m, w) - dot(m, u) * dot(w, u))


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
