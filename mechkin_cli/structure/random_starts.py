"""Random numbers for the search of assemblies: the same on every machine and with every NumPy.

SplitMix64 (Steele, Lea, Flood 2014): the words are a hash of a counter, so a whole array of them
costs a few operations, and NumPy's random module need not be imported.
"""

from __future__ import annotations

from math import ldexp, pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import functions

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


SEED = 20_240_229
"""Fixed, so that the same file gives the same starts."""

STEP = 0x9E3779B97F4A7C15
MIXERS = ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB))
ROUNDING = ldexp(1.0, -53)


class RandomStarts:
    """A stream of random coordinates."""

    def __init__(self) -> None:
        self._counter = 0

    def skip(self, count: int) -> None:
        """Passes over the next words of the stream."""
        self._counter += count

    def words(self, count: int) -> NDArray[np.uint64]:
        """The next words of the stream."""
        numbers = np.arange(self._counter + 1, self._counter + count + 1, dtype=np.uint64)
        self._counter += count
        z = np.uint64(SEED) + numbers * np.uint64(STEP)
        for shift, factor in MIXERS:
            z = (z ^ (z >> np.uint64(shift))) * np.uint64(factor)
        return z ^ (z >> np.uint64(31))

    def fractions(self, count: int) -> Floats:
        """Uniform in [0, 1): the upper 53 bits of each word."""
        return (self.words(count) >> np.uint64(11)).astype(np.float64) * ROUNDING

    def between(self, half: float, count: int) -> Floats:
        """Uniform in [-half, half)."""
        return half * (2.0 * self.fractions(count) - 1.0)

    def quaternions(self, count: int) -> Floats:
        """Rotations without preferred direction (Shoemake 1992), (4, count)."""
        share, first, second = (self.fractions(count) for _ in range(3))
        near, far = np.sqrt(1.0 - share), np.sqrt(share)
        first, second = 2.0 * pi * first, 2.0 * pi * second
        (s1, c1), (s2, c2) = ((functions.sin(a), functions.cos(a)) for a in (first, second))
        return np.stack([near * s1, near * c1, far * s2, far * c2])
