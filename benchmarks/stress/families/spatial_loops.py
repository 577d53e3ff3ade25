"""R C S R, loops of seven revolutes and platforms on six legs, which no closed form solves."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from functools import partial
from typing import Protocol

import numpy as np

from benchmarks.stress.draws import direction, point, scaled, transposed, uniform
from benchmarks.stress.family import Block, Family
from benchmarks.stress.followed import Loop, follow
from benchmarks.stress.linkages.moving import Field
from benchmarks.stress.linkages.platform import LEGS, Platform
from benchmarks.stress.linkages.rcsr import Rcsr
from benchmarks.stress.linkages.sevenr import JOINTS, SevenR
from benchmarks.stress.linkages.writing import decimals
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.numbers.series import Series
from benchmarks.stress.quantity import Quantity, Rows, Truth

ROWS = 60
TURN = 150.0
"""Degrees that cranks turn at most."""
STROKE = 0.4
"""What legs slide at most, in parts of the size."""
LARGEST = 9
"""Powers of ten of the sizes."""
Generators = Sequence[random.Random]


class Told(Loop, Protocol):
    """A loop that is written as a file."""

    def quantities(self, unknowns: Sequence[Series], field: Field) -> tuple[Quantity, ...]:
        """What is compared."""
        ...

    def size(self) -> Rows:
        """What lengths are taken by, in m."""
        ...

    def text(self, k: int, name: str, places: Rows) -> str:
        """Mechanism k as a file."""
        ...


def _rcsr(generators: Generators, powers: Sequence[int]) -> Rcsr:
    drawn, axes = [], []
    for rng, power in zip(generators, powers, strict=True):
        near = [point(rng, 0.3), point(rng)]
        far = [[away + x for x in point(rng)] for away in (1.5, 2.0)]
        places = [*near, *far]
        drawn.append([[scaled(round(x, 4), power) for x in place] for place in places])
        axes.append([direction(rng) for _ in range(3)])
    a, b, c, d = transposed(drawn)
    one, two, four = transposed(axes)
    return Rcsr((a, b, c, d), (one, two, four))


def _sevenr(generators: Generators, powers: Sequence[int]) -> SevenR:
    drawn, axes = [], []
    for rng, power in zip(generators, powers, strict=True):
        drawn.append([[scaled(x, power) for x in point(rng)] for _ in JOINTS])
        axes.append([direction(rng) for _ in JOINTS])
    return SevenR(transposed(drawn), transposed(axes))


def _platform(generators: Generators, powers: Sequence[int]) -> Platform:
    drawn, strokes = [], []
    for rng, power in zip(generators, powers, strict=True):
        low = [[*point(rng)[:2], uniform(rng, -0.1, 0.1)] for _ in LEGS]
        high = [[*point(rng, 0.6)[:2], uniform(rng, 0.9, 1.2)] for _ in LEGS]
        places = [*low, *high, [*point(rng, 0.3)[:2], 1.5]]
        drawn.append([[scaled(x, power) for x in place] for place in places])
        strokes.append([scaled(uniform(rng, -STROKE, STROKE), power) for _ in LEGS])
    *ends, tool = transposed(drawn)
    feet, heads = tuple(ends[: len(LEGS)]), tuple(ends[len(LEGS) :])
    return Platform(feet, heads, tool, np.array(strokes))


def _make(
    shape: Callable[[Generators, Sequence[int]], Told], farthest: float, generators: Generators
) -> Block:
    powers = [rng.randint(-LARGEST, LARGEST) for rng in generators]
    loop = shape(generators, powers)
    senses = np.array([[rng.choice((-1.0, 1.0))] for rng in generators])
    way = follow(loop, senses * farthest)
    parts = np.array([uniform(rng, 0.3, 1.0) for rng in generators])
    places = (way.farthest() * parts)[:, None] * (np.arange(ROWS) / (ROWS - 1))
    texts = [loop.text(k, "spatial loops", row) for k, row in enumerate(places)]

    def truth(at: Rows, field: Field = DoubleDouble) -> Truth:
        unknowns, sure = way.closed(at, field)
        every = np.ones(at.shape, bool)
        return Truth(loop.quantities(unknowns, field), every, sure, loop.size())

    return Block(texts, places, truth, partial(truth, field=decimals))


FAMILY = Family(
    "spatial loops",
    "R C S R, loops of seven revolutes and platforms on six driven legs, of 1e-9 to 1e9 m",
    ROWS,
    (partial(_make, _rcsr, TURN), partial(_make, _sevenr, TURN), partial(_make, _platform, 1.0)),
    weight=0.25,
)
