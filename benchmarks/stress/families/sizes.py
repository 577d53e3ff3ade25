"""All lengths times powers of ten from 1e-9 to 1e9 m."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from functools import partial

from benchmarks.stress.families import shapes
from benchmarks.stress.family import Block, Family
from benchmarks.stress.sweeps import Linkage, through

ROWS = 40
LARGEST = 9


def _make(
    shape: Callable[[Sequence[random.Random], Sequence[int]], Linkage],
    generators: Sequence[random.Random],
) -> Block:
    powers = [rng.randint(-LARGEST, LARGEST) for rng in generators]
    return through(shape(generators, powers), "sizes", generators, ROWS)


FAMILY = Family(
    "sizes",
    "R S S R, R S S P, R C C C and planar four-bars of 1e-9 to 1e9 m",
    ROWS,
    tuple(
        partial(_make, shape)
        for shape in (shapes.rssr, shapes.slider, shapes.rccc, shapes.four_bar)
    ),
)
