"""Where Andrews' squeezer would rest under its spring and its torque: the stationary places of its
energy, which goes by two circles alone."""

from __future__ import annotations

import math

import numpy as np
import pytest
from response import benchmarks
from scipy import optimize

import mechkin_cli as mk

A, B, C = np.array([-0.06934, -0.00227]), np.array([-0.03635, 0.03273]), np.array([0.014, 0.072])
START = benchmarks.SQUEEZER_START


def joint(beta: float, side: float) -> np.ndarray:
    """P at an angle of the crank, on one side of the line from the crank's pin to B."""
    pin = 0.007 * np.array([math.cos(beta), math.sin(beta)])
    reach = B - pin
    apart = math.hypot(*reach)
    along = (apart**2 + 0.028**2 - 0.035**2) / (2 * apart)
    e = reach / apart
    return pin + along * e + side * math.sqrt(0.028**2 - along**2) * np.array([-e[1], e[0]])


def energy(beta: float, side: float) -> float:
    """V (J) there."""
    p = joint(beta, side)
    # P = B + 0.035 (sin gamma, -cos gamma), D = B + 0.02 (cos, sin) + 0.018 (sin, -cos)
    sine, cosine = (p[0] - B[0]) / 0.035, -(p[1] - B[1]) / 0.035
    d = B + 0.02 * np.array([cosine, sine]) + 0.018 * np.array([sine, -cosine])
    return float(2265 * (math.hypot(*(d - C)) - 0.07785) ** 2 - 0.033 * beta)


def stationary() -> list[float]:
    found = []
    grid = np.linspace(-math.pi, math.pi, 2001) + 1e-4
    for side in (1.0, -1.0):

        def slope(x: float, side: float = side) -> float:
            h = 1e-4
            far = energy(x + 2 * h, side) - energy(x - 2 * h, side)
            near = energy(x + h, side) - energy(x - h, side)
            return (8 * near - far) / (12 * h)

        values = [slope(x) for x in grid]
        for k in range(grid.size - 1):
            if values[k] * values[k + 1] < 0.0:
                root = optimize.brentq(slope, grid[k], grid[k + 1], xtol=1e-13)
                # the pairs of bars from A reach P
                if 0.02 < math.hypot(*(joint(root, side) - A)) < 0.06:
                    found.append(root)
    return sorted(math.remainder(x, 2 * math.pi) for x in found)


def test_the_stationary_places_of_the_squeezer() -> None:
    m = mk.loads(benchmarks.squeezer())
    r = m.equilibrium(window={"O.theta": (-math.pi, math.pi)})
    crank = [math.remainder(x + START["beta"], 2 * math.pi) for x in r["O.theta"]]
    distinct = sorted(x for k, x in enumerate(crank) if all(abs(x - y) > 1e-7 for y in crank[:k]))
    wanted = stationary()
    assert distinct == pytest.approx(wanted, abs=1e-8)
    # four ways to assemble the two pairs of bars at each
    assert all(sum(abs(x - y) < 1e-7 for y in crank) == 4 for x in distinct)
    assert len(wanted) == 2
    near = m.equilibrium(near={"O.theta": 0.0})
    assert min(abs(near["O.theta"][0] + START["beta"] - x) for x in wanted) < 1e-9
