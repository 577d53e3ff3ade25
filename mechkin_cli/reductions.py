"""One number for many rows; rows without a value do not count.

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


def mean(values: Floats, weights: Floats | None = None) -> Floats:
    """The mean of the values; `weights` of the rows (rows,), None: each counts the same."""
    total, count = _sum(values, weights)
    return total / count


def root_mean_square(values: Floats, weights: Floats | None = None) -> Floats:
    """The root of the mean of the squares, as `mean`."""
    # a power of two in front keeps squares from running over, and changes no bit
    _, exponent = np.frexp(peak(values))
    scaled = np.ldexp(values, -exponent[:, None])
    total, count = _sum(scaled * scaled, weights)
    return np.ldexp(np.sqrt(total / count), exponent)


def row_weights(at: Floats) -> Floats:
    """What rows at these places (rows,) count for in a mean over the way: half the way to each
    neighbour, as the trapezoidal rule has it; all the same where nothing moves."""
    half = 0.5 * np.abs(np.diff(at))
    weights = np.zeros(at.shape)
    weights[:-1] += half
    weights[1:] += half
    return weights if weights.any() else np.ones(at.shape)


def _sum(values: Floats, weights: Floats | None) -> tuple[Floats, Floats]:
    """Weighted sum and weight of the values that are there; nan where there is none."""
    there = ~np.isnan(values)
    if weights is None:
        total = _in_order(np.where(there, values, 0.0))
        count = np.count_nonzero(there, axis=1).astype(np.float64)
    else:
        total = _in_order(np.where(there, values * weights, 0.0))
        count = _in_order(np.where(there, weights, 0.0))
    return total, np.where(count == 0.0, np.nan, count)


def _in_order(values: Floats) -> Floats:
    """Sums over the rows, one after the other."""
    found: Floats = np.cumsum(values, axis=1)[:, -1]
    return found


REDUCTIONS: dict[str, Reduction] = {
    "max": largest,
    "min": smallest,
    "peak": peak,
    "range": span,
    "mean": mean,
    "rms": root_mean_square,
}
"""By the names under which they are asked for."""
