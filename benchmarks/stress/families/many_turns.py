"""Cranks that turn up to 10 000 times; whole turns of every link count."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import partial

from benchmarks.stress.draws import uniform
from benchmarks.stress.families.whole_turns import whole_turns
from benchmarks.stress.family import Block, Family

ROWS = 40
DEGREES = 360.0 * 10_000
GAPS = (0.05, 0.15)


def _make(count: int, generators: Sequence[random.Random]) -> Block:
    return whole_turns(
        generators, "many turns", count, lambda rng: uniform(rng, *GAPS), 0.1, DEGREES, ROWS
    )


FAMILY = Family(
    "many turns",
    "one to three planar drag links whose crank turns 1000 to 10 000 times",
    ROWS,
    tuple(partial(_make, count) for count in (1, 2, 3)),
    proven=40,
)
