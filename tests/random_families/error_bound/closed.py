"""Loops of one equation between two joints on ground, and how far rows are from its root at 60
digits; no code of the package finds it.

Driver and follower turn, slide or advance by a thread. What joins them holds a distance (two
spheres, or two pins in a plane), a distance from a line (a cylinder and a sphere), or a place on a
plane (a sphere on a plane).
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from oracle.numerics import mp
from random_families.proofs.linkage import decimal, decimals

import mechkin_cli as mk
from mechkin_cli.verdict import Status

DIGITS = 60
STEP = mp.mpf(10) ** -25
"""Of the difference that stands for the slope: it leaves 1e-25 of it."""
Vector = tuple[Any, Any, Any]
Gap = Callable[[Vector, Vector, Vector], Any]
"""Of two points that are joined, and of the driver's direction: zero where they are."""

Moved = Callable[[Any, Vector, Vector], tuple[Vector, Vector]]
"""A point and a direction as drawn, where a coordinate takes them."""

FAMILIES = ("four-bar", "four-bar in a plane", "slider-crank", "RSSR", "RCSR", "H-Sp-H")


def dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def unit(a: Vector) -> Vector:
    size = mp.sqrt(dot(a, a))
    return a[0] / size, a[1] / size, a[2] / size


def exact(numbers: Any) -> Vector:
    x, y, z = (mp.mpf(str(n)) for n in (*numbers, 0)[:3])
    return x, y, z


@dataclass(frozen=True)
class Joint:
    """On ground: its letter, foot and axis as written, and the advance of a turn."""

    letter: str
    foot: tuple[Decimal, ...]
    axis: tuple[Decimal, ...]
    lead: Decimal = Decimal(0)

    def moved(self) -> Moved:
        """A point and a direction as drawn, where a coordinate takes them."""
        foot, u, lead = exact(self.foot), unit(exact(self.axis)), mp.mpf(str(self.lead))

        def turned(v: Vector, c: Any, s: Any) -> Vector:
            part, across = (1 - c) * dot(u, v), cross(u, v)
            return tuple(c * v[k] + s * across[k] + part * u[k] for k in range(3))  # type: ignore

        def moved(q: Any, point: Vector, direction: Vector) -> tuple[Vector, Vector]:
            if self.letter == "P":
                return tuple(p + q * a for p, a in zip(point, u, strict=True)), direction  # type: ignore
            c, s = mp.cos(q), mp.sin(q)
            arm = turned(minus(point, foot), c, s)
            on = lead * q / (2 * mp.pi)
            place = tuple(f + x + on * a for f, x, a in zip(foot, arm, u, strict=True))
            return place, turned(direction, c, s)  # type: ignore

        return moved

    def line(self, name: str, link: str) -> str:
        lead = f", lead: {self.lead}" if self.letter == "H" else ""
        return (
            f"  {name}: {{type: {self.letter}, links: [ground, {link}], "
            f"point: {written(self.foot)}, axis: {written(self.axis)}{lead}}}\n"
        )


@dataclass(frozen=True)
class Loop:
    """A file's text without its motion, and what closes it: `driver` moves `one` and `direction`,
    `follower` moves `two`."""

    text: str
    driver: Joint
    follower: Joint
    one: Vector
    two: Vector
    direction: Vector
    gap: Gap

    @property
    def output(self) -> str:
        return "D.s" if self.follower.letter == "P" else "D.theta"

    @cached_property
    def _moved(self) -> tuple[Moved, Moved]:
        return self.driver.moved(), self.follower.moved()

    @cached_property
    def _drawn(self) -> Any:
        return self.gap(self.one, self.two, self.direction)

    def error(self, degrees: str, output: float) -> float:
        """How far an output in rad or m is from the root next to it: three steps of Newton's method
        from it at the driver's place as written."""
        with mp.workdps(DIGITS):
            drive, follow = self._moved
            point, direction = drive(mp.radians(mp.mpf(degrees)), self.one, self.direction)

            def miss(q: Any) -> Any:
                return self.gap(point, follow(q, self.two, self.two)[0], direction) - self._drawn

            place = mp.mpf(output)
            for _ in range(3):
                value = miss(place)
                place -= value * STEP / (miss(place + STEP) - value)
            return float(abs(place - mp.mpf(output)))


def of_distance(one: Vector, two: Vector, _: Vector) -> Any:
    way = minus(two, one)
    return dot(way, way)


def of_line(one: Vector, two: Vector, direction: Vector) -> Any:
    way, axis = minus(two, one), unit(direction)
    return dot(way, way) - dot(way, axis) ** 2


def on_plane(one: Vector, two: Vector, normal: Vector) -> Any:
    return dot(minus(two, one), normal)


def written(numbers: Any) -> str:
    return f"[{', '.join(str(n) for n in numbers)}]"


UNITS = "units: {length: m, angle: deg}\n"
Z = (Decimal(0), Decimal(0), Decimal(1))


