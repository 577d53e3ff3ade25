"""Points of 1 kg that hang on each other by massless bars, whose equations of motion are dense."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81


def points_on_bars(begin: Sequence[float], times: Sequence[float], tolerance: float) -> np.ndarray:
    """Angles (times, bars) against the vertical of as many bars as begin at some angles, at rest;
    they are 1 m long together."""
    count = len(begin)
    length = 1.0 / count
    # of the points that each two bars carry both
    carried = count - np.maximum.outer(np.arange(count), np.arange(count))
    weights = GRAVITY * (count - np.arange(count)) / length

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        angles, speeds = np.split(state, 2)
        apart = angles[:, None] - angles
        right = -(carried * np.sin(apart)) @ speeds**2 - weights * np.sin(angles)
        return np.concatenate([speeds, np.linalg.solve(carried * np.cos(apart), right)])

    start = np.concatenate([begin, np.zeros(count)])
    span = times[0], times[-1]
    found = solve_ivp(rates, span, start, "DOP853", times, rtol=tolerance, atol=tolerance)
    return np.asarray(found.y[:count].T)
