"""Means over the way from their definition, one stretch after the other."""

import numpy as np


def mean_over_the_way(values: np.ndarray, at: np.ndarray) -> float:
    """The integral over the stretches with finite values at both ends, by their length (rows,)."""
    total = way = 0.0
    for k in range(values.size - 1):
        first, second = values[k], values[k + 1]
        if not np.isfinite([first, second]).all() or at[k + 1] == at[k]:
            continue
        step = abs(at[k + 1] - at[k])
        total += step * (first + second) / 2.0
        way += step
    if way:
        return float(total / way)
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else np.nan


def rms_over_the_way(values: np.ndarray, at: np.ndarray) -> float:
    """The root of the mean of the squares."""
    return float(np.sqrt(mean_over_the_way(values * values, at)))
