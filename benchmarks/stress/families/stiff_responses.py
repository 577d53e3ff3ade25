"""Three masses on springs and dampers whose rates differ by up to a million."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from benchmarks.stress.draws import array, magnitude, uniform
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.oscillator import Oscillator
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.quantity import Rows, Truth

ROWS = 20
SECONDS = 2.0
STIFF = (2, 10)
"""Powers of ten of the stiffness (N/m) of those that creep; one more mass swings slowly."""


def _make(generators: Sequence[random.Random]) -> Block:
    masses, stiffnesses, dampings, starts = [], [], [], []
    for rng in generators:
        mass = [uniform(rng, 0.5, 2.0) for _ in range(3)]
        stiff = [magnitude(rng, *STIFF), magnitude(rng, *STIFF), uniform(rng, 1.0, 40.0)]
        # parts of the damping at which a mass just creeps
        parts = [uniform(rng, 1.1, 30.0), uniform(rng, 1.1, 30.0), uniform(rng, 0.01, 0.9)]
        damping = [
            float(f"{2.0 * p * float(np.sqrt(m * k)):.6g}")
            for m, k, p in zip(mass, stiff, parts, strict=True)
        ]
        masses.append(mass)
        stiffnesses.append(stiff)
        dampings.append(damping)
        starts.append([uniform(rng, 0.2, 1.0) for _ in range(3)])
    oscillator = Oscillator(array(masses), array(stiffnesses), array(dampings), array(starts))
    moments = np.tile(SECONDS * np.arange(ROWS) / (ROWS - 1), (len(generators), 1))
    texts = [oscillator.text(k, "stiff responses", row) for k, row in enumerate(moments)]

    def truth(places: Rows) -> Truth:
        every = np.ones(places.shape, bool)
        quantities = oscillator.quantities(DoubleDouble(places))
        return Truth(quantities, every, every, oscillator.size())

    return Block(texts, moments, truth)


FAMILY = Family(
    "stiff responses",
    "responses of three masses on springs and dampers of rates up to a million apart",
    ROWS,
    (_make,),
    response=True,
    proven=0,
)
