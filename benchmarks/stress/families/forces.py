"""Forces of linkages with masses from 1e-3 to 1e3 kg, of 1e-9 to 1e9 m and next to dead centres."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from benchmarks.stress.draws import array, direction, magnitude, uniform
from benchmarks.stress.families import dead_centres, shapes, sizes
from benchmarks.stress.family import Block, Family
from benchmarks.stress.linkages.loaded import Body, Loaded
from benchmarks.stress.linkages.moving import turning
from benchmarks.stress.linkages.rssr import Rssr
from benchmarks.stress.linkages.slider import Slider
from benchmarks.stress.linkages.writing import decimals
from benchmarks.stress.numbers.double_double import DoubleDouble, radians
from benchmarks.stress.quantity import Mask, Rows, Truth
from benchmarks.stress.reach import Reach
from benchmarks.stress.sweeps import swept

ROWS = dead_centres.ROWS
MASSES = (-3, 3)
GRAVITY = 10.0
"""About, m/s^2."""
Shape = Callable[[Sequence[random.Random], Sequence[int]], Rssr | Slider]


def _sized(shape: Shape, generators: Sequence[random.Random]) -> Block:
    powers = [rng.randint(-sizes.LARGEST, sizes.LARGEST) for rng in generators]
    loaded = _loaded(shape(generators, powers), powers, generators)
    return _block(loaded, *swept(loaded, generators, ROWS))


def _near_ends(shape: Shape, generators: Sequence[random.Random]) -> Block:
    powers = [0] * len(generators)
    loaded = _loaded(shape(generators, powers), powers, generators)
    return _block(loaded, *dead_centres.near_ends(loaded, generators))


def _loaded(
    linkage: Rssr | Slider, powers: Sequence[int], generators: Sequence[random.Random]
) -> Loaded:
    crank = _body(linkage.points[1], powers, generators)
    follower = _body(linkage.points[2], powers, generators)
    gravity = [[round(GRAVITY * x, 4) for x in direction(rng)] for rng in generators]
    return Loaded(linkage, crank, follower, array(gravity))


def _body(end: Rows, powers: Sequence[int], generators: Sequence[random.Random]) -> Body:
    """A body whose mass centre is near a point of it."""
    masses, centres, inertias = [], [], []
    for rng, power, point in zip(generators, powers, end, strict=True):
        mass = magnitude(rng, *MASSES)
        centres.append([float(f"{uniform(rng, 0.3, 0.9) * x:.5g}") for x in point])
        # about as far apart as the mass of a body of this size: no two are less than the third
        scale = mass * 0.1 * 10.0 ** (2 * power)
        inertias.append([float(f"{scale * uniform(rng, 0.8, 1.2):.5g}") for _ in range(3)])
        masses.append([mass])
    return Body(array(masses), array(centres), array(inertias))


def _block(loaded: Loaded, found: Reach, degrees: Rows) -> Block:
    texts = [loaded.text(k, "forces", row) for k, row in enumerate(degrees)]
    exact = loaded.as_written()

    def truth(places: Rows) -> Truth:
        return _truth(loaded, DoubleDouble(places), *found.decide(radians(places)))

    def written(places: Rows) -> Truth:
        every = np.ones(places.shape, bool)
        return _truth(exact, decimals(places), every, every)

    return Block(texts, degrees, truth, written)


def _truth(loaded: Loaded, degrees: DoubleDouble, exists: Mask, decided: Mask) -> Truth:
    angle = turning(degrees)
    forces, heaviest = loaded.forces(angle)
    return Truth(loaded.quantities(angle), exists, decided, loaded.size(), forces, heaviest)


FAMILY = Family(
    "forces",
    "reactions and efforts of R S S R and R S S P with masses, of 1e-9 to 1e9 m or 1 to 1e-12 "
    "degrees before a dead centre",
    ROWS,
    tuple(
        partial(make, shape)
        for make in (_sized, _near_ends)
        for shape in (shapes.rssr, shapes.slider)
    ),
)
