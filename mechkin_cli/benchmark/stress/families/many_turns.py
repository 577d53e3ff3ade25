"""Cranks that turn up to 10 000 times; whole turns of every link count."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import partial

import numpy as np

from mechkin_cli.benchmark.stress.draws import uniform
from mechkin_cli.benchmark.stress.families.shapes import drag_links
from mechkin_cli.benchmark.stress.family import Block, Family
from mechkin_cli.benchmark.stress.sweeps import full_turns

ROWS = 40
DEGREES = 360.0 * 10_000
GAPS = (0.05, 0.15)


def _make(count: int, generators: Sequence[random.Random]) -> Block:
    gaps = [[uniform(rng, *GAPS) for _ in range(count)] for rng in generators]
    train = drag_links(generators, count, gaps)
    last = [[rng.choice((-1.0, 1.0)) * uniform(rng, 0.1, 1.0) * DEGREES] for rng in generators]
    degrees = np.array(last) * (np.arange(ROWS) / (ROWS - 1))
    return full_turns(train, "many turns", degrees)


FAMILY = Family(
    "many turns",
    "one to three planar drag links whose crank turns 1000 to 10 000 times",
    ROWS,
    tuple(partial(_make, count) for count in (1, 2, 3)),
    certified=False,
)
