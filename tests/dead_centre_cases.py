"""Mechanisms whose drawing is a dead centre of their input, with what is exact about them.

They are RSSR loops and slider-cranks drawn in line, whose closure is one equation; it is solved to
50 digits here (`mpmath.workdps(50)` around each use).
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import mpmath as mp
import pytest

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


def bent(gap: Callable[[Any, Any], Any]) -> tuple[Any, Any]:
    """Of the closure's error at the dead centre: the slope by the driven coordinate, and what goes
    with the square of the crank's angle."""
    return mp.diff(lambda x: gap(0, x), 0), mp.diff(lambda t: gap(t, 0), 0, 2) / 2


def inward(gap: Callable[[Any, Any], Any]) -> int:
    """The sign of the driven coordinate where the loop closes."""
    slope, bend = bent(gap)
    return 1 if -slope / bend > 0 else -1


def _swapped(gap: Callable[[Any, Any], Any], driven: Any, crank: Any) -> Any:
    return gap(crank, driven)


class Case(NamedTuple):
    """A mechanism whose drawing is a dead centre of its input, and what is exact about it."""

    file: dict[str, Any]
    driven: str
    effort: str
    unit: Any
    """Of the driven coordinate, in rad or m."""
    side: int
    """Sign of the crank's angle on the branch that is meant."""
    inward: int
    """Sign of the driven coordinate where the loop closes."""
    gap: Callable[[Any, Any], Any]
    """The closure's error by crank angle and driven coordinate, in rad and m."""
    rate: Any
    torque: Any

    def crank(self, driven: Any) -> Any:
        """The crank's angle at a driven coordinate, rad."""
        slope, bend = bent(self.gap)
        start = self.side * mp.sqrt(-slope / bend * driven)
        return mp.findroot(partial(_swapped, self.gap, driven), start)

    def speed(self, driven: Any) -> Any:
        """The crank's rate, rad/s."""
        at = self.crank(driven)
        by_crank = mp.diff(lambda t: self.gap(t, driven), at)
        return -mp.diff(lambda x: self.gap(at, x), driven) / by_crank * self.rate

    def swept(self, places: list[float]) -> mk.Analysis:
        """The sweep through some distances from the dead centre, on the branch that is meant."""
        values = [f"{self.inward * one!r}" for one in places]
        unit = "rad/s" if self.driven == "D.theta" else "m/s"
        inputs = {self.driven: {"values": values, "rate": f"{float(self.rate)!r} {unit}"}}
        assembly = {"near": {"A.theta": 2 * self.side}}
        return mk.load(self.file | {"motion": {"inputs": inputs}, "assembly": assembly}).analyze()


