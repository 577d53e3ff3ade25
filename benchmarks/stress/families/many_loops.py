"""Forty loops in a row, each a block that hangs on the one before."""

from __future__ import annotations

import random
from collections.abc import Sequence

from benchmarks.stress.draws import uniform
from benchmarks.stress.families.whole_turns import whole_turns
from benchmarks.stress.family import Block, Family

ROWS = 100
LOOPS = 40
DEGREES = 400.0
GAPS = (0.1, 0.2)


def _make(generators: Sequence[random.Random]) -> Block:
    return whole_turns(
        generators, "many loops", LOOPS, lambda rng: uniform(rng, *GAPS), 0.2, DEGREES, ROWS
    )


FAMILY = Family(
    "many loops",
    "forty planar drag links in a row",
    ROWS,
    (_make,),
    weight=0.1,
)
