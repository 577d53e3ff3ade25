"""Planar four-bars, slider-cranks and five-bars: a pin on two circles, or a circle and a line."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from decimal import Decimal
from typing import Any

import numpy as np
from oracle.numerics import mp
from random_families.proofs.linkage import Assemblies, Frame, Linkage, decimal, decimals, frame

Point = tuple[Any, Any]
HEAD = "format: 1\nunits: {length: m, angle: rad, mass: kg, force: N}\n"


def four_bar(rng: random.Random) -> Linkage:
    """Any of a crank, a rod and a rocker, closed as drawn."""
    b, c = decimals(rng, 2), decimals(rng, 2, 2.0)
    d = (decimal(rng, 0.5, 2.0), Decimal(0))
    return _four_bar(frame(rng), b, c, d, d)


def near_change_point(rng: random.Random, gap: Decimal) -> tuple[Linkage, float]:
    """A parallelogram whose frame is too long by `gap`^2 of it, and the input in degrees at which
    the crank points along the frame: there its branches come as near as about `gap`. Half a turn
    on they end, as near to each other."""
    b = (decimal(rng, -0.3, 0.3), decimal(rng, 0.6, 1.0))
    foot = (decimal(rng, 1.2, 2.0), Decimal(0))
    far = (foot[0] * (1 + gap * gap), Decimal(0))
    narrow = -math.degrees(math.atan2(b[1], b[0]))
    return _four_bar(frame(rng), b, (b[0] + foot[0], b[1]), foot, far), narrow


def _four_bar(place: Frame, b: Any, c: Any, foot: Any, far: Any) -> Linkage:
    """Pivots at the origin and at `far`; the rocker is drawn from `foot` to `c`, as if the pivot
    were there."""
    body = (
        f"{HEAD}links: {{crank: {{}}, rod: {{}}, rocker: {{}}}}\njoints:\n"
        f"  A: {{type: R, links: [ground, crank], {_pivot(place, (0, 0))}}}\n"
        f"  B: {{type: R, links: [crank, rod], {_pivot(place, b)}}}\n"
        f"  C: {{type: R, links: [rod, rocker], {_pivot(place, c)}}}\n"
        f"  D: {{type: R, links: [ground, rocker], axis: {_normal(place)}, "
        f"point: {{ground: {place.point(*far)}, rocker: {place.point(*foot)}}}}}\n"
    )
    rod, arm = _minus(c, b), _minus(c, foot)

    def assemblies(inputs: Sequence[Any]) -> Assemblies:
        (turn,) = inputs
        end, pivot = _turned(_exact(b), turn), _exact(far)
        found = {}
        for side, pin in _pins(end, pivot, _exact(rod), _exact(arm)).items():
            one, other = _angle(rod, _minus(pin, end)), _angle(arm, _minus(pin, pivot))
            found[side] = {"B.theta": one - turn, "C.theta": other - one, "D.theta": other}
        return found

    def margin(inputs: Sequence[Any]) -> Any:
        return _height(_turned(_floats(b), inputs[0]), _floats(far), _floats(rod), _floats(arm))

    return Linkage(body, ("A.theta",), assemblies, margin, _side(b, far, c))


def five_bar(rng: random.Random) -> Linkage:
    """Two driven cranks, and two rods that meet in a pin."""
    place, b = frame(rng), decimals(rng, 2)
    e = (decimal(rng, 0.5, 2.0), Decimal(0))
    d = tuple(x + y for x, y in zip(e, decimals(rng, 2), strict=True))
    c = (decimal(rng, -1.0, 2.0), decimal(rng, 1.0, 3.0))
    body = (
        f"{HEAD}links: {{one: {{}}, rod: {{}}, bar: {{}}, two: {{}}}}\njoints:\n"
        f"  A: {{type: R, links: [ground, one], {_pivot(place, (0, 0))}}}\n"
        f"  B: {{type: R, links: [one, rod], {_pivot(place, b)}}}\n"
        f"  C: {{type: R, links: [rod, bar], {_pivot(place, c)}}}\n"
        f"  D: {{type: R, links: [two, bar], {_pivot(place, d)}}}\n"
        f"  E: {{type: R, links: [ground, two], {_pivot(place, e)}}}\n"
    )
    rod, bar, arm = _minus(c, b), _minus(c, d), _minus(d, e)

    def ends(inputs: Sequence[Any], of: Any) -> tuple[Point, Point]:
        return _turned(of(b), inputs[0]), _plus(of(e), _turned(of(arm), inputs[1]))

    def assemblies(inputs: Sequence[Any]) -> Assemblies:
        left, right = ends(inputs, _exact)
        found = {}
        for side, pin in _pins(left, right, _exact(rod), _exact(bar)).items():
            one, other = _angle(rod, _minus(pin, left)), _angle(bar, _minus(pin, right))
            found[side] = {
                "B.theta": one - inputs[0],
                "C.theta": other - one,
                "D.theta": other - inputs[1],
            }
        return found

    def margin(inputs: Sequence[Any]) -> Any:
        return _height(*ends(inputs, _floats), _floats(rod), _floats(bar))

    return Linkage(body, ("A.theta", "E.theta"), assemblies, margin, _side(b, d, c))


def slider_crank(rng: random.Random) -> Linkage:
    """A crank, and a rod whose pin slides along a line."""
    place, b, c = frame(rng), decimals(rng, 2), decimals(rng, 2, 2.0)
    way = tuple(map(Decimal, rng.choice((("0.6", "0.8"), ("-0.96", "0.28"), ("1", "0")))))
    body = (
        f"{HEAD}links: {{crank: {{}}, rod: {{}}, slider: {{}}}}\njoints:\n"
        f"  A: {{type: R, links: [ground, crank], {_pivot(place, (0, 0))}}}\n"
        f"  B: {{type: R, links: [crank, rod], {_pivot(place, b)}}}\n"
        f"  C: {{type: R, links: [rod, slider], {_pivot(place, c)}}}\n"
        f"  D: {{type: P, links: [ground, slider], point: {place.point(*c)}, "
        f"axis: {place.direction(*way)}}}\n"
    )
    rod = _minus(c, b)

    def split(end: Point, of: Any) -> tuple[Any, Any, Point]:
        """The slider's way to where the rod is square to its line, and the square of the rest."""
        off, along, length = _minus(of(c), end), of(way), of(rod)
        half = -_dot(off, along)
        return half, half * half - _dot(off, off) + _dot(length, length), along

    def assemblies(inputs: Sequence[Any]) -> Assemblies:
        (turn,) = inputs
        end = _turned(_exact(b), turn)
        half, rest, along = split(end, _exact)
        found = {}
        for side in (1, -1) if rest >= 0 else ():
            slide = half + side * mp.sqrt(rest)
            pin = _plus(_exact(c), (slide * along[0], slide * along[1]))
            one = _angle(rod, _minus(pin, end))
            slid = slide * mp.mpf(10) ** place.power
            found[side] = {"B.theta": one - turn, "C.theta": -one, "D.s": slid}
        return found

    def margin(inputs: Sequence[Any]) -> Any:
        _, rest, _ = split(_turned(_floats(b), inputs[0]), _floats)
        return rest / _dot(_floats(rod), _floats(rod))

    home = 1 if _dot(rod, way) > 0 else -1
    return Linkage(body, ("A.theta",), assemblies, margin, home)