def rssr(seed: int) -> Case | None:
    """A crank about z with its rod in the plane of crank and axis, and a rocker anyhow."""
    draw = random.Random(seed)

    def between(low: float, high: float) -> float:
        return round(draw.uniform(low, high), 2)

    crank, rod = between(0.3, 1), between(1.5, 3)
    along, across = draw.choice([(0.6, 0.8), (0.8, 0.6), (0.28, 0.96)])
    far = [round(crank + draw.choice([-1, 1]) * rod * along, 6), 0.0, round(rod * across, 6)]
    pivot = [between(-2, 2), between(-2, 2), between(-1, 1)]
    axis = [between(-1, 1), between(-1, 1), between(0.2, 1)]
    torque, rate, side = between(1, 5), draw.choice([1, -2]), draw.choice([1, -1])
    b, p, n = ([mp.mpf(str(x)) for x in given] for given in (far, pivot, axis))
    a = mp.mpf(str(crank))
    length = sum((x - y) ** 2 for x, y in zip(b, [a, 0, 0], strict=True))
    norm = mp.sqrt(sum(x * x for x in n))
    k, arm = [x / norm for x in n], [x - y for x, y in zip(b, p, strict=True)]
    cross = [k[1] * arm[2] - k[2] * arm[1], k[2] * arm[0] - k[0] * arm[2], 0]
    cross[2] = k[0] * arm[1] - k[1] * arm[0]
    dot = sum(x * y for x, y in zip(k, arm, strict=True))

    def gap(turn: Any, rocker: Any) -> Any:
        c, s = mp.cos(rocker), mp.sin(rocker)
        ball = [p[i] + arm[i] * c + cross[i] * s + k[i] * dot * (1 - c) for i in range(3)]
        pin = [a * mp.cos(turn), a * mp.sin(turn), 0]
        return sum((x - y) ** 2 for x, y in zip(ball, pin, strict=True)) - length

    slope, bend = bent(gap)
    if not 0.05 < abs(bend / slope) < 20:  # too flat or too sharp to be within reach at 1 degree
        return None
    file = {
        "format": 1,
        "units": {"length": "m"},
        "links": {"crank": {}, "rod": {}, "rocker": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "crank"], "point": [0, 0, 0], "axis": [0, 0, 1]},
            "B": {"type": "S", "links": ["crank", "rod"], "point": [crank, 0, 0]},
            "C": {"type": "S", "links": ["rod", "rocker"], "point": far},
            "D": {"type": "R", "links": ["ground", "rocker"], "point": pivot, "axis": axis},
        },
        "loads": [{"type": "torque", "joint": "A", "value": torque}],
    }
    known = (mp.mpf(rate), mp.mpf(str(torque)))
    return Case(file, "D.theta", "D.effort", mp.pi / 180, side, inward(gap), gap, *known)


def slider_crank(seed: int) -> Case:
    """In a plane, or the same in space with more constraints than it needs; the slide drives."""
    draw = random.Random(seed)
    r, rod = draw.choice([0.5, 0.25, 1.5]), draw.choice([1.0, 2.0, 3.5])
    inner, plane = draw.random() < 0.5, draw.random() < 0.5
    reach = rod - r if inner else r + rod
    ends = {"A": (0, 0), "B": (-r if inner else r, 0), "C": (reach, 0), "D": (reach, 0)}
    pairs = [("ground", "crank"), ("crank", "rod"), ("rod", "block"), ("ground", "block")]
    joints: dict[str, Any] = {}
    for (name, place), links in zip(ends.items(), pairs, strict=True):
        joints[name] = {"type": "R", "links": list(links), "point": list(place)}
        if not plane:
            joints[name] |= {"point": [*place, 0], "axis": [0, 0, 1]}
    joints["D"] |= {"type": "P", "axis": [1, 0] if plane else [1, 0, 0]}
    torque, rate, side = draw.randint(1, 5), draw.choice([20, -30]), draw.choice([1, -1])
    file = {
        "format": 1,
        "units": {"length": "mm"},
        "links": {"crank": {}, "rod": {}, "block": {}},
        "joints": {
            name: joint | {"point": [1000 * x for x in joint["point"]]}
            for name, joint in joints.items()
        },
        "loads": [{"type": "torque", "joint": "A", "value": f"{torque} N*m"}],
    } | ({"plane": "xy"} if plane else {})

    def gap(turn: Any, slide: Any) -> Any:
        x = reach + slide - (-r if inner else r) * mp.cos(turn)
        return x**2 + (r * mp.sin(turn)) ** 2 - mp.mpf(rod) ** 2

    millimetre = mp.mpf("1e-3")
    rates = (rate * millimetre, mp.mpf(torque))
    return Case(file, "D.s", "D.effort", millimetre, side, inward(gap), gap, *rates)


HARD = (29, 104, 126, 140)
"""Loops that close some twenty roundings off, or move their driven link by a short arm."""


def cases(count: int) -> list[Any]:
    loops = {seed: rssr(seed) for seed in sorted({*range(count), *HARD})}
    found = [pytest.param(loop, id=f"rssr-{seed}") for seed, loop in loops.items() if loop]
    return found + [pytest.param(slider_crank(seed), id=f"slider-{seed}") for seed in range(count)]


with mp.workdps(50):
    CASES = cases(4 * TIMES)
