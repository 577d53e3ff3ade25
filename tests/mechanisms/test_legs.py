"""Suspension and platform: rods keep their lengths, and their forces hold the body in balance.

The balance is solved on its own: six forces along known lines against the weight, the load and the
body's inertia.
"""

from __future__ import annotations

import numpy as np
import pytest
from mechanisms.runs import run
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def rod(name: str, number: int) -> Floats:
    return run(name)[f"B{number}.point"] - run(name)[f"A{number}.point"]


def lengths(name: str, number: int) -> Floats:
    vector = rod(name, number)
    return np.sqrt((vector * vector).sum(axis=1))


@pytest.mark.parametrize("number", range(1, 6))
def test_rods_of_the_suspension_keep_their_length(number: int) -> None:
    found = lengths("five_link_suspension", number)
    assert np.abs(found - found[8]).max() < 1e-15 * 700 * found[8]


@pytest.mark.parametrize(
    ("name", "number", "joint"),
    [("five_link_suspension", 6, "strut")] + [("stewart", k, f"L{k}") for k in range(1, 7)],
)
def test_struts_are_as_long_as_they_are_driven(name: str, number: int, joint: str) -> None:
    found, driven = lengths(name, number), run(name)[f"{joint}.s"]
    drawn = np.flatnonzero(driven == 0.0)[0]
    assert np.abs(found - driven - found[drawn]).max() < 1e-12 * found[drawn]


def balance(name: str, force: Floats, moment: Floats) -> Floats:
    """Forces along the six rods that hold a force and a moment about the origin, row by row."""
    rows = []
    for row in range(len(force)):
        columns = []
        for number in range(1, 7):
            line = rod(name, number)[row] / lengths(name, number)[row]
            arm = run(name)[f"A{number}.point"][row]
            columns.append([*line, *np.cross(arm, line)])
        matrix = np.array(columns).T
        rows.append(np.linalg.solve(matrix, [*force[row], *moment[row]]))
    return np.array(rows)


def along(name: str, number: int) -> Floats:
    """What a rod's end exerts on the body it carries, along the rod."""
    found: Floats = (run(name)[f"B{number}.force"] * rod(name, number)).sum(axis=1)
    return found / lengths(name, number)


def test_forces_of_the_suspension() -> None:
    """At rest: weight of the carrier and the wheel load at the contact."""
    name = "five_link_suspension"
    analysis = run(name)
    contact = analysis["contact.position"]
    spindle, wheel = analysis["spindle"], analysis["wheel.position"]
    # the mass centre from two points and the directions drawn along x, y and z
    up = (wheel - contact + 2 * spindle) / 310
    forward = np.cross(spindle, up)
    centre = wheel - 25 * spindle + 2 * up + 0 * forward
    weight = np.array([0.0, 0.0, -32 * 9.81])
    load = np.array([0.0, 0.0, 4000.0])
    force = np.tile(-(weight + load), (len(wheel), 1))
    moment = -(np.cross(centre, weight) + np.cross(contact, load))
    expected = balance(name, force, moment)
    for number in range(1, 7):
        miss = np.abs(along(name, number) - expected[:, number - 1]).max()
        assert miss <= 1e-11 * np.abs(expected).max(), number


def test_forces_of_the_platform() -> None:
    """Legs driven at constant rates: weight and inertia of the platform."""
    name = "stewart"
    analysis = run(name)
    forward, normal = analysis["forward"], analysis["normal"]
    side = np.cross(normal, forward)
    omega, alpha = analysis["platform.omega"], analysis["platform.alpha"]
    centre = analysis["tool.position"] - 0.05 * normal
    arm = -0.05 * normal
    speed = np.cross(omega, np.cross(omega, arm)) + np.cross(alpha, arm)
    acceleration = analysis["tool.acceleration"] + speed
    force = 60 * (acceleration - np.array([0.0, 0.0, -9.81]))

    def times_inertia(vector: Floats) -> Floats:
        parts = ((6, forward), (6, side), (11, normal))
        return sum(k * (vector * axis).sum(axis=1)[:, None] * axis for k, axis in parts)

    couple = times_inertia(alpha) + np.cross(omega, times_inertia(omega))
    expected = balance(name, force, np.cross(centre, force) + couple)
    for number in range(1, 7):
        miss = np.abs(along(name, number) - expected[:, number - 1]).max()
        assert miss <= 1e-11 * np.abs(expected).max(), number
        effort = analysis[f"L{number}.effort"]
        assert np.abs(effort - expected[:, number - 1]).max() <= 1e-11 * np.abs(expected).max()
