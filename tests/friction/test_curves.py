"""Friction along curves and over surfaces: closed forms, and integrations of their own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import mechkin_cli as mk

GRAVITY = 9.81
"""m/s^2"""

RING = """
format: 1
plane: xy
units: {length: m, angle: rad, mass: kg, force: N}
links: {arm: {}, bead: {mass: 2, center_of_mass: [0.5, 0], inertia: 0.3}}
joints:
  A: {type: R, links: [ground, arm], point: [0, 0]}
  B: {type: P, links: [arm, bead], point: [0.5, 0], axis: [1, 0]}
  D: {type: Ps, links: [bead, ground], point: [0.5, 0], curve: {center: [0, 0]}}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: friction, joint: D, coefficient: 0.3}
"""
DRIVEN = "motion: {inputs: {A.theta: {from: 0, to: 6, count: 13, rate: RATE rad/s}}}\n"


@pytest.mark.parametrize("rate", [1.0, -7.0])
def test_a_bead_is_pushed_round_a_rough_ring(rate: float) -> None:
    """On a ring of radius r at an angle a with the rate w: the ring pushes by
    N = |m g sin a - m r w^2| and rubs by 0.3 N against w, as the torque on the arm shows; the arm
    alone turns the bead, with no power at its own turn."""
    result = mk.loads(RING + DRIVEN.replace("RATE", f"{rate}")).analyze()
    assert set(result["row.status"]) == {"ok"}
    turn = np.linspace(0.0, 6.0, 13)
    normal = np.abs(2.0 * GRAVITY * np.sin(turn) - 2.0 * 0.5 * rate * rate)
    np.testing.assert_allclose(result["D.normal_load"], normal, rtol=1e-11)
    np.testing.assert_allclose(
        result["D.friction_power"], 0.3 * normal * 0.5 * abs(rate), rtol=1e-11
    )
    effort = 2.0 * GRAVITY * 0.5 * np.cos(turn) + np.sign(rate) * 0.5 * 0.3 * normal
    np.testing.assert_allclose(result["A.effort"], effort, rtol=1e-10, atol=1e-10)


def slowed(turn: float, rate: float, mu: float, sense: float) -> float:
    """The angular acceleration on the ring, with what the body itself resists to turning."""
    normal = abs(2.0 * 0.5 * rate * rate - 2.0 * GRAVITY * np.sin(turn))
    pull = -2.0 * GRAVITY * 0.5 * np.cos(turn) - sense * mu * 0.5 * normal
    return pull / (2.0 * 0.25 + 0.3)


def test_a_bead_thrown_round_a_rough_ring() -> None:
    """Once up and beyond the top while friction takes its share."""
    text = RING + (
        "responses: {r: {start: {A.theta: -1.2, A.theta_dot: 19},"
        " time: {from: 0, to: 0.7, count: 8}}}"
    )
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}
    times = np.linspace(0.0, 0.7, 8)
    found = solve_ivp(
        lambda t, y: [y[1], slowed(y[0], y[1], 0.3, 1.0)],
        (0.0, 0.7),
        [-1.2, 19.0],
        method="DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-12,
        # the load on the ring changes its side where N is zero
        max_step=0.002,
    )
    assert (found.y[1] > 0.0).all()
    np.testing.assert_allclose(result["A.theta"], found.y[0], atol=2e-8)
    np.testing.assert_allclose(result["A.theta_dot"], found.y[1], atol=2e-7)
    assert float(np.abs(result["row.energy_error"]).max()) < 1e-8


@pytest.mark.parametrize("speed", [1.5, 3.5])
def test_a_bead_on_a_rough_ring_comes_to_rest_within_the_angle_of_friction(speed: float) -> None:
    """It swings until it turns back where |cos a| <= 0.3 |sin a|, and stays there."""
    text = RING + (
        "responses: {r: {start: {A.theta: -1.6, A.theta_dot: SPEED},"
        " time: {from: 0, to: 3, count: 61}}}"
    ).replace("SPEED", f"{speed}")
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}
    times = np.linspace(0.0, 3.0, 61)
    turn, rate, begin, sense = -1.6, speed, 0.0, 1.0
    expected = np.full(61, np.nan)

    def stops(t: float, y: Any) -> float:
        return float(y[1])

    stops.terminal = True  # type: ignore[attr-defined]
    while True:
        part = solve_ivp(
            lambda t, y, sense=sense: [y[1], slowed(y[0], y[1], 0.3, sense)],
            (begin, 3.0),
            [turn, rate if rate else 1e-300 * sense],
            method="DOP853",
            events=[stops],
            dense_output=True,
            rtol=1e-12,
            atol=1e-13,
        )
        within = (times >= begin) & (times <= part.t[-1])
        expected[within] = part.sol(times[within])[0]
        begin, turn, rate = float(part.t[-1]), float(part.y[0, -1]), 0.0
        if part.status != 1:
            break
        if abs(np.cos(turn)) <= 0.3 * abs(np.sin(turn)):
            expected[times > begin] = turn
            break
        sense = -sense
        # a little on its way, which it has left
        rate = slowed(turn, 0.0, 0.3, sense) * 1e-9
        turn, begin = turn + 0.5 * rate * 1e-9, begin + 1e-9
    assert begin < 3.0
    np.testing.assert_allclose(result["A.theta"], expected, atol=1e-8)
    rests = times > begin + 1e-6
    assert np.ptp(result["A.theta"][rests]) == 0.0


def test_a_bead_rests_on_a_rough_ring_or_slides_off() -> None:
    """At rest on both sides of the angle of friction, atan 0.3 from the bottom."""
    for off, holds in ((0.28, True), (0.30, False)):
        text = RING + (
            f"responses: {{r: {{start: {{A.theta: {-np.pi / 2 + off!r}, A.theta_dot: 0}},"
            " time: {from: 0, to: 0.5, count: 6}}}"
        )
        result = mk.loads(text).respond("r")
        assert set(result["row.status"]) == {"ok"}
        moved = float(np.ptp(result["A.theta"]))
        assert moved == 0.0 if holds else moved > 1e-4


HELIX = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links: {a: {}, b: {}, bead: {mass: 2, center_of_mass: [0.3, 0, 0], inertia: {xx: 1, yy: 1, zz: 1}}}
joints:
  X: {type: P, links: [ground, a], point: [0.3, 0, 0], axis: [1, 0, 0]}
  Y: {type: P, links: [a, b], point: [0.3, 0, 0], axis: [0, 1, 0]}
  Z: {type: P, links: [b, bead], point: [0.3, 0, 0], axis: [0, 0, 1]}
  D:
    type: Sg
    links: [bead, ground]
    point: [0.3, 0, 0]
    curve: {at: [0.3 m*cos(u), 0.3 m*sin(u), 0.2 m/rad*u], from: -40 rad, to: 40 rad}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
  - {type: friction, joint: D, coefficient: 0.25}
"""
RADIUS, LEAD = 0.3, 0.2
"""m, m/rad"""
LONG = float(np.hypot(RADIUS, LEAD))


