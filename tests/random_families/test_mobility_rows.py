"""Flat four-bars one behind the other, and bodies on bars: mobility that closed forms decide.

Each four-bar on the line asks for a quadratic form of its crank and its rocker to vanish: a pair of
lines where two sides point either way, a single point where one points against three. A row of m
has m + 1 freedoms of first order; its curves go on through all of it, unless the last is a point.
`MECHKIN_RANDOM` multiplies the number of cases.
"""

from __future__ import annotations

import os
from random import Random

import numpy as np
import pytest
from classics.drawing import planar, platform, rotation
from classics.planes import legs

import mechkin_cli as mk

Answer = tuple[tuple[int, ...], int]
"""Dimensions of what meets at the drawing, and the freedom of first order."""
SEEDS = range(5 * int(os.environ.get("MECHKIN_RANDOM", "1")))


def row_of_four_bars(random: Random) -> tuple[str, Answer]:
    count, isolated = random.randint(2, 4), random.random() < 0.5
    letters = iter("ABCDEFGHIJKLMNOPQ")
    pivot, x, pins = next(letters), 0.0, {}
    pins[pivot], ground, carrier, bars = (0.0, 0.0), pivot, pivot, []
    for k in range(count):
        back = random.sample(range(4), 1 if isolated and k == count - 1 else 2)
        sides = [random.uniform(0.3, 1) for _ in range(4)]
        scale = sum(s for i, s in enumerate(sides) if i not in back) / sum(sides[i] for i in back)
        sides = [-scale * s if i in back else s for i, s in enumerate(sides)]
        one, two, pivot = next(letters), next(letters), next(letters)
        for name, side in zip((one, two, pivot), sides[:3], strict=True):
            x += side
            pins[name] = (x, 0.0)
        bars += [carrier + one, one + two]
        ground, carrier = ground + pivot, two + pivot
    text = planar(pins, [ground, *bars, carrier])
    return text, ((0 if isolated else 1,), count + 1)


def parallel_bars(random: Random) -> tuple[str, Answer]:
    """A plate on equal parallel bars, or on three of different lengths."""
    equal = random.random() < 0.5
    count = random.randint(3, 5) if equal else 3
    feet = np.array([[random.gauss(0, 1), random.gauss(0, 1)] for _ in range(count)])
    lengths = [1.0] * count if equal else [1.0, random.uniform(0.6, 0.8), random.uniform(1.2, 1.5)]
    heads = feet + np.outer(lengths, [0.3, 1.0])
    return legs(feet, heads), (((1,), 1) if equal else ((0,), 1))


def together(random: Random) -> tuple[str, Answer]:
    """A body whose legs end in one point, or on one line: it turns about that."""
    on_line = random.random() < 0.5
    count = random.randint(5, 6) if on_line else random.randint(3, 4)
    feet = np.array([[random.gauss(0, 1) for _ in range(3)] for _ in range(count)])
    along = [random.uniform(-1, 1) * on_line for _ in range(count)]
    heads = np.array([[t, 0.5 * t, 2 + 0.3 * t] for t in along])
    turn = rotation([random.uniform(-1, 1) for _ in range(3)], random.uniform(0, 3))
    freedom = 1 if on_line else 3
    return platform(feet @ turn.T, heads @ turn.T), ((freedom,), freedom)


FAMILIES = [row_of_four_bars, parallel_bars, together]


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
@pytest.mark.parametrize("seed", SEEDS)
def test_as_the_closed_form_says(family, seed: int) -> None:
    text, wanted = family(Random(seed))
    found = mk.loads(text).mobility()
    assert found.diagnostics == ()
    assert (found.dimensions, found.first_order) == wanted
