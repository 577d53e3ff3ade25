"""Random numbers for the search of assemblies: the same on every machine and with every NumPy.

NumPy keeps the raw stream of PCG64, not what its generators make of it.
"""

from __future__ import annotations

from math import ldexp, pi
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import functions

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

SEED = 20_240_229
"""Fixed, so that the same file gives the same starts."""

ROUNDING = ldexp(1.0, -53)


class RandomStarts:
    """A stream of random coordinates."""

    def __init__(self) -> None:
        self._bits = np.random.PCG64(SEED)

    def fractions(self, count: int) -> Floats:
        """Uniform in [0, 1): the upper 53 bits of each word."""
        words = np.atleast_1d(self._bits.random_raw(count))
        return (words >> np.uint64(11)).astype(np.float64) * ROUNDING

    def between(self, half: float, count: int) -> Floats:
        """Uniform in [-half, half)."""
        return half * (2.0 * self.fractions(count) - 1.0)

    def quaternions(self, count: int) -> Floats:
        """Rotations without preferred direction (Shoemake 1992), (4, count)."""
        share, first, second = (self.fractions(count) for _ in range(3))
        near, far = np.sqrt(1.0 - share), np.sqrt(share)
        first, second = 2.0 * pi * first, 2.0 * pi * second
        return np.stack(
            [
                near * functions.sin(first),
                near * functions.cos(first),
                far * functions.sin(second),
                far * functions.cos(second),
            ]
        )
