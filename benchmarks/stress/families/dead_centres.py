"""Rows at 1e-1 to 1e-12 degrees before a dead centre, and some beyond."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from benchmarks.stress.draws import uniform
from benchmarks.stress.families import shapes
from benchmarks.stress.family import Block, Family
from benchmarks.stress.numbers.double_double import DEGREE
from benchmarks.stress.quantity import Rows
from benchmarks.stress.reach import Reach, reach
from benchmarks.stress.sweeps import FULL, Linkage, block, towards

POWERS = range(-1, -13, -1)
EACH = 3
"""Rows of each power of ten."""
BEYOND = (1e-9, 1e-6, 1e-3)
ROWS = 1 + EACH * len(POWERS) + len(BEYOND)


def _make(
    shape: Callable[[Sequence[random.Random], Sequence[int]], Linkage],
    generators: Sequence[random.Random],
) -> Block:
    linkage = shape(generators, [0] * len(generators))
    found, degrees = near_ends(linkage, generators)
    return block(linkage, "dead centres", found, degrees)


def near_ends(linkage: Linkage, generators: Sequence[random.Random]) -> tuple[Reach, Rows]:
    """How far the branches go, and rows next to their ends in degrees (mechanisms, rows)."""
    found = reach(linkage.margin, len(generators))
    sense, _ = towards(found, generators)
    ends = found.ends(sense) / DEGREE
    degrees = np.zeros((len(generators), ROWS))
    for k, rng in enumerate(generators):
        distances = _distances(rng)
        if not np.isfinite(ends.high[k, 0]):
            degrees[k] = sense[k, 0] * FULL * np.arange(ROWS) / (ROWS - 1)
            continue
        near = (ends[k : k + 1] - sense[k, 0] * distances).high[0]
        # rows on the near side of the drawing stay there
        degrees[k, 1:] = np.where(near * sense[k, 0] > 0.0, near, 0.0)
    return found, degrees


def _distances(rng: random.Random) -> np.ndarray:
    before = []
    for power in POWERS:
        digits = sorted((uniform(rng, 1.0, 9.999) for _ in range(EACH)), reverse=True)
        before += [float(f"{x}e{power}") for x in digits]
    return np.array([*before, *(-x for x in BEYOND)])


FAMILY = Family(
    "dead centres",
    "R S S R, R S S P and planar four-bars, 1 to 1e-12 degrees before a dead centre and beyond",
    ROWS,
    tuple(partial(_make, shape) for shape in (shapes.rssr, shapes.slider, shapes.four_bar)),
)