def flat(rng: random.Random, far: bool = False) -> tuple[Decimal, ...]:
    x, y = decimals(rng, 2)
    return (x + 2 if far else x, y, Decimal(0))


def drawn(number: int) -> Loop:
    """One of a family, by its number."""
    rng, family = random.Random(number), FAMILIES[number % len(FAMILIES)]
    if family.startswith(("four", "slider")):
        foot, far, one, two = flat(rng), flat(rng, True), flat(rng), flat(rng, True)
        way = (decimal(rng, 0.2, 1.0), *decimals(rng, 1), Decimal(0))
        last = Joint("P", two, way) if family[0] == "s" else Joint("R", far, Z)
        first = Joint("R", foot, Z)
        pins = ("R", "R")
    elif family == "H-Sp-H":
        first = Joint("H", decimals(rng), decimals(rng), decimal(rng, 0.1, 1.5))
        last = Joint("H", decimals(rng), decimals(rng), decimal(rng, 0.1, 1.5))
        one, two, pins = decimals(rng), decimals(rng), ("Sp", "")
        two = one
    else:
        one, two = decimals(rng), tuple(x + 1 for x in decimals(rng))
        first = Joint("R", decimals(rng), decimals(rng))
        last = Joint("R", decimals(rng), decimals(rng))
        pins = ("S", "S") if family == "RSSR" else ("C", "S")
    direction = decimals(rng)
    plane = family == "four-bar in a plane"
    text = "format: 1\n" + UNITS + ("plane: xy\n" if plane else "")
    if pins[0] == "Sp":
        middle = (
            f"  B: {{type: Sp, links: [follower, driver], point: {written(one)}, "
            f"normal: {written(direction)}}}\n"
        )
        links = "links: {driver: {}, follower: {}}\n"
    else:
        axis = {"R": f", axis: {written(Z)}", "C": f", axis: {written(direction)}", "S": ""}
        middle = "".join(
            f"  {name}: {{type: {letter}, links: [{pair}], "
            f"point: {written(point)}{axis[letter]}}}\n"
            for name, letter, pair, point in (
                ("B", pins[0], "driver, rod", one),
                ("C", pins[1], "rod, follower", two),
            )
        )
        links = "links: {driver: {}, rod: {}, follower: {}}\n"
    joints = first.line("A", "driver") + middle + last.line("D", "follower")
    if plane:
        joints = joints.replace(f", axis: {written(Z)}", "").replace(", 0]", "]")
    gap = {"Sp": on_plane, "C": of_line}.get(pins[0], of_distance)
    with mp.workdps(DIGITS):
        points = exact(one), exact(two), exact(direction)
    return Loop(text + links + "joints:\n" + joints, first, last, *points, gap)


def motion(loop: Loop, degrees: list[str]) -> str:
    """The file of a sweep over places of the driver in degrees."""
    return f"{loop.text}motion: {{inputs: {{A.theta: {{values: [{', '.join(degrees)}]}}}}}}\n"


class Row(NamedTuple):
    """A row's error of driver and follower in the unit of its bound, the bound, the condition, and
    the verdict."""

    error: float
    bound: float
    condition: float
    status: Status


def rows_of(loop: Loop, degrees: list[str]) -> list[Row]:
    """Rows at places of the driver, those that have a position."""
    r = mk.loads(motion(loop, degrees)).analyze(tables=[])
    bound, result = r["row.error_bound"], r.result
    condition = np.asarray(result.quantity("row.condition").value)
    output = np.asarray(result.quantity(loop.output).value)
    unit = result.length if loop.output == "D.s" else 1.0
    rows = []
    for k in np.flatnonzero(result.solved):
        error = loop.error(degrees[k], float(output[k])) / unit
        rows.append(Row(error, float(bound[k]), float(condition[k]), Status(result.status[k])))
    return rows


def turn_of(number: int, count: int) -> list[str]:
    """Places within a full turn, in order, from the drawing on."""
    rng = random.Random(-number - 1)
    return ["0", *map(str, sorted(round(rng.uniform(0.0, 360.0), 3) for _ in range(count)))]


def toward_dead_centre(loop: Loop) -> list[str]:
    """Places before a dead centre, down to roundings from it, and some behind it; none if the
    driver goes around."""
    r = mk.loads(motion(loop, [str(5 * k) for k in range(73)])).analyze(tables=[])
    ends = [end for _, end in r.result.row_states.ends if end.is_dead_centre]
    if not ends:
        return []
    place = math.degrees(float(ends[0].inputs[0]))
    near = [place - part * 10.0**-k for k in range(2, 16) for part in (3.3, 1.0)]
    there = [place + k * math.ulp(place) for k in range(-5, 3)]
    part = [place * k / 10 for k in range(10)]
    return [repr(x) for x in (*part, *near, *there) if x >= 0.0]
