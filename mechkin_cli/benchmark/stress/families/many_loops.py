"""Forty loops in a row, each a block that hangs on the one before."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from mechkin_cli.benchmark.stress.draws import uniform
from mechkin_cli.benchmark.stress.families.shapes import drag_links
from mechkin_cli.benchmark.stress.family import Block, Family
from mechkin_cli.benchmark.stress.sweeps import full_turns

ROWS = 100
LOOPS = 40
TURNS = 400.0
GAPS = (0.1, 0.2)


def _make(generators: Sequence[random.Random]) -> Block:
    gaps = [[uniform(rng, *GAPS) for _ in range(LOOPS)] for rng in generators]
    train = drag_links(generators, LOOPS, gaps)
    last = [[rng.choice((-1.0, 1.0)) * uniform(rng, 0.2, 1.0) * TURNS] for rng in generators]
    degrees = np.array(last) * (np.arange(ROWS) / (ROWS - 1))
    return full_turns(train, "many loops", degrees)


FAMILY = Family("many loops", "forty planar drag links in a row", ROWS, (_make,))
