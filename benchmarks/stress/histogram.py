"""Counts of positive numbers in bins of an eighth of their power of two: small, exact, and the same
whatever the order in which parts are added."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from benchmarks.stress.quantity import Rows

BINS = 8
"""Of each power of two."""
ZERO = -(10**6)
"""Bin of what is zero."""


class Histogram:
    """Bins by number, each from (1 + part / BINS) 2^power up."""

    def __init__(self, counts: Mapping[int, int] | None = None) -> None:
        self.counts = Counter(counts or {})

    def add(self, values: Rows) -> None:
        """All that is finite; what is infinite counts as the largest double."""
        values = values[~np.isnan(values)]
        fraction, power = np.frexp(np.minimum(values, np.finfo(float).max))
        bins = power.astype(int) * BINS + np.floor((fraction - 0.5) * 2 * BINS).astype(int)
        bins = np.where(values > 0.0, bins, ZERO)
        for key, count in zip(*np.unique(bins, return_counts=True), strict=True):
            self.counts[int(key)] += int(count)

    def merge(self, other: Histogram) -> None:
        """Counts of another one are added."""
        self.counts.update(other.counts)

    @property
    def total(self) -> int:
        """Of all that was counted."""
        return sum(self.counts.values())

    def quantile(self, part: float) -> float | None:
        """The upper edge of the bin with this part of all below it; None where there are none."""
        if not self.counts:
            return None
        wanted, seen = part * self.total, 0
        for key in sorted(self.counts):
            seen += self.counts[key]
            if seen >= wanted:
                return _edge(key)
        return _edge(max(self.counts))

    @property
    def largest(self) -> float | None:
        """The upper edge of the last bin."""
        return _edge(max(self.counts)) if self.counts else None


def _edge(key: int) -> float:
    if key == ZERO:
        return 0.0
    power, part = divmod(key, BINS)
    return float(np.ldexp(0.5 + (part + 1) / (2 * BINS), power))
