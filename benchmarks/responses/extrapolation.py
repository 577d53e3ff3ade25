"""Motions far more exact than what is measured: Gragg's midpoint rule, extrapolated, in numpy's
widest numbers (W. B. Gragg, SIAM J. Numer. Anal. 2, 1965; E. Hairer, S. P. Norsett, G. Wanner,
Solving Ordinary Differential Equations I, 1993, II.9)."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np

COLUMNS = 9
"""Of the table of extrapolation: order 18."""


def extrapolated(rates: Callable[[Any], Any], start: Any, moments: Any, parts: int) -> Any:
    """The states (states, moments) of y' = rates(y) from `start` at the first moment, with `parts`
    large steps between two moments."""
    y = np.array(start, np.longdouble)
    found = [y]
    for before, after in pairwise(moments):
        step = (np.longdouble(after) - np.longdouble(before)) / parts
        for _ in range(parts):
            y = _large_step(rates, y, step)
        found.append(y)
    return np.array(found).T


def _large_step(rates: Callable[[Any], Any], y: Any, step: Any) -> Any:
    first = rates(y)
    row: list[Any] = []
    for k in range(1, COLUMNS + 1):
        new = [_midpoint(rates, y, first, step, 2 * k)]
        for j in range(1, k):
            ratio = np.longdouble(k) / (k - j)
            new.append(new[-1] + (new[-1] - row[j - 1]) / (ratio * ratio - 1))
        row = new
    return row[-1]


def _midpoint(rates: Callable[[Any], Any], y: Any, first: Any, step: Any, count: int) -> Any:
    h = step / count
    before, here = y, y + h * first
    for _ in range(count - 1):
        before, here = here, before + 2 * h * rates(here)
    return (here + before + h * rates(here)) / 2
