"""Ten mechanisms, written from the pages alone, against closed forms of their own."""

from __future__ import annotations

from math import cos, hypot, pi, radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import mechkin_cli as mk

FOLDER = Path(__file__).parent / "written_from_docs"
NAMES = sorted(path.stem for path in FOLDER.glob("*.yaml"))
STANDARD = 9.80665
Array = NDArray[np.float64]


def analyzed(name: str) -> Any:
    """The analysis of one of the ten."""
    return mk.load(FOLDER / f"{name}.yaml").analyze()


def rotated(angles: Array, x: float, y: float) -> Array:
    """A plane vector turned by angles in degrees, shape (rows, 2)."""
    a = np.radians(angles)
    return np.stack([x * np.cos(a) - y * np.sin(a), x * np.sin(a) + y * np.cos(a)], axis=-1)


def about(axis: tuple[float, float, float], angles: Array, vector: Any) -> Array:
    """A vector turned about a unit axis (Rodrigues), shape (rows, 3)."""
    a, k, v = np.radians(angles)[:, None], np.array(axis), np.array(vector, float)
    turned = v * np.cos(a) + np.cross(k, v) * np.sin(a) + k * (k @ v) * (1.0 - np.cos(a))
    return np.asarray(turned)


@pytest.mark.parametrize("name", NAMES)
def test_every_row_is_solved(name: str) -> None:
    assert len(NAMES) == 10
    assert analyzed(name).result.complete


def test_four_bar_keeps_its_lengths_and_balances_power() -> None:
    r = analyzed("four_bar")
    crank, rocker = r["A.theta"], r["D.theta"]
    b = rotated(crank, 40.0, 0.0)
    c = np.array([120.0, 0.0]) + rotated(rocker, 10.0, 80.0)
    pen = np.stack([r["pen.position.x"], r["pen.position.y"]], axis=-1)
    far = hypot(90.0, 80.0)
    assert np.linalg.norm(c - b, axis=1) == pytest.approx(far, abs=1e-9)
    assert np.linalg.norm(pen - b, axis=1) == pytest.approx(hypot(30.0, 70.0), abs=1e-9)
    assert np.linalg.norm(pen - c, axis=1) == pytest.approx(hypot(60.0, 10.0), abs=1e-9)
    # over a turn at constant rate gravity and inertia do no work: a closed sum of equal steps
    assert abs(np.mean(r["A.effort"][:-1])) < 2e-3 * np.abs(r["A.effort"]).max()


def test_shaper_arm_points_at_the_pin_and_work_is_in_balance() -> None:
    r = analyzed("shaper")
    pin = np.array([0.0, 250.0]) + rotated(r["O.theta"], 100.0, 0.0)
    assert r["Q.theta"] == pytest.approx(np.degrees(np.arctan2(-pin[:, 0], pin[:, 1])), abs=1e-9)
    tip = rotated(r["Q.theta"], 0.0, 500.0)
    ram = tip[:, 0] - np.sqrt(200.0**2 - (500.0 - tip[:, 1]) ** 2)
    assert r["D.s"] == pytest.approx(ram + 200.0, abs=1e-9)
    force = np.where(r["D.s_dot"] < 0.0, 900.0, 0.0)
    # massless: the motor's power is that against the load
    assert r["O.effort"] * 4.0 == pytest.approx(-force * r["D.s_dot"], abs=1e-5)


def test_inverted_slider_crank_rod_goes_through_the_sleeve() -> None:
    r = analyzed("inverted")
    to = rotated(r["A.theta"], 0.0, 50.0) + np.array([120.0, 0.0])
    drawn = np.degrees(np.arctan2(50.0, 120.0))
    assert r["D.theta"] == pytest.approx(np.degrees(np.arctan2(to[:, 1], to[:, 0])) - drawn)
    assert r["C.s"] == pytest.approx(np.linalg.norm(to, axis=1) - 130.0, abs=1e-9)


def test_rssr_keeps_its_rod_and_the_motor_holds_the_load() -> None:
    r = analyzed("rssr")
    a = about((0, 0, 1), r["O1.theta"], [50, 0, 0])
    b = np.array([160.0, 60, 0]) + about((0, 1, 0), r["O2.theta"], [0, 0, 90])
    long = np.linalg.norm([110.0, 60, 90])
    assert np.linalg.norm(b - a, axis=1) == pytest.approx(long, abs=1e-9)
    # the rod's ends have equal speed along it
    along = b - a
    to_a = np.sum(along * np.cross([0, 0, 1.0], a), axis=1)
    to_b = np.sum(along * np.cross([0, 1.0, 0], b - np.array([160.0, 60, 0])), axis=1)
    assert r["O2.theta_dot"] == pytest.approx(3.0 * to_a / to_b, rel=1e-9, abs=1e-9)
    assert r["O1.effort"] == pytest.approx(2000.0 * to_a / to_b, rel=1e-9, abs=1e-6)


