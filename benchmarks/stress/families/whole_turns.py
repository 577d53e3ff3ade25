"""Drag links in a row over whole turns of their crank, as several families sweep them."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence

import numpy as np

from benchmarks.stress.draws import uniform
from benchmarks.stress.families.shapes import drag_links
from benchmarks.stress.family import Block
from benchmarks.stress.sweeps import turning_truth, written_truth


def whole_turns(
    generators: Sequence[random.Random],
    name: str,
    count: int,
    gap: Callable[[random.Random], float],
    least: float,
    degrees: float,
    rows: int,
) -> Block:
    """`count` drag links in a row, each a drawn `gap` from a change point in parts of its crank,
    swept either way in equal steps by at least the part `least` of `degrees`."""
    gaps = [[gap(rng) for _ in range(count)] for rng in generators]
    train = drag_links(generators, count, gaps)
    last = [[rng.choice((-1.0, 1.0)) * uniform(rng, least, 1.0) * degrees] for rng in generators]
    places = np.array(last) * (np.arange(rows) / (rows - 1))
    texts = [train.text(k, name, row) for k, row in enumerate(places)]
    return Block(texts, places, turning_truth(train), written_truth(train))
