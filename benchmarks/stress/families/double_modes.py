"""First rows so near to a dead centre that two assemblies nearly coincide; `near` says which."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmarks.stress.draws import magnitude, uniform
from benchmarks.stress.families import shapes
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.moving import turning
from benchmarks.stress.linkages.writing import number
from benchmarks.stress.numbers.double_double import DEGREE, radians
from benchmarks.stress.quantity import Rows, Truth
from benchmarks.stress.reach import reach
from benchmarks.stress.sweeps import FULL, towards, written_truth

ROWS = 20
POWERS = (-12, 0)
BACK = 0.8
"""Part of the way to the drawing that the rows go back."""


def _make(generators: Sequence[random.Random]) -> Block:
    drawn = shapes.rssr(generators, [0] * len(generators))
    found = reach(drawn.margin, len(generators))
    sense, ends = towards(found, generators)
    flips, first, last = [], [], []
    for rng, s, end in zip(generators, sense[:, 0], ends, strict=True):
        flips.append([rng.choice((-1.0, 1.0))])
        far = end if np.isfinite(end) else s * FULL
        distance = min(magnitude(rng, *POWERS), 0.1 * abs(far))
        first.append([far - s * distance])
        last.append([far * (1.0 - BACK * uniform(rng, 0.2, 1.0))])
    # rows lie closer where the assemblies do
    steps = (np.arange(ROWS) / (ROWS - 1)) ** 2
    degrees = np.array(first) + (np.array(last) - np.array(first)) * steps
    linkage = replace(drawn, assembly=np.array(flips))
    (start,) = linkage.quantities(turning(degrees[:, :1]))
    near = (start.value.value / DEGREE).high[:, 0]
    texts = [
        linkage.text(k, "double modes", row, f"assembly: {{near: {{D.theta: {number(near[k])}}}}}")
        for k, row in enumerate(degrees)
    ]

    def truth(places: Rows) -> Truth:
        exists, decided = found.decide(radians(places))
        return Truth(linkage.quantities(turning(places)), exists, decided, linkage.size())

    return Block(texts, degrees, truth, written_truth(linkage))


FAMILY = Family(
    "double modes",
    "R S S R that start 1 to 1e-12 degrees from a dead centre, in either of its two assemblies",
    ROWS,
    (_make,),
)