def test_wishbone_keeps_its_lengths_and_the_drive_holds_spring_and_weight() -> None:
    r = analyzed("wishbone")
    lower = np.array([0.0, 300, 200]) + about((1, 0, 0), r["LA.theta"], [0, 400, -20])
    upper = np.array([0.0, 350, 450]) + about((1, 0, 0), r["UA.theta"], [0, 310, -20])
    long = np.linalg.norm([0.0, 40, 250])
    assert np.linalg.norm(upper - lower, axis=1) == pytest.approx(long, abs=1e-9)
    foot = np.array([0.0, 300, 200]) + about((1, 0, 0), r["LA.theta"], [0, 260, -10])
    spring = np.linalg.norm(foot - np.array([0.0, 420, 600]), axis=1)
    assert r["norm(top.position - foot.position)"] == pytest.approx(spring, abs=1e-9)
    # quasi-static: the drive's torque is the slope of the energy over the angle
    h = 1e-3

    def energy(angle: float) -> float:
        one = mk.loads(_wishbone_at(angle), "wishbone.yaml").analyze()
        stretched = one["norm(top.position - foot.position)"][-1] - 480.0
        return 25.0 * STANDARD * one["cg.position.z"][-1] + 0.5 * 40.0 * stretched**2

    slope = (energy(5.0 + h) - energy(5.0 - h)) / (2.0 * radians(h))
    (row,) = np.flatnonzero(np.isclose(r["LA.theta"], 5.0))
    assert r["LA.effort"][row] == pytest.approx(slope, rel=1e-6)


def _wishbone_at(angle: float) -> str:
    """The file with two rows, the second at an angle, and the mass centre as a point."""
    text = (FOLDER / "wishbone.yaml").read_text(encoding="utf-8")
    text = text.replace("{from: -8, to: 8, step: 1}", f"{{values: [0, {angle}]}}")
    return text.replace("points:\n", "points:\n  cg: {link: upright, at: [0, 700, 300]}\n")


def test_two_hooke_joints_turn_alike_and_the_middle_does_not() -> None:
    r = analyzed("shaft")
    assert r["O.theta"] == pytest.approx(r["I.theta"], abs=1e-9)
    assert r["I.effort"] == pytest.approx(5000.0, rel=1e-12)
    a, beta = np.radians(r["I.theta"]), radians(30.0)
    # rate of a shaft behind one joint, measured from the fork in the plane of the shafts or across
    across = 10.0 * cos(beta) / (1.0 - np.sin(a) ** 2 * np.sin(beta) ** 2)
    within = 10.0 * cos(beta) / (1.0 - np.cos(a) ** 2 * np.sin(beta) ** 2)
    middle = r["dot(middle.omega, [cos(beta), sin(beta), 0])"]
    fits = [np.allclose(middle, one, rtol=1e-10) for one in (across, within)]
    assert fits.count(True) == 1


def test_platform_legs_reach_the_commanded_pose_and_carry_the_weight() -> None:
    r = analyzed("platform")
    angle = r["pose.rz"]
    shift = np.stack([r["pose.x"], r["pose.y"], r["pose.z"]], axis=-1)
    feet = radians(1.0) * np.array([-10, 10, 110, 130, 230, 250])
    heads = radians(1.0) * np.array([-50, 50, 70, 170, 190, 290])
    for i in range(6):
        foot = 300.0 * np.array([np.cos(feet[i]), np.sin(feet[i]), 0.0])
        head = 200.0 * np.array([np.cos(heads[i]), np.sin(heads[i]), 0.0])
        leg = about((0, 0, 1), angle, head) + shift + np.array([0, 0, 400.0]) - foot
        drawn = np.linalg.norm(head + np.array([0, 0, 400.0]) - foot)
        assert r[f"P{i}.s"] == pytest.approx(np.linalg.norm(leg, axis=1) - drawn, abs=1e-9)
    assert r["time"][-1] == pytest.approx(2.0)
    # Newton's law along z: z = 30 (1 - cos(pi u))/2 mm has this acceleration, u = t/2
    acceleration = 30.0 / 2.0 * (pi / 2.0) ** 2 * np.cos(pi * r["time"] / 2.0) / 1000.0
    lift = np.zeros(len(angle))
    for i in range(6):
        foot = 300.0 * np.array([np.cos(feet[i]), np.sin(feet[i]), 0.0])
        head = 200.0 * np.array([np.cos(heads[i]), np.sin(heads[i]), 0.0])
        leg = about((0, 0, 1), angle, head) + shift + np.array([0, 0, 400.0]) - foot
        lift += r[f"P{i}.effort"] * leg[:, 2] / np.linalg.norm(leg, axis=1)
    assert lift == pytest.approx(20.0 * (STANDARD + acceleration), rel=1e-9)


