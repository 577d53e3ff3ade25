"""Numbers in (0, 1) for the samples of a study.

Any stretch of samples is drawn by itself and is the same whatever was drawn before, so that the
bytes of a study do not depend on the pieces in which it is computed.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


Method = Literal["random", "latin", "sobol"]

BLOCK = 4096
"""Independent samples that come from one generator."""

_INSIDE = (2.0**-54, 1.0 - 2.0**-53)
"""Between these, so that a normal distribution gives a finite value."""


class Draws(Protocol):
    """Samples by number."""

    def stretch(self, begin: int, end: int) -> Floats:
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
    """The samples of a method; `random` ones do not depend on how many there are."""
    if method == "random":
        return _Random(dimensions, seed)
    if method == "latin":
        return _Latin(count, dimensions, seed)
    return _Sobol(dimensions, seed)


class _Random:
    """Independent samples, a generator for each block of them."""

    def __init__(self, dimensions: int, seed: int) -> None:
        self._dimensions, self._seed = dimensions, seed

    def stretch(self, begin: int, end: int) -> Floats:
        first, last = begin // BLOCK, -(-end // BLOCK)
        blocks = [self._block(number) for number in range(first, last)]
        whole = np.concatenate(blocks) if blocks else np.empty((0, self._dimensions))
        return _inside(whole[begin - first * BLOCK : end - first * BLOCK])

    def _block(self, number: int) -> Floats:
        generator = np.random.Generator(
            np.random.Philox(np.random.SeedSequence([self._seed, number]))
        )
        return generator.random((BLOCK, self._dimensions))


class _Latin:
    """A Latin hypercube (McKay, Beckman, Conover 1979): one sample in each of `count` slices of
    every dimension. It is drawn whole."""

    def __init__(self, count: int, dimensions: int, seed: int) -> None:
        from scipy.stats import qmc

        self._points = _inside(_seeded(qmc.LatinHypercube, dimensions, seed).random(count))

    def stretch(self, begin: int, end: int) -> Floats:
        return self._points[begin:end]


class _Sobol:
    """A Sobol sequence, scrambled (Owen 1998)."""

    def __init__(self, dimensions: int, seed: int) -> None:
        self._dimensions, self._seed = dimensions, seed

    def stretch(self, begin: int, end: int) -> Floats:
        from scipy.stats import qmc

        engine = _seeded(qmc.Sobol, self._dimensions, self._seed)
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
