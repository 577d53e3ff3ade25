"""Rows of four-bars of unequal lengths in gravity, each crank the next one's rocker, and their
motion by itself: angles by intersections of circles, rates by lengths that bars keep, time by the
integral of the rate that the energy leaves."""

from __future__ import annotations

import cmath
import math
import random
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

GRAVITY = 9.81
ROUND = 1 / 12
"""The moment of inertia of a uniform rod about its centre, in parts of m l^2."""


@dataclass(frozen=True)
class FourBars:
    """Cranks of some lengths on pins along a line, drawn at some angles (rad), with bars from tip
    to tip; uniform rods of their length in kg."""

    pins: Sequence[float]
    lengths: Sequence[float]
    angles: Sequence[float]
    sides: list[float] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "sides", [self._side(k) for k in range(self.loops)])

    @property
    def loops(self) -> int:
        return len(self.pins) - 1

    def tip(self, k: int) -> complex:
        """Of a crank as drawn."""
        return self.pins[k] + self.lengths[k] * cmath.exp(1j * self.angles[k])

    def bar(self, k: int) -> float:
        return abs(self.tip(k + 1) - self.tip(k))

    def _side(self, k: int) -> float:
        return math.copysign(1.0, self._cross(self.tip(k), self.tip(k + 1), k))

    def _cross(self, before: complex, tip: complex, k: int) -> float:
        """Positive where the next tip lies left of the line from the next pin to the tip before."""
        return ((before - self.pins[k + 1]).conjugate() * (tip - self.pins[k + 1])).imag

    def tips(self, turn: float) -> list[complex]:
        """Of all cranks, where the first has turned."""
        found = [self.pins[0] + self.lengths[0] * cmath.exp(1j * (self.angles[0] + turn))]
        for k in range(self.loops):
            line = found[k] - self.pins[k + 1]
            far, crank, bar = abs(line), self.lengths[k + 1], self.bar(k)
            along = (far**2 + crank**2 - bar**2) / (2 * far)
            beside = math.sqrt(crank**2 - along**2)
            found.append(self.pins[k + 1] + line / far * complex(along, self.sides[k] * beside))
        return found

    def turns(self, turn: float) -> list[float]:
        """Of all cranks from where they are drawn, within half a turn."""
        tips = self.tips(turn)
        drawn = [self.tip(k) for k in range(len(tips))]
        pairs = zip(tips, drawn, self.pins, strict=True)
        return [cmath.phase((tip - pin) / (home - pin)) for tip, home, pin in pairs]

    def rates(self, turn: float) -> list[float]:
        """Of all cranks by that of the first."""
        tips, found = self.tips(turn), [1.0]
        for k in range(self.loops):
            bar = tips[k + 1] - tips[k]
            before, after = (1j * (tips[i] - self.pins[i]) for i in (k, k + 1))
            found.append(found[k] * _dot(bar, before) / _dot(bar, after))
        return found

    def inertia_and_height(self, turn: float) -> tuple[float, float]:
        """The moment of inertia about the first crank, and the sum of masses times heights."""
        tips, rates = self.tips(turn), self.rates(turn)
        speed = [1j * w * (t - p) for t, p, w in zip(tips, self.pins, rates, strict=True)]
        inertia = height = 0.0
        for tip, w, length in zip(tips, rates, self.lengths, strict=True):
            inertia += (ROUND + 0.25) * length**3 * w**2
            height += 0.5 * length * tip.imag
        for k in range(self.loops):
            length, bar = self.bar(k), tips[k + 1] - tips[k]
            spin = ((speed[k + 1] - speed[k]) / bar).imag
            inertia += ROUND * length**3 * spin**2
            inertia += length * abs(0.5 * (speed[k] + speed[k + 1])) ** 2
            height += 0.5 * length * (tips[k] + tips[k + 1]).imag
        return inertia, height

    def rate(self, turn: float, first: float) -> float:
        """Of the first crank at a place, with the rate `first` where it is drawn."""
        inertia, height = self.inertia_and_height(turn)
        inertia_drawn, height_drawn = self.inertia_and_height(0.0)
        square = (inertia_drawn * first**2 + 2 * GRAVITY * (height_drawn - height)) / inertia
        return math.copysign(math.sqrt(square), first)

    def time(self, begin: float, end: float, first: float) -> float:
        """From place to place."""
        nodes, weights = np.polynomial.legendre.leggauss(30)
        middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
        return sum(
            half * w / self.rate(middle + half * x, first)
            for x, w in zip(nodes, weights, strict=True)
        )

    def text(
        self,
        *lines: str,
        mirrored: bool = False,
        shuffled: int | None = None,
        names: Sequence[int] | None = None,
    ) -> str:
        """The mechanism with a response `run` of the lines. `shuffled`: links and joints in a
        random order; `names`: the numbers that cranks and bars have in their names."""
        number = list(names or range(self.loops + 1))
        places = [self.tip(k) for k in range(self.loops + 1)]

        def at(place: complex) -> str:
            return f"[{(-1 if mirrored else 1) * place.real!r}, {place.imag!r}]"

        def rod(length: float, centre: complex) -> str:
            inertia = ROUND * length**3
            return f"{{mass: {length!r}, center_of_mass: {at(centre)}, inertia: {inertia!r}}}"

        def joint(name: str, first: str, second: str, place: complex) -> str:
            return f"  {name}: {{type: R, links: [{first}, {second}], point: {at(place)}}}"

        links, joints = [], []
        for k, (tip, pin, length) in enumerate(zip(places, self.pins, self.lengths, strict=True)):
            links.append(f"  crank{number[k]}: {rod(length, 0.5 * (tip + pin))}")
            joints.append(joint(f"A{number[k]}", "ground", f"crank{number[k]}", complex(pin)))
        for k in range(self.loops):
            bar = f"bar{number[k]}"
            links.append(f"  {bar}: {rod(self.bar(k), 0.5 * (places[k] + places[k + 1]))}")
            joints.append(joint(f"B{number[k]}", f"crank{number[k]}", bar, places[k]))
            joints.append(joint(f"C{number[k]}", bar, f"crank{number[k + 1]}", places[k + 1]))
        if shuffled is not None:
            order = random.Random(shuffled)
            order.shuffle(links)
            order.shuffle(joints)
        return "\n".join(
            [
                "format: 1\nname: four-bars in a row\nplane: xy\nunits: {angle: rad}\nlinks:",
                *links,
                "joints:",
                *joints,
                f"loads: [{{type: gravity, g: [0, -{GRAVITY}]}}]\nresponses:\n  run:",
                *(f"    {line}" for line in lines),
                "",
            ]
        )


