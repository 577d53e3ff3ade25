"""Linkages of everyday shapes that the families begin with."""

from __future__ import annotations

import random
from collections.abc import Sequence

import numpy as np

from benchmarks.stress.draws import (
    direction,
    point,
    scaled,
    transposed,
    uniform,
)
from benchmarks.stress.linkages.rccc import Rccc
from benchmarks.stress.linkages.rssr import Rssr
from benchmarks.stress.linkages.slider import Slider
from benchmarks.stress.linkages.train import FourBar, Train
from benchmarks.stress.quantity import Rows

Generators = Sequence[random.Random]
Powers = Sequence[int]
"""Of ten, on all lengths of each mechanism."""


def _sized(vectors: list[list[float]], power: int) -> list[list[float]]:
    return [[scaled(x, power) for x in vector] for vector in vectors]


def rssr(generators: Generators, powers: Powers) -> Rssr:
    """Arms of about one and a frame of about two sizes."""
    drawn, axes = [], []
    for rng, power in zip(generators, powers, strict=True):
        far = [uniform(rng, 1.0, 2.0), *point(rng)[:2]]
        places = [
            point(rng, 0.2),
            point(rng),
            [f + x for f, x in zip(far, point(rng), strict=True)],
        ]
        drawn.append(_sized([*places, far], power))
        axes.append([direction(rng), direction(rng)])
    a, b, c, d = transposed(drawn)
    crank, rocker = transposed(axes)
    return Rssr((a, b, c, d), (crank, rocker))


def slider(generators: Generators, powers: Powers) -> Slider:
    """A crank of about one, and a rod of about two sizes."""
    drawn, axes = [], []
    for rng, power in zip(generators, powers, strict=True):
        places = [point(rng, 0.2), point(rng), [uniform(rng, 1.0, 3.0), *point(rng)[:2]]]
        drawn.append(_sized(places, power))
        axes.append([direction(rng), direction(rng)])
    a, b, c = transposed(drawn)
    crank, way = transposed(axes)
    return Slider((a, b, c), (crank, way))


def rccc(generators: Generators, powers: Powers) -> Rccc:
    """Axes of any directions through points about one size apart."""
    drawn, axes = [], []
    for rng, power in zip(generators, powers, strict=True):
        drawn.append(_sized([point(rng) for _ in range(4)], power))
        axes.append([direction(rng) for _ in range(4)])
    a, b, c, d = transposed(drawn)
    one, two, three, four = transposed(axes)
    return Rccc((a, b, c, d), (one, two, three, four))


def four_bar(generators: Generators, powers: Powers) -> Train:
    """One planar four-bar of any kind."""
    drawn = []
    for rng, power in zip(generators, powers, strict=True):
        far = [uniform(rng, 0.7, 1.5), 0.0]
        places = [
            [0.0, 0.0],
            point(rng)[:2],
            [f + x for f, x in zip(far, point(rng)[:2], strict=True)],
        ]
        drawn.append(_sized([*places, far], power))
    a, b, c, d = transposed(drawn)
    return Train((FourBar((a, b, c, d)),))


def drag_links(generators: Generators, count: int, gaps: Sequence[Sequence[float]]) -> Train:
    """Four-bars in a row whose frames are the shortest links, so that all of them turn fully.

    `gaps` (mechanisms, count): how much each is away from a change point, in parts of its crank; it
    lies where the crank points along the frame, one way or the other.
    """
    chains = [_chain(rng, own) for rng, own in zip(generators, gaps, strict=True)]
    bars = []
    for k in range(count):
        a, b, c, d = (np.array([chain[k][i] for chain in chains]) for i in range(4))
        bars.append(FourBar((a, b, c, d)))
    return Train(tuple(bars), whole_turns=True)


def _chain(rng: random.Random, gaps: Sequence[float]) -> list[tuple[Rows, ...]]:
    """Corners of one row of four-bars as drawn; each starts from the rocker of the one before."""
    foot, end = np.zeros(2), np.array([0.6, 0.8])
    chain: list[tuple[Rows, ...]] = []
    for gap in gaps:
        arm = end - foot
        crank = float(np.sqrt(arm[0] * arm[0] + arm[1] * arm[1]))
        frame = uniform(rng, 0.2, 0.45) * crank
        slant = _slant(rng)
        next_foot = np.round(foot + frame * slant, 6)
        line = next_foot - foot
        frame = float(np.sqrt(line[0] * line[0] + line[1] * line[1]))
        rod, rocker = _lengths(rng, crank, frame, gap * crank)
        next_end = _corner(end, next_foot, rod, rocker, rng.choice((-1.0, 1.0)))
        chain.append((foot, end, next_end, next_foot))
        foot, end = next_foot, next_end
    return chain


def _slant(rng: random.Random) -> Rows:
    x, y = rng.choice(((0.6, 0.8), (0.8, 0.6), (0.28, 0.96), (0.96, 0.28), (1.0, 0.0)))
    return np.array([x * rng.choice((-1.0, 1.0)), y * rng.choice((-1.0, 1.0))])


def _lengths(rng: random.Random, crank: float, frame: float, gap: float) -> tuple[float, float]:
    """Of rod and rocker: crank and frame may lie in one line, just."""
    if rng.random() < 0.5:  # stretched: rod + rocker = crank + frame + gap
        rocker = crank * uniform(rng, 0.8, 1.0)
        return crank + frame + gap - rocker, rocker
    # folded: rod - rocker = gap - (crank - frame) or the other way round
    short = crank * uniform(rng, 0.85, 1.1)
    long = crank - frame - gap + short
    return (long, short) if rng.random() < 0.5 else (short, long)


def _corner(end: Rows, foot: Rows, rod: float, rocker: float, side: float) -> Rows:
    """Where rod and rocker meet."""
    gap = end - foot
    square = gap[0] * gap[0] + gap[1] * gap[1]
    along = (square + rocker * rocker - rod * rod) / (2.0 * square)
    across = np.sqrt(max(rocker * rocker / square - along * along, 0.0)) * side
    turned = np.array([along * gap[0] - across * gap[1], along * gap[1] + across * gap[0]])
    corner: Rows = foot + turned
    return corner