def test_delta_rods_keep_their_length_and_the_tool_does_not_turn() -> None:
    r = analyzed("delta")
    tool = np.stack([r["tcp.position.x"], r["tcp.position.y"], r["tcp.position.z"]], axis=-1)
    long = np.linalg.norm([120.0 + 100.0 - 40.0, 0.0, 220.0])
    for i in range(3):
        a = radians(120.0 * i)
        out, side = np.array([np.cos(a), np.sin(a), 0]), (-np.sin(a), np.cos(a), 0.0)
        elbow = 120.0 * out + about(side, r[f"M{i}.theta"], 100.0 * out)
        assert np.linalg.norm(tool + 40.0 * out - elbow, axis=1) == pytest.approx(long, abs=1e-9)
    assert np.abs(r["tool.omega"]).max() < 1e-9


def test_cylinder_arm_against_triangle_and_virtual_work() -> None:
    r = analyzed("arm")
    head = np.array([0.0, 300.0]) + rotated(r["O.theta"], 500.0, -100.0)
    leg = head - np.array([200.0, -300.0])
    long = np.linalg.norm(leg, axis=1)
    assert r["C.s"] == pytest.approx(long - hypot(300.0, 500.0), abs=1e-9)
    spoke = head - np.array([0.0, 300.0])
    lever = (leg[:, 1] * spoke[:, 0] - leg[:, 0] * spoke[:, 1]) / long
    rate = 50.0 / lever  # of the arm, in rad/s
    assert r["O.theta_dot"] == pytest.approx(rate, rel=1e-9)
    # constant speed of the rod: rate * lever = 50 mm/s at all times, differentiated over the angle
    h = 1e-5

    def lever_at(angle: Array) -> Array:
        s = rotated(angle, 500.0, -100.0)
        g = s + np.array([0.0, 300.0]) - np.array([200.0, -300.0])
        return np.asarray((g[:, 1] * s[:, 0] - g[:, 0] * s[:, 1]) / np.linalg.norm(g, axis=1))

    angle = r["O.theta"]
    slope = (lever_at(angle + h) - lever_at(angle - h)) / (2.0 * radians(h))
    acceleration = -(rate**2) * slope / lever
    centre, tip = rotated(angle, 700.0, 0.0), rotated(angle, 1400.0, 0.0)
    inertia = (9e6 + 60.0 * 700.0**2) / 1000.0  # N mm s^2
    moment = inertia * acceleration + 60.0 * STANDARD * centre[:, 0] + 1500.0 * tip[:, 0]
    assert r["C.effort"] == pytest.approx(moment / lever, rel=1e-7)


def test_flap_with_a_strut_against_its_levers() -> None:
    r = analyzed("door")
    eye = rotated(r["H.theta"], 350.0, -20.0)
    strut = eye - np.array([150.0, -250.0])
    long = np.linalg.norm(strut, axis=1)
    assert r["norm(eye.position - body.position)"] == pytest.approx(long, abs=1e-9)
    pull = -300.0 + 0.4 * (long - 500.0)
    unit = strut / long[:, None]
    held = 12.0 * STANDARD * rotated(r["H.theta"], 400.0, 0.0)[:, 0]
    moment = held + pull * (eye[:, 0] * unit[:, 1] - eye[:, 1] * unit[:, 0])
    assert r["H.effort"] == pytest.approx(moment, rel=1e-9, abs=1e-6)
    force = np.array([0.0, 12.0 * STANDARD]) + pull[:, None] * unit
    assert r["norm(H.force)"] == pytest.approx(np.linalg.norm(force, axis=1), rel=1e-9)
