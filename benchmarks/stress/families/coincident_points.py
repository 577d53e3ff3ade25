"""Frame and rod of 1e-3 to 1e-14 beside arms of about one: couplings of nearly equal shafts."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from benchmarks.stress.draws import direction, scaled, transposed, uniform
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.rssr import Rssr
from benchmarks.stress.linkages.train import FourBar, Train
from benchmarks.stress.sweeps import through

ROWS = 40
POWERS = (-14, -3)


def _planar(generators: Sequence[random.Random]) -> Block:
    corners = []
    for rng in generators:
        power = rng.randint(*POWERS)
        frame = [scaled(x, power) for x in direction(rng)[:2]]
        rod = [scaled(uniform(rng, 1.0, 3.0) * x, power) for x in direction(rng)[:2]]
        corners.append([frame, direction(rng)[:2], rod])
    feet, crank, rods = transposed(corners)
    bar = FourBar((np.zeros_like(crank), crank, crank + rods, feet))
    return through(Train((bar,)), "coincident points", generators, ROWS)


def _spatial(generators: Sequence[random.Random]) -> Block:
    places, axes = [], []
    for rng in generators:
        power = rng.randint(*POWERS)
        frame = [scaled(x, power) for x in direction(rng)]
        rod = [scaled(x, power) for x in direction(rng)]
        axis = direction(rng)
        slant = [u + scaled(x, power) for u, x in zip(axis, direction(rng), strict=True)]
        places.append([frame, direction(rng), rod])
        axes.append([axis, slant])
    feet, crank, rods = transposed(places)
    one, two = transposed(axes)
    linkage = Rssr((np.zeros_like(crank), crank, crank + rods, feet), (one, two))
    return through(linkage, "coincident points", generators, ROWS)


FAMILY = Family(
    "coincident points",
    "planar four-bars and R S S R with frame and rod of 1e-3 to 1e-14 beside arms of one",
    ROWS,
    (_planar, _spatial),
)
