"""Random linkages with one closed equation, whose dead centres are zeros of its discriminant.

Points are drawn in decimals, so that the file and the closed form say the same exact numbers. With
the crank turned by u, the output of all of them closes

    a(u) cos phi + b(u) sin phi = c(u),

which has a double root where a^2 + b^2 = c^2: the dead centres of u.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any, NamedTuple

from oracle import mp

Point = tuple[str, ...]
"""Decimals."""

HEAD = "format: 1\nunits: {length: m, angle: rad}\n"


class Linkage(NamedTuple):
    """A linkage as drawn: its text with `MOTION` for the input's, the coordinates of input and
    output, and its points as decimals."""

    text: str
    driver: str
    output: str
    kind: str
    points: tuple[Point, ...]

    def swept(self, motion: str) -> str:
        return self.text.replace("MOTION", motion)

    def equation(self, u: Any) -> tuple[Any, Any, Any]:
        """a, b and c, with phi the output's way from its drawing."""
        return EQUATIONS[self.kind](self.points, u)

    def discriminant(self, u: Any) -> Any:
        """In parts of its first terms."""
        a, b, c = self.equation(u)
        return 1 - c * c / (a * a + b * b)

    def dead_centre(self, near: float) -> Any:
        """The zero of the discriminant next to a value, at the precision that is set."""
        return mp.findroot(self.discriminant, mp.mpf(near))

    def output_at(self, u: Any) -> Any:
        """The output where its two values are one."""
        a, b, c = self.equation(u)
        return mp.atan2(b * c, a * c)


def numbers(point: Point) -> list[Any]:
    return [mp.mpf(part) for part in point]


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def minus(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [x - y for x, y in zip(a, b, strict=True)]


def cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def about_z(point: Sequence[Any], u: Any) -> list[Any]:
    x, y, z = point
    return [x * mp.cos(u) - y * mp.sin(u), x * mp.sin(u) + y * mp.cos(u), z]


def output_circle(points: tuple[Point, ...], u: Any) -> tuple[Any, Any, Any]:
    """The crank's tip B keeps its distance from a point C that turns about an axis through D."""
    start, end, foot, along = (numbers(point) for point in points)
    axis = [x / mp.sqrt(dot(along, along)) for x in along]
    arm = minus(end, foot)
    lift = dot(arm, axis)
    beside = [x - lift * n for x, n in zip(arm, axis, strict=True)]
    tip = about_z(start, u)
    way = minus([f + lift * n for f, n in zip(foot, axis, strict=True)], tip)
    length = dot(minus(end, start), minus(end, start))
    constant = dot(way, way) + dot(beside, beside) - length
    return 2 * dot(way, beside), 2 * dot(way, cross(axis, beside)), -constant


def sliding_input(points: tuple[Point, ...], u: Any) -> tuple[Any, Any, Any]:
    """The slider stands at C + u x, the tip B of an arm about the origin turns."""
    start, end = (numbers(point) for point in points)
    at = [end[0] + u, end[1], end[2]]
    length = dot(minus(end, start), minus(end, start))
    across = [-start[1], start[0], mp.mpf(0)]
    return 2 * dot(at, start), 2 * dot(at, across), dot(at, at) + dot(start, start) - length


EQUATIONS = {"output circle": output_circle, "sliding input": sliding_input}


def drawn(point: Point) -> str:
    return f"[{', '.join(point)}]"


def decimal(rng: random.Random, size: float, places: int = 3) -> str:
    return f"{rng.uniform(-size, size):.{places}f}"


def pin(name: str, links: str, point: Point, kind: str = "R", axis: str = "[0, 0, 1]") -> str:
    along = f", axis: {axis}" if axis else ""
    return f"  {name}: {{type: {kind}, links: [{links}], point: {drawn(point)}{along}}}\n"


def links(*names: str) -> str:
    return "links:\n" + "".join(f"  {name}: {{}}\n" for name in names) + "joints:\n"


def driven(name: str) -> str:
    return f"motion: {{inputs: {{{name}: {{MOTION}}}}}}\n"


ORIGIN = ("0", "0", "0")


def four_bar(rng: random.Random) -> Linkage:
    start, end = ((decimal(rng, 1.5), decimal(rng, 1.5), "0") for _ in range(2))
    return plane_four_bar(start, end, (f"{rng.uniform(0.5, 2.0):.3f}", "0", "0"))


def plane_four_bar(start: Point, end: Point, foot: Point) -> Linkage:
    """A four-bar by both ends of its coupler and the rocker's pin as drawn."""
    text = HEAD + links("crank", "coupler", "rocker")
    text += pin("A", "ground, crank", ORIGIN) + pin("B", "crank, coupler", start)
    text += pin("C", "coupler, rocker", end) + pin("D", "ground, rocker", foot)
    points = (start, end, foot, ("0", "0", "1"))
    return Linkage(text + driven("A.theta"), "A.theta", "D.theta", "output circle", points)


def rssr_of(start: Point, end: Point, foot: Point, along: Point) -> Linkage:
    text = HEAD + links("crank", "coupler", "rocker")
    text += pin("A", "ground, crank", ORIGIN)
    text += pin("B", "crank, coupler", start, "S", "") + pin("C", "coupler, rocker", end, "S", "")
    text += pin("D", "ground, rocker", foot, axis=drawn(along))
    points = (start, end, foot, along)
    return Linkage(text + driven("A.theta"), "A.theta", "D.theta", "output circle", points)


def rssr(rng: random.Random) -> Linkage:
    start, end, foot, along = (
        (decimal(rng, size), decimal(rng, size), decimal(rng, size))
        for size in (1.5, 1.5, 1.0, 1.0)
    )
    return rssr_of(start, end, foot, along)


def slider_crank_of(start: Point, end: Point) -> Linkage:
    text = HEAD + links("crank", "rod", "slider")
    text += pin("A", "ground, crank", ORIGIN) + pin("B", "crank, rod", start)
    text += pin("C", "rod, slider", end) + pin("P", "ground, slider", end, "P", "[1, 0, 0]")
    return Linkage(text + driven("P.s"), "P.s", "A.theta", "sliding input", (start, end))


def slider_crank(rng: random.Random) -> Linkage:
    """Driven at the slider: its dead centres are those of the engine."""
    start, end = ((decimal(rng, 1.5), decimal(rng, 1.5), "0") for _ in range(2))
    return slider_crank_of(start, end)


FAMILIES = (four_bar, rssr, slider_crank)


def linkage(number: int) -> Linkage:
    """One of the families, in turn."""
    return FAMILIES[number % len(FAMILIES)](random.Random(number))
