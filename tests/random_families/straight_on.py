"""Chains of four-bars of whole-number sides, followed straight on through their branch points.

With the sides g (ground), a (crank), b (rod) and c (rocker), and the crank at t from the ground
line, the rod and the rocker span e^2 = g^2 + a^2 - 2 g a cos(t). They are in line where e = b + c
or e = |b - c|. At t = 0 and t = pi, where e is extreme, the two assemblies cross if the whole
numbers agree, |g - a| = |b - c| or g + a = b + c: going straight on, the side of the rod's pin
changes there, and only there. Elsewhere they meet, a dead centre.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PAIRS = ("RR", "RR", "RS", "SR", "SS", "CS", "SC", "RC", "CR")
FINE = math.radians(0.05)
"""Between places of the path on which angles go on without jumps."""
CLEAR = 1e-4
"""Rad from a branch point at which a row has its place to 1e-8."""


class Bars(NamedTuple):
    """Ground, crank, rod and rocker."""

    g: int
    a: int
    b: int
    c: int

    def crossings(self, t: Array) -> Array:
        """How many branch points lie between 0 and the crank's angles t, signed."""
        at_zero = abs(self.g - self.a) == abs(self.b - self.c)
        at_half = self.g + self.a == self.b + self.c
        turn = t / (2 * math.pi)
        return np.asarray(at_zero * np.ceil(turn) + at_half * np.floor(turn + 0.5))

    def off(self, t: Array) -> Array:
        """The distance in rad to the next branch point."""
        distance = np.full_like(t, math.inf)
        for place, crosses in (
            (0.0, abs(self.g - self.a) == abs(self.b - self.c)),
            (math.pi, self.g + self.a == self.b + self.c),
        ):
            if crosses:
                apart = np.abs(np.remainder(t - place + math.pi, 2 * math.pi) - math.pi)
                distance = np.minimum(distance, apart)
        return distance

    def rocker(self, t: Array, side: Array) -> Array:
        """Its direction on a side; NaN where nothing can be assembled."""
        x, y = self.a * np.cos(t) - self.g, self.a * np.sin(t)
        e = np.hypot(x, y)
        cosine = (e**2 + self.c**2 - self.b**2) / (2 * e * self.c)
        cosine = np.where(self.off(t) < 1e-7, np.clip(cosine, -1, 1), cosine)
        with np.errstate(invalid="ignore"):
            return np.asarray(np.arctan2(y, x) + side * np.arccos(cosine))


def random_bars(rng: random.Random, crank: int | None) -> Bars:
    """A parallelogram, a kite, or four sides of which two are as long as the other two."""
    while True:
        kind = rng.choice(["parallelogram", "parallelogram", "kite", "sum"])
        one, two = rng.randint(1, 6), rng.randint(1, 12)
        if kind == "sum":
            three = rng.randint(1, 12)
            sides = [one, two, three, one + two - three]
            if min(sides) < 1 or len(set(sides)) < 4:
                continue
            rng.shuffle(sides)
        else:
            sides = [two, one, two, one] if kind == "parallelogram" else [two, one, one, two]
        bars = Bars(*sides)
        if bars.g != bars.a and crank in (None, bars.a):
            return bars


@dataclass
class Chain:
    """A file, its crank angles by row in degrees, and the four-bars with the crank's angle as drawn
    and the pin's side."""

    text: str
    rows: Array
    bars: list[tuple[Bars, float, int]]
    what: str

    def rockers(self) -> tuple[Array, Array]:
        """Angles since the drawing in degrees (four-bars, rows), NaN beyond the first dead centre;
        and how far each row is from a branch point (rad)."""
        path, at = self._path()
        turned, off = np.radians(path), np.full(len(path), math.inf)
        found = []
        for bars, drawn, side in self.bars:
            t = drawn + turned
            crossed = bars.crossings(t) - bars.crossings(np.array([drawn]))
            direction = bars.rocker(t, side * (-1.0) ** crossed)
            ended = np.flatnonzero(np.isnan(direction))
            off = np.minimum(off, bars.off(t))
            turned = np.unwrap(direction) - direction[0]
            turned[ended[0] if len(ended) else len(path) :] = np.nan
            found.append(turned)
        return np.degrees(np.array(found))[:, at], off[at]

    def _path(self) -> tuple[Array, Array]:
        """Fine places from the drawing on over all rows, and where the rows are in it."""
        parts, at, last = [np.zeros(1)], [], 0.0
        for row in self.rows:
            count = math.ceil(math.radians(abs(row - last)) / FINE) + 1
            parts.append(np.linspace(last, row, count)[1:])
            at.append(sum(map(len, parts)) - 1)
            last = float(row)
        return np.concatenate(parts), np.array(at)


