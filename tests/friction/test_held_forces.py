"""Forces in rows of a response while joints stick, against closed forms."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest
from friction.test_several_freedoms import HEAD, G, blocks, errors

import mechkin_cli as mk
from mechkin_cli.verdict import Status

ANGLE = radians(25)
SLOPE = [cos(ANGLE), sin(ANGLE), 0.0]
INCLINE = f"""{HEAD}name: block
links: {{a: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints:
  A: {{type: P, links: [ground, a], point: [0, 0, 0], axis: [{SLOPE[0]!r}, {SLOPE[1]!r}, 0]}}
responses:
  go: {{start: {{A.s: 0, A.s_dot: RATE}}, time: {{from: 0, to: 2, step: 0.1}}}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: A, coefficient: {{static: 0.5, sliding: 0.3}}}}
"""


def test_a_block_on_a_slope_is_held_by_its_share_of_its_weight() -> None:
    names = ["A.s_dot", "A.friction_force", "A.friction_power", "A.normal_load", "A.force"]
    found = mk.loads(INCLINE.replace("RATE", "1")).respond("go", names)
    slides = found["A.s_dot"] != 0.0
    assert slides.any()
    assert not slides.all()
    normal = 2 * G * cos(ANGLE)
    along = np.where(slides, -0.3 * normal, 2 * G * sin(ANGLE))
    assert found["A.friction_force"] == pytest.approx(np.outer(along, SLOPE), abs=1e-12)
    assert found["A.normal_load"] == pytest.approx(normal, rel=1e-13)
    across = np.array([-SLOPE[1], SLOPE[0], 0.0])
    assert found["A.force"] == pytest.approx(np.tile(normal * across, (21, 1)), abs=1e-12)
    assert (found["A.friction_power"][~slides] == 0.0).all()
    assert (found.result.status == Status.ok).all()
    assert found.complete


def test_a_block_that_starts_to_slide_has_the_coefficient_of_sliding_in_its_first_row() -> None:
    steep = radians(35)
    axis = f"[{cos(steep)!r}, {sin(steep)!r}, 0]"
    text = INCLINE.replace(f"[{SLOPE[0]!r}, {SLOPE[1]!r}, 0]", axis).replace("RATE", "0")
    found = mk.loads(text).respond("go", ["A.s_ddot", "A.friction_force"])
    down = G * (sin(steep) - 0.3 * cos(steep))
    assert found["A.s_ddot"] == pytest.approx(np.full(21, -down), rel=1e-10)
    size = np.linalg.norm(found["A.friction_force"], axis=1)
    assert size == pytest.approx(np.full(21, 0.3 * 2 * G * cos(steep)), rel=1e-10)


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_the_upper_block_is_carried_by_what_it_weighs_against_its_acceleration(
    mirror: float,
) -> None:
    names = ["B.s_dot", "A.friction_force", "B.friction_force", "B.normal_load", "A.normal_load"]
    found = mk.loads(blocks(mirror=mirror)).respond("go", [*names, "row.power_error"])
    sticks = np.arange(21) > 8
    slides = np.arange(21) < 3
    assert (np.abs(found["B.s_dot"][sticks]) <= 1e-15).all()
    # both go with 3 - 0.2 g: friction leaves the upper one its part of the pull, less 0.2 g
    upper = np.where(sticks, -0.2 * G, -0.4 * G)
    for rows in (sticks, slides):
        found_there = mirror * found["B.friction_force"][rows, 0]
        assert found_there == pytest.approx(upper[rows], abs=1e-10)
        lower = mirror * found["A.friction_force"][rows, 0]
        assert lower == pytest.approx(np.full(rows.sum(), -0.2 * 3 * G), abs=1e-10)
    assert found["B.normal_load"] == pytest.approx(G, rel=1e-12)
    assert found["A.normal_load"] == pytest.approx(3 * G, rel=1e-12)
    assert (found["row.power_error"][1:] <= 1e-12).all()
    assert found.complete


HELD_ARM = f"""{HEAD}name: arm
links:
  a: {{mass: 2, center_of_mass: [0.4, 0, 0], inertia: {{xx: 1, yy: 1, zz: 0.1}}}}
  b: {{mass: 1, center_of_mass: [1.0, 0, 0], inertia: {{xx: 1, yy: 1, zz: 0.05}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [0.7, 0, 0], axis: [0, 0, 1]}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: B, coefficient: 0.9, radius: 0.5}}
responses:
  go: {{start: {{A.theta: -1, B.theta: 0}}, time: {{from: 0, to: 2, step: 0.1}}}}
"""


def test_a_pin_that_sticks_transmits_what_holds_a_rigid_arm_together() -> None:
    """The arm is a pendulum; Newton and Euler of its outer part give the pin's force and moment."""
    names = ["A.theta", "A.theta_dot", "A.theta_ddot", "B.theta", "B.friction_moment", "B.force"]
    found = mk.loads(HELD_ARM).respond("go", [*names, "B.normal_load", "row.energy_error"])
    theta, rate, second = (found[name] for name in names[:3])
    # about A: (0.1 + 2 0.4^2 + 0.05 + 1) theta'' = -(2 0.4 + 1) g cos(theta)
    assert second == pytest.approx(-1.8 * G * np.cos(theta) / 1.47, rel=1e-10)
    assert np.abs(found["B.theta"]).max() <= 1e-12
    # on b: force = m (a - g) at its mass centre 1 m out, moment about B 0.3 m from it
    along = -rate * rate + G * np.sin(theta)
    across = second + G * np.cos(theta)
    force = np.hypot(along, across)
    assert np.linalg.norm(found["B.force"], axis=1) == pytest.approx(force, rel=1e-10)
    moment = 0.05 * second + 0.3 * across
    assert found["B.friction_moment"][:, 2] == pytest.approx(moment, abs=1e-10)
    assert (np.abs(moment) <= 0.9 * 0.5 * found["B.normal_load"]).all()
    assert errors(found) == []
    assert (found["row.energy_error"] <= 1e-11).all()
    assert found.complete


def test_forces_that_are_not_unique_stay_empty_with_a_word() -> None:
    """A four-bar at rest: four pins hold what one could."""
    text = f"""{HEAD}name: four-bar
links:
  a: {{mass: 1, center_of_mass: [0, 0.25, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
  b: {{mass: 1, center_of_mass: [0.5, 0.7, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
  c: {{mass: 1, center_of_mass: [1, 0.4, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [a, b], point: [0, 0.5, 0]}}
  C: {{type: C, links: [b, c], point: [1, 0.9, 0], axis: [0, 0, 1]}}
  D: {{type: R, links: [c, ground], point: [1, 0, 0], axis: [0, 0, 1]}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: A, coefficient: 0.9, radius: 0.5}}
  - {{type: friction, joint: D, coefficient: 0.9, radius: 0.5}}
responses:
  go: {{start: {{A.theta: 0.2}}, time: {{from: 0, to: 1, step: 0.5}}}}
"""
    found = mk.loads(text).respond("go", ["A.theta", "A.friction_moment"])
    assert np.ptp(found["A.theta"]) <= 1e-15
    assert np.isnan(found["A.friction_moment"]).all()
    assert (found.result.status == Status.friction_undecided).all()
    assert "friction-undecided" in [d.code for d in found.diagnostics]


def pulled(coefficient: str, force: str, count: int) -> mk.Analysis:
    """A kilogram on a table, g = 10, pulled from rest for 3 s."""
    text = f"""{HEAD}name: block
links: {{a: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{A: {{type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}}}}
loads:
  - {{type: gravity, g: [0, 0, -10]}}
  - {{type: friction, joint: A, coefficient: {coefficient}}}
  - {{type: force, joint: A, value: "{force}"}}
responses:
  go: {{start: {{A.s: 0, A.s_dot: 0}}, time: {{from: 0, to: 3, count: {count}}}}}
"""
    return mk.loads(text).respond("go", ["A.s"])


@pytest.mark.parametrize("count", [2, 3, 51])
def test_a_pull_that_comes_and_goes_between_rows_is_seen(count: int) -> None:
    found = pulled(
        "{static: 0.666, sliding: 0.385}", "-1.34 N + 6.02 N*sin(7.88 rad/s*time)", count
    )
    # by an integration from event to event
    assert found["A.s"][-1] == pytest.approx(-0.36777322, abs=1e-7)


@pytest.mark.parametrize("count", [2, 51])
def test_a_growing_pull_lets_go_without_a_jump_of_the_coefficient(count: int) -> None:
    found = pulled("0.33", "-0.668 N + 7.58 N/s*time", count)
    left = 3 - (3.3 + 0.668) / 7.58
    assert errors(found) == []
    assert found["A.s"][-1] == pytest.approx(7.58 * left**3 / 6, rel=1e-8)
