"""Crank, rod, rocker and frame of lengths that differ by up to a million."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from benchmarks.stress.draws import direction, scaled, transposed
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.rssr import Rssr
from benchmarks.stress.linkages.slider import Slider
from benchmarks.stress.sweeps import through

ROWS = 40
SMALLEST = -6


def _arm(rng: random.Random) -> list[float]:
    power = rng.randint(SMALLEST, 0)
    return [scaled(x, power) for x in direction(rng)]


def _rssr(generators: Sequence[random.Random]) -> Block:
    drawn = [[_arm(rng) for _ in range(3)] for rng in generators]
    axes = [[direction(rng), direction(rng)] for rng in generators]
    crank, frame, rocker = transposed(drawn)
    points = (np.zeros_like(crank), crank, frame + rocker, frame)
    one, two = transposed(axes)
    return through(Rssr(points, (one, two)), "link ratios", generators, ROWS)


def _slider(generators: Sequence[random.Random]) -> Block:
    drawn = [[_arm(rng), _arm(rng)] for rng in generators]
    axes = [[direction(rng), direction(rng)] for rng in generators]
    crank, far = transposed(drawn)
    one, two = transposed(axes)
    linkage = Slider((np.zeros_like(crank), crank, far), (one, two))
    return through(linkage, "link ratios", generators, ROWS)


FAMILY = Family(
    "link ratios",
    "R S S R and R S S P whose links differ in length by up to 1e6",
    ROWS,
    (_rssr, _slider),
)
