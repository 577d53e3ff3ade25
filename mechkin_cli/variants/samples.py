"""Numbers in (0, 1) for the samples of a study.

Any stretch of samples is drawn by itself and is the same whatever was drawn before, so that the
bytes of a study do not depend on the pieces in which it is computed.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


Method = Literal["random", "latin", "sobol"]

BLOCK = 4096
"""Independent samples that come from one generator."""

_INSIDE = (2.0**-54, 1.0 - 2.0**-53)
"""Between these, so that a normal distribution gives a finite value."""


Draws = Callable[[int, int], "Floats"]
"""Samples `begin` to `end` (without it), (samples, dimensions), between 0 and 1."""


def needs_scipy(method: Method, distributions: Iterable[object]) -> bool:
    """Whether something is drawn that numpy does not draw."""
    normals = any(isinstance(one, partial) and one.func is normal for one in distributions)
    return method != "random" or normals


def has_scipy() -> bool:
    """Whether scipy is installed, which is optional."""
    try:
        import scipy.special  # noqa: F401
    except ImportError:
        return False
    return True


def draws(method: Method, count: int, dimensions: int, seed: int) -> Draws:
    """The samples of a method; `random` ones do not depend on how many there are.

    `latin`: a Latin hypercube (McKay, Beckman, Conover 1979), one sample in each of `count` slices
    of every dimension, drawn whole. `sobol`: a scrambled Sobol sequence (Owen 1998).
    """
    if method == "random":
        return partial(_random, dimensions, seed)
    if method == "sobol":
        return partial(_sobol, dimensions, seed)
    from scipy.stats import qmc

    points = _inside(_seeded(qmc.LatinHypercube, dimensions, seed).random(count))
    return lambda begin, end: points[begin:end]


def _random(dimensions: int, seed: int, begin: int, end: int) -> Floats:
    first, last = begin // BLOCK, -(-end // BLOCK)
    blocks = [np.empty((0, dimensions))]
    for number in range(first, last):  # a generator for each block
        sequence = np.random.SeedSequence([seed, number])
        blocks.append(np.random.Generator(np.random.Philox(sequence)).random((BLOCK, dimensions)))
    return _inside(np.concatenate(blocks)[begin - first * BLOCK : end - first * BLOCK])


def _sobol(dimensions: int, seed: int, begin: int, end: int) -> Floats:
    from scipy.stats import qmc

    engine = _seeded(qmc.Sobol, dimensions, seed)
    if begin:
        engine.fast_forward(begin)
    with warnings.catch_warnings():
        # of a stretch, which need not be balanced
        warnings.simplefilter("ignore", UserWarning)
        return _inside(engine.random(end - begin))


def _seeded(engine: Any, dimensions: int, seed: int) -> Any:
    """An engine of scipy; older ones call the generator's argument `seed`."""
    try:
        return engine(dimensions, rng=seed)
    except TypeError:
        return engine(dimensions, seed=seed)


def _inside(values: Floats) -> Floats:
    return np.clip(values, *_INSIDE)


def uniform(samples: Floats, least: float, most: float) -> Floats:
    """Samples (n,) to values evenly between two."""
    return least + samples * (most - least)


def normal(samples: Floats, mean: float, deviation: float) -> Floats:
    """Samples (n,) to values of a normal distribution."""
    from scipy.special import ndtri

    return np.asarray(mean + deviation * ndtri(samples))
