"""What the page on signs says, on mechanisms whose forces are known by hand."""

import numpy as np
import pytest

import mechkin_cli as mk

WEIGHT = 2.0 * 9.81
ARM = 0.25

PENDULUM = """
format: 1
name: pendulum
units: {{length: m, angle: deg, mass: kg, force: N}}
links: {{bob: {{mass: 2, center_of_mass: [0, -0.25, 0]}}}}
joints: {{A: {{type: R, links: [{links}], point: [0, 0, 0], axis: [0, 0, 1]}}}}
motion: {{inputs: {{A.theta: {{values: [0, {quarter}], rate: {rate} rad/s}}}}}}
loads: [{loads}]
"""
GRAVITY = "{type: gravity, g: [0, -9.81, 0]}"


def pendulum(
    links: str = "ground, bob", quarter: int = 90, rate: float = 0.0, loads: str = GRAVITY
) -> mk.Analysis:
    text = PENDULUM.format(links=links, quarter=quarter, rate=rate, loads=loads)
    return mk.loads(text).analyze(["A.theta"])


def test_a_joint_s_force_is_what_the_first_link_does_to_the_second() -> None:
    """Ground carries the bob: the force on the bob points up; on ground, down."""
    assert pendulum()["A.force"][0] == pytest.approx([0, WEIGHT, 0], abs=1e-12)
    reversed_ = pendulum("bob, ground", -90)
    assert reversed_["A.force"][0] == pytest.approx([0, -WEIGHT, 0], abs=1e-12)


def test_an_effort_acts_on_the_second_link_and_its_power_is_put_in() -> None:
    """At a quarter turn the bob is to the right, and gravity turns it back."""
    assert pendulum()["A.effort"] == pytest.approx([0, WEIGHT * ARM], abs=1e-12)
    assert pendulum("bob, ground", -90)["A.effort"][1] == pytest.approx(-WEIGHT * ARM)


def test_a_load_on_a_joint_acts_on_its_second_link() -> None:
    helped = pendulum(loads=GRAVITY + ", {type: torque, joint: A, value: 3}")
    assert helped["A.effort"][1] == pytest.approx(WEIGHT * ARM - 3.0)


def test_efforts_stand_apart_from_moments_and_total_moments_have_both() -> None:
    found = pendulum()
    assert found["A.moment.z"][1] == pytest.approx(0.0, abs=1e-12)
    assert found["A.total_moment.z"][1] == pytest.approx(WEIGHT * ARM)


def test_shaking_is_done_to_ground_and_is_inertia_where_nothing_acts_from_outside() -> None:
    spun = pendulum(rate=3.0, loads="")
    pull = 2.0 * ARM * 3.0**2
    assert spun["ground.shaking_force"][0] == pytest.approx([0, -pull, 0], abs=1e-12)
    assert spun["ground.shaking_force"] == pytest.approx(spun["ground.inertia_force"])
    assert pendulum()["ground.shaking_force"][0] == pytest.approx([0, -WEIGHT, 0], abs=1e-12)


def test_moments_about_the_joint_and_about_the_origin() -> None:
    moved = PENDULUM.replace("[0, 0, 0]", "[1, 0, 0]").replace("[0, -0.25, 0]", "[1.5, 0, 0]")
    text = moved.format(links="ground, bob", quarter=0, rate=0, loads=GRAVITY)
    found = mk.loads(text).analyze(["A.theta"])
    assert found["A.total_moment.z"][0] == pytest.approx(0.5 * WEIGHT)
    assert found["A.moment_about_origin.z"][0] == pytest.approx(1.0 * WEIGHT)


def test_a_positive_lead_is_a_right_hand_thread_and_rates_are_per_radian() -> None:
    text = """
format: 1
units: {length: mm, angle: deg}
links: {nut: {}}
joints: {A: {type: H, links: [ground, nut], point: [0, 0, 0], axis: [0, 0, 1], lead: 4}}
motion: {inputs: {A.theta: {values: [90, 720], rate: 2 rad/s}}}
"""
    found = mk.loads(text).analyze(["A.s", "A.s_dot", "A.theta_dot", "A.theta"])
    assert found["A.s"] == pytest.approx([1.0, 8.0])
    assert found["A.theta_dot"] == pytest.approx(2.0)
    assert found["A.s_dot"] == pytest.approx(4.0 * 2.0 / (2.0 * np.pi))
    assert found["A.theta"][1] == 720.0


def test_the_ball_of_the_first_link_stands_at_s_in_the_groove_of_the_second() -> None:
    """A crank's ball in a groove along x of a slide that goes up and down."""
    text = """
format: 1
units: {length: m, angle: deg}
links: {crank: {}, slide: {}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: Sg, links: [crank, slide], point: [1, 0, 0], groove: [1, 0, 0]}
  B: {type: P, links: [ground, slide], point: [0, 0, 0], axis: [0, 1, 0]}
motion: {inputs: {O.theta: {values: [0, 60]}}}
"""
    found = mk.loads(text).analyze(["A.s", "A.slip", "A.point"])
    assert found["A.s"] == pytest.approx([0.0, np.cos(np.pi / 3) - 1.0])
    assert found["A.point"][1] == pytest.approx([0.5, np.sin(np.pi / 3), 0.0], abs=1e-12)
