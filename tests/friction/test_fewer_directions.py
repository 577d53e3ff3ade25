"""Joints that loops let slip in fewer directions than their surfaces, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

HEAD = "format: 1\nname: few ways\nunits: {length: m, angle: rad, mass: kg, force: N}\n"
SLED = """
links:
  a: {{mass: 2, center_of_mass: [-0.4, 0.3, 0]}}
  b: {{mass: 1, center_of_mass: [0, 0, -5.5], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
joints:
  A: {{type: C, links: [ground, a], point: [0, 0, 0], axis: [3, 4, 0]}}
  T: {{type: Sp, links: [a, ground], point: [-0.8, 0.6, 0], normal: [0, 0, 1]}}
  B: {{type: R, links: [ground, b], point: [0, 0, -5], axis: [1, 0, 0]}}
loads:
  - {{type: gravity, g: [0, 0, -10]}}
  - {{type: friction, joint: T, coefficient: {coefficient}}}
  - {{type: force, link: a, point: [0, 0, 0], force: [{x}, {y}, 0]}}
responses:
  r:
    start: {{A.s: 0, A.s_dot: {speed}, B.theta: 0.5, B.theta_dot: 0}}
    time: {{from: 0, to: 2, count: 21}}
"""
"""A rail that carries half the weight of a sled; a runner, with friction, the other half, 10 N. Its
plane would let it slip to the side, the rail does not. A pendulum moves beside it."""


def sled(coefficient: str, force: str, speed: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Places (rows) and times (rows) of the sled under a force along its rail."""
    x, y = f'"0.6*({force})"', f'"0.8*({force})"'
    text = HEAD + SLED.format(coefficient=coefficient, x=x, y=y, speed=speed)
    found = mk.loads(text).respond("r", ["A.s", "time"])
    assert (found["row.status"] == "ok").all()
    assert found.result.report.evaluations < 20_000
    return np.array(found["A.s"]), np.array(found["time"])


@pytest.mark.parametrize("coefficient", ["0.3", "{static: 0.3, sliding: 0.3}"])
def test_a_runner_beside_a_rail_breaks_away_where_the_force_along_it_is_friction(
    coefficient: str,
) -> None:
    """2 x'' = 4 t - 3 from t = 3/4 on."""
    have, time = sled(coefficient, "4 N/s*time")
    want = np.maximum(time - 0.75, 0.0) ** 3 / 3
    assert np.abs(have - want).max() < 1e-10


@pytest.mark.parametrize("speed", [1.5, -1.5])
def test_a_runner_beside_a_rail_comes_to_rest_and_turns_back(speed: float) -> None:
    """From 1.5 m/s by 4.5 m/s2 against a force of 6 N; then back by 1.5 m/s2."""
    have, time = sled("0.3", f"{-4 * speed} N", speed)
    early, late = np.minimum(time, 1 / 3), np.maximum(time - 1 / 3, 0.0)
    want = np.sign(speed) * (1.5 * early - 2.25 * early**2 - 0.75 * late**2)
    assert np.abs(have - want).max() < 1e-10


@pytest.mark.parametrize("speed", [1.5, -1.5])
@pytest.mark.parametrize("radius", [0.05, 0.3])
def test_a_rail_and_its_runner_come_to_rest_together_and_stay(speed: float, radius: float) -> None:
    """Both rub, by 6 N together. Their forces at rest are not unique; the pendulum goes on."""
    both = f"""coefficient: 0.3}}
  - {{type: friction, joint: A, coefficient: 0.3, radius: {radius}"""
    text = HEAD + SLED.format(coefficient="0", x="0 N", y="0 N", speed=speed)
    text = text.replace("coefficient: 0}", both + "}")
    found = mk.loads(text).respond("r", ["A.s", "A.s_dot", "B.theta", "time"])
    assert not [d for d in found.diagnostics if d.severity == "error" and "ends" in d.message]
    early = np.minimum(np.array(found["time"]), 0.5)
    want = np.sign(speed) * 1.5 * early * (1 - early)
    assert np.abs(np.array(found["A.s"]) - want).max() < 1e-10
    assert np.abs(np.array(found["A.s_dot"])[6:]).max() < 1e-15
    assert np.ptp(np.array(found["B.theta"])[6:]) > 0.5


BALL = """
links:
  x: {{}}
  y: {{}}
  z: {{}}
  turned: {{}}
  ball: {{mass: 2, center_of_mass: [0, 0, 0], inertia: {{xx: 0.1, yy: 0.1, zz: 0.1}}}}
joints:
  X: {{type: P, links: [ground, x], point: [0, 0, 0], axis: [1, 0, 0]}}
  Y: {{type: P, links: [x, y], point: [0, 0, 0], axis: [0, 1, 0]}}
  Z: {{type: P, links: [y, z], point: [0, 0, 0], axis: [0, 0, 1]}}
  A: {{type: R, links: [z, turned], point: [0, 0, 0], axis: [1, 2, 2]}}
  B: {{type: R, links: [turned, ball], point: [0, 0, 0], axis: [2, 1, -2]}}
  S: {{type: S, links: [ground, ball], point: [0, 0, 0]}}
loads:
  - {{type: gravity, g: [0, 0, -10]}}
  - {{type: friction, joint: S, coefficient: {coefficient}, radius: 0.1}}
  - {{type: torque, joint: A, value: "{first}"}}
  - {{type: torque, joint: B, value: "{second}"}}
responses:
  r:
    start: {{A.theta: 0, A.theta_dot: {rate}, B.theta: 0.3, B.theta_dot: {other}}}
    time: {{from: 0, to: 2, count: 21}}
"""
"""A ball in a socket that carries its 20 N, and a gimbal without mass that keeps it from turning
about the line square to both its pins. Its kinetic energy is 0.05 (A'^2 + B'^2), and friction is
mu 20 N 0.1 m against (A', B')."""


def ball(
    coefficient: str, torque: str, part: tuple[float, float], rate: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Turns (2, rows) and times (rows) under a torque of which each pin has a part."""
    text = HEAD + BALL.format(
        coefficient=coefficient,
        first=f"{part[0]}*({torque})",
        second=f"{part[1]}*({torque})",
        rate=part[0] * rate,
        other=part[1] * rate,
    )
    found = mk.loads(text).respond("r", ["A.theta", "B.theta", "time"])
    assert (found["row.status"] == "ok").all()
    assert found.result.report.evaluations < 20_000
    return np.array([found["A.theta"], found["B.theta"] - 0.3]), np.array(found["time"])


PARTS = [(1.0, 0.0), (0.0, -1.0), (0.6, 0.8), (-0.28, 0.96)]


@pytest.mark.parametrize("part", PARTS)
def test_a_ball_in_a_gimbal_breaks_away_in_the_direction_of_the_torque(
    part: tuple[float, float],
) -> None:
    """0.1 a'' = 0.8 t - 0.6 from t = 3/4 on, along a line."""
    have, time = ball("0.3", "0.8 N*m/s*time", part)
    want = 4 / 3 * np.maximum(time - 0.75, 0.0) ** 3
    assert np.abs(have - np.outer(part, want)).max() < 1e-10


@pytest.mark.parametrize("part", PARTS)
def test_a_ball_in_a_gimbal_comes_to_rest_and_turns_back(part: tuple[float, float]) -> None:
    """From 5 rad/s by 15 rad/s2 against 0.9 N m, then back by 3 rad/s2."""
    have, time = ball("0.3", "-0.9 N*m", part, 5.0)
    early, late = np.minimum(time, 1 / 3), np.maximum(time - 1 / 3, 0.0)
    want = 5 * early - 7.5 * early**2 - 1.5 * late**2
    assert np.abs(have - np.outer(part, want)).max() < 1e-10
