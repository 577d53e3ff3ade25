"""A spring on an angle counts its turns: a place a whole turn further is no equilibrium of it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import mechkin_cli as mk

TEXT = """format: 1
units: {{angle: rad}}
links: {{a: {{mass: 2, center_of_mass: [0, -0.25, 0]}}}}
joints: {{A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
  - {{type: spring, joint: A, coordinate: theta, stiffness: {stiffness}, free: {free}}}
equilibria: {{all: {{window: {{A.theta: {{from: {low}, to: {high}}}}}}}}}
"""


def exact(stiffness: float, free: float, low: float, high: float) -> list[float]:
    """Where m g l sin + k (angle - free) is zero."""

    def moment(t: float) -> float:
        return 2 * 9.81 * 0.25 * np.sin(t) + stiffness * (t - free)

    grid = np.linspace(low, high, 4001)
    signs = np.sign([moment(t) for t in grid])
    return [
        brentq(moment, grid[k], grid[k + 1], xtol=1e-14) for k in np.flatnonzero(np.diff(signs))
    ]


@pytest.mark.parametrize(
    ("stiffness", "free", "low", "high"),
    [
        (2.0, 0.7, -3, 3),
        (0.3, 0.7, -3, 3),
        (0.3, 0.7, 3, 9),
        (0.3, 5.0, -3, 3),
        (0.3, 0.7, -12, 12),
    ],
)
def test_all_equilibria_in_a_window(stiffness: float, free: float, low: float, high: float) -> None:
    text = TEXT.format(stiffness=stiffness, free=free, low=low, high=high)
    r = mk.loads(text).equilibrium("all")
    wanted = exact(stiffness, free, low, high)
    assert np.sort(r["A.theta"]) == pytest.approx(wanted, abs=1e-9)
