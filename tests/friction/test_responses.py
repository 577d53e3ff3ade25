"""Motions under forces with friction against closed forms: sliding, sticking, breaking away."""

from __future__ import annotations

from math import cos, radians, sin, sqrt

import numpy as np
import pytest
from friction.slider_crank import TEXT
from scipy.integrate import solve_ivp

import mechkin_cli as mk
from mechkin_cli.kernel.functions import widths
from mechkin_cli.verdict import Status

G = 9.80665


def incline(angle: float, rate: float, friction: str, more: str = "") -> mk.Analysis:
    """A block of 2 kg on a slope; s goes up."""
    a = radians(angle)
    axis = f"[{cos(a)!r}, {sin(a)!r}, 0]"
    text = f"""
format: 1
name: block
units: {{length: m, angle: deg, mass: kg, force: N}}
links: {{block: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints: {{B: {{type: P, links: [ground, block], point: [0, 0, 0], axis: {axis}}}}}
responses:
  go: {{start: {{B.s: 0, B.s_dot: {rate}}}, time: {{from: 0, to: 2, step: 0.1}}{more}}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: B, {friction}}}
"""
    names = ["B.s", "B.s_dot", "time", "row.dissipated", "row.energy_error"]
    return mk.loads(text).respond("go", names)


def test_a_block_that_slides_up_and_stays():
    found = incline(20, 3, "coefficient: {static: 0.5, sliding: 0.4}")
    a, t = radians(20), found["time"]
    slowing = G * (sin(a) + 0.4 * cos(a))
    stop = 3 / slowing
    expected = np.where(t < stop, 3 * t - slowing * t * t / 2, 9 / (2 * slowing))
    assert found["B.s"] == pytest.approx(expected, abs=1e-10)
    assert (found["B.s_dot"][t > stop] == 0.0).all()
    lost = 0.4 * 2 * G * cos(a) * expected
    assert found["row.dissipated"] == pytest.approx(lost, abs=1e-9)
    assert (found["row.energy_error"] <= 1e-11).all()
    assert (found.result.status == Status.ok).all()


def test_a_block_that_slides_up_and_down_again():
    found = incline(35, 3, "coefficient: {static: 0.5, sliding: 0.4}")
    a, t = radians(35), found["time"]
    up, down = G * (sin(a) + 0.4 * cos(a)), G * (sin(a) - 0.4 * cos(a))
    stop = 3 / up
    expected = np.where(t < stop, 3 * t - up * t * t / 2, 9 / (2 * up) - down * (t - stop) ** 2 / 2)
    assert found["B.s"] == pytest.approx(expected, abs=1e-9)
    assert (found["row.energy_error"] <= 1e-10).all()


def test_a_block_that_is_held_from_the_start():
    found = incline(25, 0, "coefficient: {static: 0.5, sliding: 0.1}")
    assert (found["B.s"] == 0.0).all()
    assert (found["B.s_dot"] == 0.0).all()


def test_a_block_that_breaks_away():
    """A push that grows in time moves it when it is more than friction holds."""
    effort = ', efforts: {B.s: "10 N/s*time"}'
    found = incline(0, 0, "coefficient: {static: 0.5, sliding: 0.3}", effort)
    t, away = found["time"], 0.5 * 2 * G / 10
    after = t - away
    # m v' = 10 t - mu m g
    moved = (10 * after**3 / 6 + (10 * away - 0.3 * 2 * G) * after**2 / 2) / 2
    assert found["B.s"] == pytest.approx(np.where(t < away, 0.0, moved), abs=1e-9)


def pendulum(friction: str) -> mk.Analysis:
    text = f"""
format: 1
name: pendulum
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{bob: {{mass: 1, center_of_mass: [0, -1, 0]}}}}
joints: {{A: {{type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}}}
responses:
  go: {{start: {{A.theta: 1}}, time: {{from: 0, to: 20, step: 0.25}}}}
loads:
  - {{type: gravity, g: [0, -{G}, 0]}}
  - {{type: friction, joint: A, {friction}}}
"""
    names = ["A.theta", "A.theta_dot", "row.dissipated", "row.energy_error"]
    return mk.loads(text).respond("go", names)


