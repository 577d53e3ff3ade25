"""R C C C whose four axes are parallel but for 1e-3 to 1e-14 rad."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from benchmarks.stress.draws import direction, point, scaled, transposed, uniform
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.rccc import Rccc
from benchmarks.stress.reach import reach
from benchmarks.stress.sweeps import PAST_END, block, towards

ROWS = 40
WAY = 500.0
"""Degrees that the crank turns at most, times the angle (rad) between the axes: the slides grow as
the turn over that angle, and go a few sizes."""
POWERS = (-14, -3)


def _make(generators: Sequence[random.Random]) -> Block:
    axes, places = [], []
    powers = [rng.randint(*POWERS) for rng in generators]
    for rng, power in zip(generators, powers, strict=True):
        slants = [direction(rng)[:2] for _ in range(4)]
        axes.append([[scaled(x, power), scaled(y, power), 1.0] for x, y in slants])
        places.append([point(rng) for _ in range(4)])
    a, b, c, d = transposed(places)
    one, two, three, four = transposed(axes)
    linkage = Rccc((a, b, c, d), (one, two, three, four))
    found = reach(linkage.margin, len(generators))
    sense, ends = towards(found, generators)
    last = []
    for rng, power, s, end in zip(generators, powers, sense[:, 0], ends, strict=True):
        way = scaled(uniform(rng, 0.2, WAY), power)
        farthest = abs(end) * uniform(rng, 0.2, PAST_END) if np.isfinite(end) else way
        last.append([s * min(way, farthest)])
    degrees = np.array(last) * (np.arange(ROWS) / (ROWS - 1))
    return block(linkage, "parallel axes", found, degrees)


FAMILY = Family(
    "parallel axes",
    "R C C C whose axes are parallel but for 1e-3 to 1e-14 rad",
    ROWS,
    (_make,),
)
