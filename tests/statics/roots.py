"""Where a moment vanishes, by a dense search of its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq


def roots(moment: Callable[[float], float], low: float, high: float) -> list[float]:
    """All places at which a moment changes its sign, rising; two within 1/40000 of the way may be
    missed."""
    grid = np.linspace(low, high, 40001) + 1e-9  # not at zero
    signs = np.sign([moment(t) for t in grid])
    return [
        brentq(moment, grid[k], grid[k + 1], xtol=1e-14) for k in np.flatnonzero(np.diff(signs))
    ]