def test_a_pendulum_comes_to_rest():
    """It ends where weight cannot turn it: sin(theta) r mu / sqrt(1 + ...) about the pin."""
    found = pendulum("coefficient: 0.3, radius: 0.2")
    assert found["A.theta_dot"][-1] == 0.0
    # at rest the pin carries the weight: |g sin(theta)| <= mu r g
    assert abs(sin(found["A.theta"][-1])) <= 0.06 + 1e-12
    assert (found["row.energy_error"] <= 1e-10).all()
    lost = G * (cos(found["A.theta"][-1]) - cos(1.0))
    assert found["row.dissipated"][-1] == pytest.approx(lost, rel=1e-10)
    assert (np.diff(found["row.dissipated"]) >= 0.0).all()


def test_a_motion_against_a_fine_integration():
    """theta'' = -g sin(theta) - mu r N sign(theta'), N = |(g cos(theta) + theta'^2, ...)|."""
    found = pendulum("coefficient: 0.05, radius: 0.2")
    mu, r = 0.05, 0.2

    def second(theta, rate, sense):
        # N^2 = (theta''^2 + ...): along the rod g cos + rate^2, across it theta'' + g sin = -mu r N
        along = G * cos(theta) + rate * rate
        normal = abs(along) / sqrt(1 - (mu * r) ** 2)
        return -G * sin(theta) - sense * mu * r * normal

    h, theta, rate = 1e-4, 1.0, 0.0
    for _ in range(2500):  # a quarter of a second, down from rest
        k1 = rate, second(theta, rate, -1)
        k2 = rate + h / 2 * k1[1], second(theta + h / 2 * k1[0], rate + h / 2 * k1[1], -1)
        k3 = rate + h / 2 * k2[1], second(theta + h / 2 * k2[0], rate + h / 2 * k2[1], -1)
        k4 = rate + h * k3[1], second(theta + h * k3[0], rate + h * k3[1], -1)
        theta += h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        rate += h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
    assert found["A.theta"][1] == pytest.approx(theta, abs=1e-10)
    assert found["A.theta_dot"][1] == pytest.approx(rate, abs=1e-10)


def test_a_slider_crank_swings_until_it_sticks():
    go = "{start: {A.theta: 20, A.theta_dot: 30 rad/s}, time: {from: 0, to: 1, step: 0.05}}"
    model = mk.loads(f"{TEXT}responses: {{go: {go}}}\n")
    names = ["A.theta", "A.theta_dot", "row.dissipated", "row.energy_error", "row.power_error"]
    found = model.respond("go", names)
    moving = found["A.theta_dot"] != 0.0
    assert moving[:8].all()
    assert not moving[-3:].any()
    assert np.ptp(found["A.theta"][-3:]) == 0.0
    assert (found["row.energy_error"] <= 1e-9).all()
    assert (found["row.power_error"][moving] <= 1e-13).all()
    assert (np.diff(found["row.dissipated"]) >= 0.0).all()
    for lanes in widths():
        other = model.respond("go", names, lanes=lanes)
        assert all(other[name].tobytes() == found[name].tobytes() for name in names)


def test_friction_that_may_jam_ends_the_motion():
    """The mass hangs so far beside its guide that friction feeds itself (Painleve)."""
    text = """
format: 1
name: guide
links: {slider: {mass: 1, center_of_mass: [0, 0.5, 0]}}
joints: {G: {type: P, links: [ground, slider], point: [0, 0, 0], axis: [1, 0, 0]}}
responses: {go: {start: {G.s: 0, G.s_dot: 1}, time: {from: 0, to: 1, step: 0.5}}}
loads:
  - {type: force, link: slider, point: [0, 0.5, 0], force: [1, 0, 0]}
  - {type: friction, joint: G, coefficient: 0.3, length: 0.2}
"""
    found = mk.loads(text).respond("go", ["G.s"])
    assert found.result.status[-1] == Status.friction_undecided
    assert "friction-undecided" in [d.code for d in found.diagnostics]


