"""Chains of dyads driven at, beside and past their dead centres and branch points.

An input turns or slides a link; each dyad hangs between that link and the ground and moves the next
one. Its output closes a cos phi + b sin phi = c, or s^2 + 2 p s + q = 0, whose coefficients are
functions of the input: two roots that are one where the discriminant is zero. So a branch of the
chain has one sign for each dyad, as long as no discriminant becomes zero on the way.

Numbers are decimals in the file and long doubles of 64 bits in the closed form.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from typing import Any, NamedTuple

import numpy as np

Long = np.longdouble
Point = tuple[Decimal, Decimal, Decimal]
Array = Any
"""Of long doubles."""

ROUNDINGS = 1e-13
"""Of a discriminant, in parts of its first terms."""
CLOSED = 1e-8
"""What may be wrong of a coordinate: positions are right to eight digits."""
Z: Point = (Decimal(0), Decimal(0), Decimal(1))
DIRECTIONS = [("1", "0"), ("0.6", "0.8"), ("-0.28", "0.96"), ("0.8", "-0.6"), ("-0.96", "-0.28")]
"""Unit vectors in decimals."""


def long(point: Sequence[Decimal]) -> Array:
    return np.array([Long(str(x)) for x in point])


def dot(a: Any, b: Any) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Any, b: Any) -> Any:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def unit(a: Any) -> Any:
    return a / np.sqrt(dot(a, a))


class Link(NamedTuple):
    """A link that turns or slides against the ground."""

    turns: bool
    foot: Point
    axis: Point

    def moved(self, point: Point, u: Array) -> Array:
        """A point of it, drawn where the coordinate is zero."""
        at, axis = long(point)[:, None], unit(long(self.axis))[:, None]
        if not self.turns:
            return at + u * axis
        foot = long(self.foot)[:, None]
        arm = at - foot
        lift = dot(axis, arm)
        across = cross(axis, arm)
        return foot + lift * axis + np.cos(u) * (arm - lift * axis) + np.sin(u) * across


class Dyad(NamedTuple):
    """Coupler and output link.

    Attributes:
        kind: the joints from the input link on, the last one with the ground.
        start: where the coupler is pinned to the input link.
        end: where to the output link, as the output link is drawn.
        rod: the coupler's length; None where it is as drawn.
        along: of a coupler that slides in the output link.
        side: the sign of the root.
    """

    kind: str
    driver: Link
    output: Link
    start: Point
    end: Point
    rod: Decimal | None
    along: Point
    side: int

    def coefficients(self, u: Array, more: Any = 0) -> tuple[Array, Array, Array, Array]:
        """a, b, c, and what is below the root in c, in parts of its terms, changed by `more`."""
        tip, end, foot = self.driver.moved(self.start, u), long(self.end), long(self.output.foot)
        axis = unit(long(self.output.axis))
        drawn = long(self.start)
        ones = np.ones_like(u)
        if self.kind[1] in "PC":
            along, way, first = unit(long(self.along)), tip - foot[:, None], drawn - foot
            if self.kind == "RPR":
                along = cross(axis, along)
                level, inner = dot(along, first) * ones, ones
            else:
                squared = dot(first, first) - dot(along, first) ** 2
                inner = 1 - squared / dot(way, way) + more
                level = np.sign(dot(along, first)) * np.sqrt(np.maximum(inner, 0) * dot(way, way))
            lift = dot(axis, along)
            across = along - lift * axis
            c = level - lift * dot(axis, way)
            return dot(across, way), dot(cross(axis, across), way), c, inner
        span = end - drawn
        squared = dot(span, span) if self.rod is None else Long(str(self.rod)) ** 2
        if not self.output.turns:
            way = end[:, None] - tip
            return dot(axis, way), dot(way, way) - squared, np.sqrt(squared) * ones, ones
        lift = dot(axis, end - foot)
        arm = end - foot - lift * axis
        way = (foot + lift * axis)[:, None] - tip
        c = squared - dot(way, way) - dot(arm, arm)
        return 2 * dot(way, arm), 2 * dot(way, cross(axis, arm)), c, ones

    def discriminant(self, u: Array) -> Array:
        """In parts of its first terms; negative where the dyad does not close."""
        a, b, c, inner = self.coefficients(u)
        if not self.output.turns:
            return (a * a - b) / (c * c)
        whole = 1 - c * c / (a * a + b * b)
        return np.minimum(whole, inner) if self.kind == "SCR" else whole

    def place(self, u: Array, more: Any = 0) -> Array:
        """The output, its discriminant changed by `more`."""
        a, b, c, _ = self.coefficients(u, more)
        if not self.output.turns:
            return -a + self.side * np.abs(c) * np.sqrt(np.maximum((a * a - b) / (c * c) + more, 0))
        square = a * a + b * b
        root = self.side * np.sqrt(square * np.maximum(1 - c * c / square + more, 0))
        return np.arctan2(b * c + a * root, a * c - b * root)

    def roundings(self, u: Array, extent: float = 0.0) -> Array:
        """Of the discriminant: a short arm, and one far from the origin, make the most of them, and
        one in a mechanism of great extent, in parts of which the kernel closes."""
        a, b, c, _ = self.coefficients(u)
        tip, foot = self.driver.moved(self.start, u), long(self.output.foot)[:, None]
        far = np.maximum(np.sqrt(dot(tip, tip) + dot(foot, foot)), 0.1 * extent)
        if not self.output.turns:
            return ROUNDINGS * np.maximum(1, np.maximum((a / c) ** 2, far / c))
        arm = long(self.end) - foot[:, 0]
        reach = dot(tip - foot, tip - foot) + dot(arm, arm)
        size = np.sqrt(a * a + b * b) if self.kind[1] not in "PC" else a * a + b * b
        return ROUNDINGS * np.maximum(1, 4 * np.maximum(reach, far * np.sqrt(reach)) / size)

    def drawn_side(self) -> int:
        """The sign of the branch on which the output is drawn."""
        a, b, _, _ = self.coefficients(np.zeros(1, Long))
        return int(np.sign(-b[0] if self.output.turns else a[0])) or 1


class Chain(NamedTuple):
    """An input link and dyads."""

    first: Link
    dyads: tuple[Dyad, ...]

    def discriminants(self, u: Array) -> Array:
        """(dyads, places); nan behind one that does not close."""
        found = []
        for dyad in self.dyads:
            found.append(dyad.discriminant(u))
            u = np.where(found[-1] < 0, np.nan, dyad.place(u))
        return np.array(found)

    def judged(self, u: Array) -> tuple[Array, Array, Array]:
        """Outputs, what they are uncertain by, and the discriminants in parts of their uncertainty
        (dyads, places)."""
        outputs, within, left = [], [], []
        points = np.array([point for dyad in self.dyads for point in (dyad.start, dyad.end)])
        extent = float(np.sqrt(np.sum(np.ptp(points.astype(float), axis=0) ** 2)))
        off = np.zeros_like(u)
        for dyad in self.dyads:
            shift, at = dyad.roundings(u, extent), dyad.place(u)
            around = [u - off, u, u + off]
            found = dyad.discriminant(u)
            moved = np.max([np.abs(dyad.discriminant(x) - found) for x in around], axis=0)
            left.append(found / (shift + moved))
            ways = [turned(dyad, dyad.place(x, s * shift) - at) for x in around for s in (-1, 0, 1)]
            off = np.max(np.abs(ways), axis=0) + CLOSED * (1 if dyad.output.turns else scale(dyad))
            outputs.append(at)
            within.append(off)
            u = at
        return np.array(outputs), np.array(within), np.array(left)

    def flipped(self, dyad: int) -> Chain:
        """The other branch, which meets this one where a discriminant is zero."""
        dyads = list(self.dyads)
        dyads[dyad] = dyads[dyad]._replace(side=-dyads[dyad].side)
        return self._replace(dyads=tuple(dyads))

    def text(self, motion: str, near: str, straight: bool) -> str:
        kinds = {True: "R", False: "P"}
        links, joints = ["l0"], [self._ground(0, self.first, kinds)]
        for k, dyad in enumerate(self.dyads, 1):
            links += [f"k{k}", f"l{k}"]
            first, second = dyad.kind[0], dyad.kind[1]
            joints.append(_joint(f"B{k}", first, f"l{k - 1}, k{k}", _point(dyad.start), Z))
            at = _point(dyad.end)
            if dyad.rod is not None:
                x, y, z = dyad.start
                at = f"{{k{k}: {_point((x + dyad.rod, y, z))}, l{k}: {at}}}"
            along = dyad.along if second in "PC" else Z
            joints.append(_joint(f"C{k}", second, f"k{k}, l{k}", at, along))
            joints.append(self._ground(k, dyad.output, kinds))
        return (
            "format: 1\nunits: {length: m, angle: rad}\nlinks: {"
            + ", ".join(f"{link}: {{}}" for link in links)
            + "}\njoints:\n"
            + "".join(joints)
            + f"motion: {{inputs: {{{self.name(0)}: {{{motion}}}}}}}\n"
            + ("assembly: {at_branch_points: straight" if straight else "assembly: {")
            + (", " if straight and near else "")
            + (f"near: {{{near}}}}}\n" if near else "}\n")
        )

    def name(self, k: int) -> str:
        link = self.dyads[k - 1].output if k else self.first
        return f"J{k}.{'theta' if link.turns else 's'}"

    @staticmethod
    def _ground(k: int, link: Link, kinds: dict[bool, str]) -> str:
        return _joint(f"J{k}", kinds[link.turns], f"ground, l{k}", _point(link.foot), link.axis)


def turned(dyad: Dyad, way: Array) -> Array:
    """Without whole turns."""
    return (
        way - 2 * np.pi * np.round((way / (2 * np.pi)).astype(float)) if dyad.output.turns else way
    )


def scale(dyad: Dyad) -> float:
    return float(np.sqrt(np.max(long(dyad.end)[:2] ** 2 + long(dyad.start)[:2] ** 2)))


def _point(point: Sequence[Decimal]) -> str:
    return f"[{', '.join(f'{x:f}' for x in point)}]"


def _joint(name: str, kind: str, links: str, point: str, axis: Point) -> str:
    along = "" if kind == "S" else f", axis: {_point(axis)}"
    return f"  {name}: {{type: {kind}, links: [{links}], point: {point}{along}}}\n"
