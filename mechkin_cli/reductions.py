"""One number for many rows; rows without a value do not count.

A value may be infinite: what grows without bound towards a row at a dead centre. Extremes count it,
and are infinite at its place. Means do not: whether the integral up to there is finite (a rate,
which goes as one over the root of what is left of the way) or not (its square), one row cannot
tell, so the way ends at the last row beside it, as it does where there is no value.

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
    """The difference of the largest and the smallest value; none between infinite ones."""
    with np.errstate(invalid="ignore"):
        return largest(values) - smallest(values)


def mean(values: Floats, at: Floats | None = None) -> Floats:
    """The mean over the way, by the trapezoidal rule over the stretches between neighbouring rows
    that both have a finite value, divided by their length; nan where no row has one.

    A row without a neighbour has no way and does not count beside those that have. Where no
    stretch has a length every row counts the same.

    Args:
        values: (variants, rows).
        at: where the rows stand, (rows,) or (variants, rows); None: nowhere, as where nothing
            moves.
    """
    total, count = _sum(values, None if at is None else _ways(values, at))
    return total / count


def root_mean_square(values: Floats, at: Floats | None = None) -> Floats:
    """The root of the mean of the squares, as `mean`."""
    # a power of two in front keeps squares from running over, and changes no bit
    _, exponent = np.frexp(peak(np.where(np.isfinite(values), values, np.nan)))
    scaled = np.ldexp(values, -exponent[:, None])
    total, count = _sum(scaled * scaled, None if at is None else _ways(values, at))
    return np.ldexp(np.sqrt(total / count), exponent)


def row_weights(at: Floats) -> Floats:
    """What rows at these places (rows,) count for in a mean over the way where all have a value:
    half the way to each neighbour; all the same where nothing moves."""
    weights = _halves(0.5 * np.abs(np.diff(at)))
    return weights if weights.any() else np.ones(at.shape)


def _ways(values: Floats, at: Floats) -> Floats:
    """What rows count for, (rows,) or (variants, rows): half of each stretch at whose other end
    there is a finite value, too."""
    there = np.isfinite(values)
    if at.ndim == 2 and bool((at == at[:1]).all()):
        at = at[0]
    if at.ndim == 1 and there.all():
        return row_weights(at)
    both = there[:, 1:] & there[:, :-1]
    weights = _halves(np.where(both, 0.5 * np.abs(np.diff(at)), 0.0))
    weights[~weights.any(axis=1)] = 1.0
    return weights


def _halves(stretches: Floats) -> Floats:
    """The sum of the two stretches that meet in each row."""
    weights = np.zeros((*stretches.shape[:-1], stretches.shape[-1] + 1))
    weights[..., :-1] += stretches
    weights[..., 1:] += stretches
    return weights


def _sum(values: Floats, weights: Floats | None) -> tuple[Floats, Floats]:
    """Weighted sum and weight of the finite values; nan where there is none."""
    there = np.isfinite(values)
    if weights is None:
        total = _in_order(np.where(there, values, 0.0))
        count = np.count_nonzero(there, axis=1).astype(np.float64)
    else:
        total = _in_order(np.multiply(values, weights, out=np.zeros(values.shape), where=there))
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

OVER_THE_WAY: tuple[Reduction, ...] = (mean, root_mean_square)
"""Those that take the places of the rows, too."""