def helix_load(rate: float) -> float:
    """Of the mass on the helix, with gravity along its binormal and by its curvature."""
    weight = GRAVITY * RADIUS / LONG
    return 2.0 * float(np.hypot(weight, RADIUS * rate * rate))


@pytest.mark.parametrize("rate", [2.0, -2.0, 9.0])
def test_a_bead_is_pushed_up_and_down_a_rough_helix(rate: float) -> None:
    motion = f"motion: {{inputs: {{Z.s: {{from: 0.1, to: 1, count: 5, rate: {LEAD * rate!r}}}}}}}\n"
    result = mk.loads(HELIX + motion).analyze()
    assert set(result["row.status"]) == {"ok"}
    # the drive carries the weight and what rubs, mu N / sin b, of which mu N cot b is on the helix
    normal = 2.0 * RADIUS * rate * rate / np.sqrt(1.0 - (0.25 * RADIUS / LEAD) ** 2)
    np.testing.assert_allclose(result["D.normal_load"], normal, rtol=1e-11)
    np.testing.assert_allclose(
        result["D.friction_power"], 0.25 * normal * LONG * abs(rate), rtol=1e-11
    )
    effort = 2.0 * GRAVITY + np.sign(rate) * 0.25 * normal * LONG / LEAD
    np.testing.assert_allclose(result["Z.effort"], effort, rtol=1e-10)


@pytest.mark.parametrize("speed", [0.0, 6.0, -11.0])
def test_a_bead_slides_down_a_rough_helix(speed: float) -> None:
    """w' = -(g k + mu N w / |w|)/l in parts; thrown up it turns back, as tan b > mu."""
    text = HELIX + (
        "responses: {r: {start: {D.u: 0, D.u_dot: SPEED}, time: {from: 0, to: 1.5, count: 16}}}"
    ).replace("SPEED", f"{speed}")
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}
    times = np.linspace(0.0, 1.5, 16)

    def slopes(t: float, y: Any, sense: float) -> list[float]:
        pull = -GRAVITY * LEAD / LONG - sense * 0.25 * helix_load(y[1]) / 2.0
        return [y[1], pull / LONG]

    def stops(t: float, y: Any, sense: float) -> float:
        return float(y[1]) if sense > 0.0 else 1.0

    stops.terminal = True  # type: ignore[attr-defined]
    expected, begin, state = np.full(16, np.nan), 0.0, [0.0, speed]
    for sense in (1.0, -1.0) if speed > 0.0 else (-1.0,):
        part = solve_ivp(
            slopes,
            (begin, 1.5),
            state,
            args=(sense,),
            method="DOP853",
            events=[stops],
            dense_output=True,
            rtol=1e-12,
            atol=1e-13,
        )
        within = (times >= begin) & (times <= part.t[-1])
        expected[within] = part.sol(times[within])[0]
        begin, state = float(part.t[-1]), [float(part.y[0, -1]), 0.0]
    np.testing.assert_allclose(result["D.u"], expected, atol=2e-8)


