"""Spindles of leads from 1e-6 to 1e6 m that drive a rocker of about one by nut and rod."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from benchmarks.stress.draws import array, direction, magnitude, point, transposed
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.moving import turning
from benchmarks.stress.linkages.screw import Screw
from benchmarks.stress.numbers.double_double import DoubleDouble
from benchmarks.stress.quantity import Rows, Truth
from benchmarks.stress.sweeps import written_truth

ROWS = 40
POWERS = (-6, 6)
FARTHEST = 1.5
"""Of the nut, in m."""
TURNS = 2000.0
"""Of the spindle at most: turns of a thread are followed one by one."""
PLACES = 65
CLEAR = 0.05
"""Square of the sine of the angle at a dead centre that all rows stay away by."""


def _make(generators: Sequence[random.Random]) -> Block:
    places, axes, leads = [], [], []
    for rng in generators:
        far = [2.0 + x for x in point(rng, 0.5)]
        places.append([point(rng), [f + x for f, x in zip(far, direction(rng), strict=True)], far])
        axes.append([direction(rng), direction(rng)])
        leads.append([rng.choice((-1.0, 1.0)) * magnitude(rng, *POWERS)])
    b, c, d = transposed(places)
    way, rocker = transposed(axes)
    screw = Screw((b, c, d), (way, rocker), array(leads))
    senses = np.array([[rng.choice((-1.0, 1.0))] for rng in generators])
    last = senses * np.minimum(_clear(screw, senses), TURNS * np.abs(screw.leads))
    degrees = -last / screw.leads * 360.0 * (np.arange(ROWS) / (ROWS - 1))
    texts = [screw.text(k, "leads", row) for k, row in enumerate(degrees)]

    def truth(given: Rows) -> Truth:
        every = np.ones(given.shape, bool)
        return Truth(screw.quantities(turning(given)), every, every, screw.size())

    return Block(texts, degrees, truth, written_truth(screw))


def _clear(screw: Screw, senses: Rows) -> Rows:
    """How far each nut goes and keeps clear of dead centres, (mechanisms, 1): its margin is a
    polynomial of degree four, far from zero at all of many places."""
    steps = np.arange(PLACES) / (PLACES - 1) * FARTHEST
    found = screw.swing(DoubleDouble(senses * steps))
    clear = found.discriminant.high > CLEAR * (found.radius * found.radius).high
    good = np.minimum.accumulate(clear, axis=1).sum(axis=1, keepdims=True)
    farthest: Rows = steps[np.maximum(good - 1, 0)]
    return farthest


FAMILY = Family(
    "leads",
    "spindles of leads from 1e-6 to 1e6 m that drive a rocker by nut and rod",
    ROWS,
    (_make,),
    proven=10,
)