def chain(number: int) -> Chain:
    """A chain that depends on its number alone."""
    rng = random.Random(number * 7919 + 11)
    links, joints, bars = ["crank"], "", []
    foot, angle, crank, carrier = 0j, rng.uniform(-3, 3), None, "crank"
    for k in range(rng.choice([1, 1, 2, 2, 3])):
        one, side = random_bars(rng, crank), rng.choice([-1, 1])
        direction = float(one.rocker(np.array([angle]), np.array([side]))[0])
        if math.isnan(direction) or abs(math.sin(angle)) < 0.05:
            return chain(number + 10**6)
        pin, hinge = foot + one.a * np.exp(1j * angle), foot + one.g
        end = hinge + one.c * np.exp(1j * direction)
        pairs = rng.choice(PAIRS)
        links += [f"rod{k}", f"rocker{k}"]
        joints += (
            joint(f"P{k}", pairs[0], f"{carrier}, rod{k}", pin)
            + joint(f"Q{k}", pairs[1], f"rod{k}, rocker{k}", end)
            + joint(f"D{k}", "R", f"ground, rocker{k}", hinge)
        )
        bars.append((one, angle, side))
        foot, angle, crank, carrier = hinge, direction, one.c, f"rocker{k}"
    step = rng.choice([1, 3, 7, 11, 13, 17, 23, 29, 37, 45.5])
    way, count = rng.choice([-1, 1]), int(rng.choice([360, 400, 720]) / step)
    rows = way * step * np.arange(count + 1.0)
    motion = f"{{inputs: {{A.theta: {{from: 0, to: {float(rows[-1])!r}, step: {step}}}}}}}"
    what = ", ".join(f"{tuple(b)} {'+' if s > 0 else '-'}" for b, _, s in bars)
    return Chain(written(links, joints, motion), rows, bars, what)


def joint(name: str, kind: str, links: str, at: complex) -> str:
    axis = "" if kind == "S" else ", axis: [0, 0, 1]"
    point = f"[{float(at.real)!r}, {float(at.imag)!r}, 0]"
    return f"  {name}: {{type: {kind}, links: [{links}], point: {point}{axis}}}\n"


def written(links: list[str], joints: str, motion: str) -> str:
    """A file in metres whose first link turns about the origin."""
    return (
        "format: 1\nname: straight on\nunits: {length: m, angle: deg}\n"
        f"links: {{{', '.join(f'{link}: {{}}' for link in links)}}}\njoints:\n"
        + joint("A", "R", f"ground, {links[0]}", 0j)
        + f"{joints}motion: {motion}\nassembly: {{at_branch_points: straight}}\n"
    )


def wheels(rng: random.Random) -> tuple[str, int, float]:
    """Two to five wheels on rods as long as their axles are apart, single or double; how many, and
    the angle of the pins from the line of the axles as drawn."""
    count, pairs, twice = rng.randint(2, 5), rng.choice(PAIRS), rng.random() < 0.5
    radius, apart = complex(*rng.choice([(0, 3), (3, 4), (2.5, 1.7)])), 10
    links, joints = ["wheel0"], ""
    for k in range(1, count):
        links.append(f"wheel{k}")
        for copy in ("", "b") if twice else ("",):
            rod = f"rod{k}{copy}"
            links.append(rod)
            joints += joint(
                f"P{k}{copy}", pairs[0], f"wheel{k - 1}, {rod}", apart * (k - 1) + radius
            ) + joint(f"Q{k}{copy}", pairs[1], f"{rod}, wheel{k}", apart * k + radius)
        joints += joint(f"D{k}", "R", f"ground, wheel{k}", complex(apart * k))
    motion = rng.choice([
        "{inputs: {A.theta: {from: 0, to: 720, step: 7}}}",
        "{inputs: {A.theta: {from: 0, to: -360, step: 11}}}",
        "{time: {from: 0, to: 2, count: 21}, "
        "inputs: {A.theta: {law: harmonic, from: 0, to: 400}}}",
        "{time: {from: 0, to: 2, count: 21}, inputs: {A.theta: {law: polynomial, "
        "coefficients: [0 deg, 300 deg/s, -157 deg/s^2]}}}",
    ])  # fmt: skip
    return written(links, joints, motion), count, float(np.angle(radius))
