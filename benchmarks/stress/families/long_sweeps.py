"""One sweep of a thousand, of ten thousand, of a hundred thousand and of a million rows."""

from __future__ import annotations

import random
from collections.abc import Sequence
from functools import partial

import numpy as np

from benchmarks.stress.draws import uniform
from benchmarks.stress.families.shapes import drag_links
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.writing import ACCELERATION, RATE, number
from benchmarks.stress.sweeps import turning_truth, written_truth

ROWS = (1_000, 10_000, 100_000, 1_000_000)
BARS = 2
GAPS = (0.01, 0.1)
STEP = 2.0**-7
"""Degrees: rows are exact."""


def _make(rows: int, generators: Sequence[random.Random]) -> Block:
    gaps = [[uniform(rng, *GAPS) for _ in range(BARS)] for rng in generators]
    train = drag_links(generators, BARS, gaps)
    law = f"from: 0, to: {number(STEP * (rows - 1))}, step: {number(STEP)}"
    rates = f"rate: {number(RATE)}, acceleration: {number(ACCELERATION)}"
    motion = f"motion: {{inputs: {{A.theta: {{{law}, {rates}}}}}}}"
    texts = [train.moved(k, "long sweeps", motion) for k in range(len(generators))]
    degrees = np.tile(STEP * np.arange(rows), (len(generators), 1))
    return Block(texts, degrees, turning_truth(train), written_truth(train))


FAMILY = Family(
    "long sweeps",
    "sweeps of up to 1e6 rows of two planar drag links in a row",
    0,
    tuple(partial(_make, rows) for rows in ROWS),
    lengths=ROWS,
)