BOWL = """
format: 1
units: {length: m, angle: rad, mass: kg, force: N}
links:
  a: {}
  b: {}
  bead: {mass: 2, center_of_mass: [0.6, 0, -0.8], inertia: {xx: 1, yy: 1, zz: 1}}
joints:
  X: {type: P, links: [ground, a], point: [0.6, 0, -0.8], axis: [1, 0, 0]}
  Y: {type: P, links: [a, b], point: [0.6, 0, -0.8], axis: [0, 1, 0]}
  Z: {type: P, links: [b, bead], point: [0.6, 0, -0.8], axis: [0, 0, 1]}
  D: {type: Sp, links: [bead, ground], point: [0.6, 0, -0.8],
      surface: {sphere: [0, 0, 0], axis: [0, 1, 0]}}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
  - {type: friction, joint: D, coefficient: MU}
"""


def in_bowl(t: float, y: Any, mu: float) -> list[float]:
    """A point in a rough sphere of radius 1, by its coordinates."""
    place, rate = np.array(y[:3]), np.array(y[3:])
    pull = np.array([0.0, 0.0, -GRAVITY])
    normal = float(rate @ rate + place @ pull)
    speed = float(np.sqrt(rate @ rate))
    return [*rate, *(pull - normal * place - mu * abs(normal) * rate / speed)]


def test_a_bead_circles_in_a_rough_bowl() -> None:
    text = BOWL.replace("MU", "0.2") + (
        "responses: {r: {start: {X.s: 0, X.s_dot: 0.8, Y.s: 0, Y.s_dot: 2.5},"
        " time: {from: 0, to: 0.6, count: 7}}}"
    )
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}
    times = np.linspace(0.0, 0.6, 7)
    start = [0.6, 0.0, -0.8, 0.8, 2.5, 0.6]  # x x' + z z' = 0
    found = solve_ivp(
        in_bowl,
        (0.0, 0.6),
        start,
        args=(0.2,),
        method="DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-13,
    )
    assert float(np.hypot(*found.y[3:5]).min()) > 0.1
    np.testing.assert_allclose(result["X.s"] + 0.6, found.y[0], atol=2e-8)
    np.testing.assert_allclose(result["Y.s"], found.y[1], atol=2e-8)
    np.testing.assert_allclose(result["Z.s"] - 0.8, found.y[2], atol=2e-8)


@pytest.mark.parametrize(("mu", "holds"), [("0.76", True), ("0.74", False)])
def test_a_bead_rests_in_a_rough_bowl_or_slides_down(mu: str, holds: bool) -> None:
    """It stands where the bowl is inclined by 3/4."""
    text = BOWL.replace("MU", mu) + (
        "responses: {r: {start: {X.s: 0, X.s_dot: 0, Y.s: 0, Y.s_dot: 0},"
        " time: {from: 0, to: 0.6, count: 7}}}"
    )
    result = mk.loads(text).respond("r")
    assert set(result["row.status"]) == {"ok"}
    way = np.asarray(result["X.s"])
    if holds:
        assert not way.any()
        return
    times = np.linspace(0.0, 0.6, 7)

    def down(t: float, y: Any) -> list[float]:
        """By the angle from the bottom."""
        normal = GRAVITY * np.cos(y[0]) + y[1] * y[1]
        return [y[1], -GRAVITY * np.sin(y[0]) + 0.74 * normal]

    found = solve_ivp(
        down,
        (0.0, 0.6),
        [np.arcsin(0.6), 0.0],
        method="DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-14,
    )
    np.testing.assert_allclose(way + 0.6, np.sin(found.y[0]), atol=2e-9)
    np.testing.assert_allclose(result["Y.s"], 0.0, atol=1e-12)


def test_a_bead_is_led_over_a_rough_bowl() -> None:
    """Along a parallel circle with the rate w: N sin b' and so on by the balance of a point."""
    motion = (
        "motion: {time: {from: 0 s, to: 1 s, count: 6}, inputs: {"
        "X.s: {law: expression, value: '0.6 m*cos(2 rad/s*time) - 0.6 m'},"
        "Y.s: {law: expression, value: '0.6 m*sin(2 rad/s*time)'}}}\n"
    )
    result = mk.loads(BOWL.replace("MU", "0.2") + motion).analyze()
    assert set(result["row.status"]) == {"ok"}
    times = np.linspace(0.0, 1.0, 6)
    place = np.stack([0.6 * np.cos(2 * times), 0.6 * np.sin(2 * times), np.full(6, -0.8)])
    along = np.stack([-np.sin(2 * times), np.cos(2 * times), np.zeros(6)])
    # the drives push level; what the sphere gives upward carries the weight
    normal = 2.0 * GRAVITY / 0.8
    np.testing.assert_allclose(result["D.normal_load"], normal, rtol=1e-11)
    push = -2.0 * 4.0 * place + normal * place + 0.2 * normal * along
    np.testing.assert_allclose(result["X.effort"], push[0], rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(result["Y.effort"], push[1], rtol=1e-10, atol=1e-10)
