"""One number for the rows of a variant; rows without a solution do not count.

Sums are added row by row, in order: their bits do not depend on the machine.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats

Reduction = Callable[["Floats"], "Floats"]
"""From values (variants, rows), nan where there is none, to (variants,)."""


def largest(values: Floats) -> Floats:
    """The largest value."""
    found: Floats = np.fmax.reduce(values, axis=1) + 0.0
    return found


def smallest(values: Floats) -> Floats:
    """The smallest value."""
    found: Floats = np.fmin.reduce(values, axis=1) + 0.0
    return found


def peak(values: Floats) -> Floats:
    """The largest magnitude."""
    return largest(np.abs(values))


def span(values: Floats) -> Floats:
    """The difference of the largest and the smallest value."""
    return largest(values) - smallest(values)


def mean(values: Floats) -> Floats:
    """The mean of the values."""
    total, count = _sum(values)
    return total / count


def root_mean_square(values: Floats) -> Floats:
    """The root of the mean of the squares."""
    total, count = _sum(values * values)
    return np.sqrt(total / count)


def _sum(values: Floats) -> tuple[Floats, Floats]:
    """Sum and number of the values that are there; nan where there is none."""
    there = ~np.isnan(values)
    total = np.zeros(len(values))
    for row in range(values.shape[1]):
        total = total + np.where(there[:, row], values[:, row], 0.0)
    count = np.count_nonzero(there, axis=1).astype(np.float64)
    return total, np.where(count == 0.0, np.nan, count)


REDUCTIONS: dict[str, Reduction] = {
    "max": largest,
    "min": smallest,
    "peak": peak,
    "range": span,
    "mean": mean,
    "rms": root_mean_square,
}
"""By the names under which they are asked for."""
