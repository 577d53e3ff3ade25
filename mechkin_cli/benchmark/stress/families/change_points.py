"""Drag links in a row, each of them 1e-1 to 1e-12 of its crank away from a change point."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import partial

import numpy as np

from mechkin_cli.benchmark.stress.draws import magnitude, uniform
from mechkin_cli.benchmark.stress.families.shapes import drag_links
from mechkin_cli.benchmark.stress.family import Block, Family
from mechkin_cli.benchmark.stress.sweeps import full_turns

ROWS = 40
POWERS = (-12, -1)
TURNS = 400.0


def _make(count: int, generators: Sequence[random.Random]) -> Block:
    gaps = [[magnitude(rng, *POWERS) for _ in range(count)] for rng in generators]
    train = drag_links(generators, count, gaps)
    last = [[rng.choice((-1.0, 1.0)) * uniform(rng, 0.5, 1.0) * TURNS] for rng in generators]
    degrees = np.array(last) * (np.arange(ROWS) / (ROWS - 1))
    return full_turns(train, "change points", degrees)


FAMILY = Family(
    "change points",
    "one to three planar drag links in a row, each 1e-1 to 1e-12 from a change point",
    ROWS,
    tuple(partial(_make, count) for count in (1, 2, 3)),
)
