"""Rates and reactions of single rows against an independent solution at 40 digits.

What the tables of the source leave out: every joint coordinate with its rates, angular velocities,
all components of every joint's wrench.
"""

from __future__ import annotations

import numpy as np
import pytest
from oracle import mp, newton_euler, read, solve
from references import RCSR

ROWS = (0, 9, 18, 26)
DEGREE = mp.pi / 180
LINKS = ("crank", "coupler", "rocker")
JOINTS = ("O1", "O2", "O3", "O4")


@pytest.fixture(scope="module")
def mechanism():
    return read(RCSR)


@pytest.fixture(scope="module")
def solutions(mechanism, analysis):
    """The oracle's rows, each sought from the coordinates of the row under test."""
    found = {}
    for row in ROWS:
        guess = {
            "O2.theta": analysis["O2.theta"][row] * DEGREE,
            "O2.s": analysis["O2.s"][row],
            "O4.theta": analysis["O4.theta"][row] * DEGREE,
        }
        found[row] = solve(mechanism, mechanism.row(row), guess)
    return found


@pytest.fixture(scope="module")
def loads(mechanism, solutions):
    return {row: newton_euler(mechanism, solution) for row, solution in solutions.items()}


def close(value, expected, tolerance, size=0):
    """Componentwise, relative to the largest component, or to `size` where that is larger."""
    value, expected = np.atleast_1d(value), np.atleast_1d(expected)
    errors = [abs(mp.mpf(float(v)) - e) for v, e in zip(value, expected, strict=True)]
    return max(errors) <= tolerance * max(size, *map(abs, expected))


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("coordinate", ["O1.theta", "O2.theta", "O2.s", "O4.theta"])
def test_rates_of_coordinates(analysis, solutions, row, coordinate):
    for suffix in ("_dot", "_ddot"):
        name = coordinate + suffix
        largest = max(abs(solution[name]) for solution in solutions.values())
        assert close(analysis[name][row], solutions[row][name], 2e-14, largest)


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("link", LINKS)
def test_angular_rates(analysis, solutions, row, link):
    assert close(analysis[f"{link}.omega"][row], solutions[row].omega(link), 2e-14)
    assert close(analysis[f"{link}.alpha"][row], solutions[row].alpha(link), 2e-14)


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("point", ["pm1", "pm2", "pm3", "o2", "o3"])
def test_rates_of_points(analysis, solutions, row, point):
    for order, word in ((1, "velocity"), (2, "acceleration")):
        expected = solutions[row].point(point)[order]
        largest = max(abs(c) for s in solutions.values() for c in s.point(point)[order])
        assert close(analysis[f"{point}.{word}"][row], expected, 2e-14, largest)


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("joint", JOINTS)
def test_wrenches(analysis, loads, row, joint):
    about_origin = loads[row].moment_about_origin[joint]
    assert close(analysis[f"{joint}.force"][row], loads[row].force[joint], 1e-13)
    assert close(analysis[f"{joint}.moment_about_origin"][row], about_origin, 1e-13)


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("joint", ["O1", "O2", "O4"])
def test_moments_about_the_joint(analysis, loads, row, joint):
    """Where the lines of action pass near the joint, moments of the joint's own force cancel."""
    expected = loads[row].moment[joint]
    one_inch = max(map(abs, loads[row].force[joint]))
    assert close(analysis[f"{joint}.moment"][row], expected, 1e-13, one_inch)


@pytest.mark.parametrize("row", ROWS)
def test_effort(analysis, loads, row):
    assert close(analysis["O1.effort"][row], loads[row].effort["O1.theta"], 1e-13)


@pytest.mark.parametrize("row", ROWS)
def test_the_sphere_transmits_no_moment(analysis, row):
    arm = np.abs(analysis["O3.point"][row]).max()
    force = np.abs(analysis["O3.force"][row]).max()
    assert np.abs(analysis["O3.moment"][row]).max() <= 1e-15 * arm * force


@pytest.mark.parametrize("row", ROWS)
def test_ground_feels_all_inertia_and_all_loads(analysis, loads, row):
    """What the links exert on ground is the opposite of the ground joints' wrenches."""
    force = [-(a + b) for a, b in zip(*(loads[row].force[j] for j in ("O1", "O4")), strict=True)]
    assert close(analysis["ground.shaking_force"][row], force, 1e-13)
