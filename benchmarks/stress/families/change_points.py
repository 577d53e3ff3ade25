"""Drag links in a row, each of them 1e-1 to 1e-12 of its crank away from a change point."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import partial

from benchmarks.stress.draws import magnitude
from benchmarks.stress.families.whole_turns import whole_turns
from benchmarks.stress.family import Block, Family

ROWS = 40
POWERS = (-12, -1)
DEGREES = 400.0


def _make(count: int, generators: Sequence[random.Random]) -> Block:
    return whole_turns(
        generators, "change points", count, lambda rng: magnitude(rng, *POWERS), 0.5, DEGREES, ROWS
    )


FAMILY = Family(
    "change points",
    "one to three planar drag links in a row, each 1e-1 to 1e-12 from a change point",
    ROWS,
    tuple(partial(_make, count) for count in (1, 2, 3)),
)