ROD = """
format: 1
name: crank, rod with two spheres, slider
links:
  crank: {mass: 1, center_of_mass: [0, 0.5, 0], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  rod: {}
  slider: {mass: 1, center_of_mass: [2, 0, 0.5]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [crank, rod], point: [0, 1, 0]}
  C: {type: S, links: [rod, slider], point: [2, 0, 0.5]}
  D: {type: P, links: [ground, slider], point: [2, 0, 0.5], axis: [1, 0, 0]}
responses: {go: {start: {A.theta: 0, A.theta_dot: 3 rad/s}, time: {from: 0, to: 0.2, step: 0.1}}}
loads:
  - {type: friction, joint: JOINT, coefficient: 0.1, radius: 0.05}
"""


def test_friction_that_drives_an_idle_spin_is_refused():
    found = mk.loads(ROD.replace("JOINT", "B")).respond("go", ["A.theta"])
    (error,) = [d for d in found.diagnostics if d.severity == "error"]
    assert error.code == "loaded-spin"
    assert "B" in error.message
    assert np.isnan(found["A.theta"]).all()
    found = mk.loads(ROD.replace("JOINT", "A")).respond("go", ["A.theta", "row.energy_error"])
    assert [d.code for d in found.diagnostics if d.severity == "error"] == []
    assert (found["row.energy_error"] <= 1e-11).all()


POST = """
format: 1
name: a ball that cannot leave its place in a groove
units: {{length: m, angle: rad, mass: kg, force: N}}
links:
  plate:
    mass: 2.6
    center_of_mass: {centre}
    inertia: {{xx: 0.26, yy: 0.31, zz: 0.27, xy: 0.018, xz: 0.02, yz: -0.005}}
joints:
  A: {{type: E, links: [ground, plate], point: [-0.1, -0.3, 0.4], normal: {normal}, x: {x}}}
  B: {{type: Sg, links: [ground, plate], point: {ball}, groove: {groove}}}
loads:
  - {{type: gravity, g: {g}}}
  - {{type: friction, joint: B, coefficient: {{static: 0.19, sliding: {sliding}}}}}
responses:
  r:
    start: {{A.theta: 0, A.theta_dot: {rate}}}
    time: {{from: 0, to: 1.2, count: 13}}
    tolerance: 1e-12
"""


@pytest.mark.parametrize("sliding", [0.19, 0.14])
@pytest.mark.parametrize(("groove", "rate"), [([0.1, 0.2, 0.6], -0.05), ([0.7, 0.2, 0.3], 3.0)])
def test_friction_of_a_slip_that_loops_forbid_does_nothing(
    groove: list[float], rate: float, sliding: float
) -> None:
    """The plate stays at its height, and a groove that leaves the plane lets its ball nowhere: the
    plate is a pendulum about the normal through the ball."""
    normal, x = np.array([-0.1, 0.55, 0.62]), np.array([0.0, 0.62, -0.55])
    ball, centre = np.array([0.9, 0.7, -0.6]), np.array([-0.85, 0.45, 0.84])
    g = np.array([3.4, -6.6, 6.4])
    given = {"normal": normal, "x": x, "ball": ball, "centre": centre, "g": g}
    text = POST.format(
        groove=groove, rate=rate, sliding=sliding, **{k: v.tolist() for k, v in given.items()}
    )
    found = mk.loads(text).respond("r", ["A.theta", "A.theta_dot", "time"])
    n = normal / np.linalg.norm(normal)
    arm = centre - ball - n * (n @ (centre - ball))
    tensor = np.array([[0.26, 0.018, 0.02], [0.018, 0.31, -0.005], [0.02, -0.005, 0.27]])
    inertia = n @ tensor @ n + 2.6 * arm @ arm
    # n . (arm turned by theta) x m g
    along, across = 2.6 * np.cross(n, arm) @ g / inertia, 2.6 * -(arm @ g) / inertia

    def pendulum(_: float, y: np.ndarray) -> list[float]:
        return [y[1], along * cos(y[0]) + across * sin(y[0])]

    times = np.asarray(found["time"])
    want = solve_ivp(pendulum, (0.0, 1.2), [0.0, rate], "DOP853", times, rtol=1e-13, atol=1e-13).y
    assert not any(d.severity == "error" for d in found.diagnostics)
    assert np.max(np.abs(found["A.theta"] - want[0])) < 1e-10
    assert np.max(np.abs(found["A.theta_dot"] - want[1])) < 1e-10