def _dot(a: complex, b: complex) -> float:
    return (a.conjugate() * b).real


def unequal(loops: int, seed: int) -> FourBars:
    """Cranks about 1 long and about 1 apart, at about 1.9 rad."""
    some = random.Random(seed)

    def about(value: float, part: float) -> list[float]:
        return [value + part * some.uniform(-1, 1) for _ in range(loops + 1)]

    apart = [0.0, *(1.0 + 0.1 * some.uniform(-1, 1) for _ in range(loops))]
    pins = [float(x) for x in np.cumsum(apart)]
    return FourBars(pins, about(1.0, 0.05), about(1.9, 0.05))


def misses(bars: FourBars, found: Any, rate: float, number: Sequence[int]) -> dict[str, float]:
    """By how much the angles, rates (in parts) and times of a run are off."""
    first = f"A{number[0]}.theta"
    turns = np.asarray(found[first], float)
    worst = {"angle": 0.0, "rate": 0.0, "time": 0.0}
    for row, turn in enumerate(turns.tolist()):
        exact = bars.turns(turn)
        off = max(abs(float(found[f"A{number[k]}.theta"][row]) - x) for k, x in enumerate(exact))
        expected = bars.rate(turn, rate)
        worst["angle"] = max(worst["angle"], off)
        worst["rate"] = max(worst["rate"], abs(found[f"{first}_dot"][row] / expected - 1.0))
        taken = bars.time(0.0, turn, rate)
        worst["time"] = max(worst["time"], abs(taken - float(found["time"][row])))
    return worst