def _pins(p: Point, q: Point, one: Point, other: Point) -> dict[int, Point]:
    """Where circles about p and q cut whose radii are the lengths of two vectors."""
    way, height = _minus(q, p), _height(p, q, one, other)
    if height < 0:
        return {}
    along, beside = _along(way, one, other), mp.sqrt(height)
    return {
        side: (
            p[0] + along * way[0] - side * beside * way[1],
            p[1] + along * way[1] + side * beside * way[0],
        )
        for side in (1, -1)
    }


def _along(way: Point, one: Point, other: Point) -> Any:
    square = _dot(way, way)
    return (square + _dot(one, one) - _dot(other, other)) / (2 * square)


def _height(p: Point, q: Point, one: Point, other: Point) -> Any:
    """Square of the distance from the line pq at which they cut, in parts of its length's."""
    way = _minus(q, p)
    return _dot(one, one) / _dot(way, way) - _along(way, one, other) ** 2


def _side(p: Any, q: Any, pin: Any) -> int:
    (a, b), (x, y) = _minus(q, p), _minus(pin, p)
    return 1 if a * y - b * x > 0 else -1


def _pivot(place: Frame, at: Any) -> str:
    return f"point: {place.point(*map(Decimal, at))}, axis: {_normal(place)}"


def _normal(place: Frame) -> str:
    return place.direction(Decimal(0), Decimal(0), Decimal(1))


def _exact(v: Any) -> Point:
    return mp.mpf(str(v[0])), mp.mpf(str(v[1]))


def _floats(v: Any) -> Point:
    return float(v[0]), float(v[1])


def _turned(v: Point, angle: Any) -> Point:
    of = np if isinstance(angle, np.ndarray) else mp
    c, s = of.cos(angle), of.sin(angle)
    return c * v[0] - s * v[1], s * v[0] + c * v[1]


def _angle(drawn: Any, now: Point) -> Any:
    """How far a vector has turned from its drawing."""
    x, y = _exact(drawn)
    return mp.atan2(x * now[1] - y * now[0], x * now[0] + y * now[1])


def _plus(v: Any, w: Any) -> Point:
    return v[0] + w[0], v[1] + w[1]


def _minus(v: Any, w: Any) -> Point:
    return v[0] - w[0], v[1] - w[1]


def _dot(v: Any, w: Any) -> Any:
    return v[0] * w[0] + v[1] * w[1]
