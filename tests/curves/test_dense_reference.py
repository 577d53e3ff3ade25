"""A pin of a crank in an elliptic slot of a turning arm against its equations as written.

Places at 40 digits, rates as their derivatives, forces by Newton and Euler with multipliers.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

MODEL = """
format: 1
plane: xy
units: {length: m, angle: rad}
parameters: {a: 75 mm, b: 15 mm/sqrt(1 - (55/75)^2)}
links:
  crank: {mass: 0.4, center_of_mass: [2 mm, 6 mm], inertia: 3e-5 kg*m^2}
  arm: {mass: 0.7, center_of_mass: [40 mm, 9 mm], inertia: 5e-4 kg*m^2}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [ground, arm], point: [55 mm, 0]}
  D:
    type: Ps
    links: [crank, arm]
    point: [0, 15 mm]
    curve: {at: ['55 mm + a*cos(u)', 'b*sin(u)'], from: 0, to: 360 deg, closed: true}
loads:
  - {type: gravity, g: standard}
  - {type: torque, joint: B, value: 2}
motion:
  inputs:
    A.theta:
      {from: 0, to: 6, step: 0.4, rate: 7 rad/s, acceleration: 3 rad/s^2, jerk: 5 rad/s^3}
"""
LONG, GRAVITY = mp.mpf(75) / 1000, mp.mpf("9.80665")


def short() -> Any:
    return mp.mpf(15) / 1000 / mp.sqrt(1 - (mp.mpf(55) / 75) ** 2)


def turned(angle: Any, x: Any, y: Any) -> tuple[Any, Any]:
    c, s = mp.cos(angle), mp.sin(angle)
    return c * x - s * y, s * x + c * y


def implicit(theta: Any, arm: Any) -> Any:
    """How far the pin is off the ellipse of the arm."""
    x, y = turned(theta, 0, mp.mpf(15) / 1000)
    local_x, local_y = turned(-arm, x - mp.mpf(55) / 1000, y)
    return (local_x / LONG) ** 2 + (local_y / short()) ** 2 - 1


def arm_at(theta: Any, near: float) -> Any:
    return mp.findroot(lambda arm: implicit(theta, arm), near)


def test_places_rates_and_forces_are_those_of_the_dense_equations() -> None:
    result = mk.loads(MODEL).analyze()
    assert set(result["row.status"]) == {"ok"}
    with mp.workdps(40):
        for row in range(len(result["A.theta"])):
            compare(result, row)


def compare(result: mk.Result, row: int) -> None:
    theta0 = mp.mpf(float(result["A.theta"][row]))
    near = float(result["B.theta"][row])

    def theta(t: Any) -> Any:
        return theta0 + 7 * t + 3 * t**2 / 2 + 5 * t**3 / 6

    def arm(t: Any) -> Any:
        return arm_at(theta(t), near)

    orders = [arm(0), *(mp.diff(arm, 0, n, h=mp.mpf(10) ** -9) for n in (1, 2))]
    third = mp.diff(arm, 0, 3, h=mp.mpf(10) ** -8)
    for suffix, value in zip(("", "_dot", "_ddot", "_dddot"), (*orders, third), strict=True):
        assert float(result[f"B.theta{suffix}"][row]) == pytest.approx(
            float(value), rel=1e-9, abs=1e-9
        )
    assert float(result["B.theta"][row]) == pytest.approx(float(orders[0]), abs=1e-13)
    forces(result, row, float(theta0), [float(x) for x in orders])


def forces(result: mk.Result, row: int, theta: float, arm: list[float]) -> None:
    """The unknowns: forces on the crank at A and on the arm at B, the push along the normal, the
    drive's torque."""
    crank = turning([theta, 7.0, 3.0], (0.002, 0.006))
    body = turning(arm, (-0.015, 0.009))
    pin = np.array([float(x) for x in turned(theta, 0, 0.015)])
    local = np.array([float(x) for x in turned(-arm[0], pin[0] - 0.055, pin[1])])
    gradient = local / np.array([float(LONG) ** 2, float(short()) ** 2])
    normal = np.array([float(x) for x in turned(arm[0], *(gradient / np.hypot(*gradient)))])
    # rows: forces and moments about A of the crank, about B of the arm; push on the arm
    system, right = np.zeros((6, 6)), np.zeros(6)
    system[0:2, 0:2], system[0:2, 4] = np.eye(2), -normal
    system[2, 4], system[2, 5] = -cross(pin, normal), 1.0
    system[3:5, 2:4], system[3:5, 4] = np.eye(2), normal
    system[5, 4] = cross(pin - np.array([0.055, 0.0]), normal)
    weight = np.array([0.0, -float(GRAVITY)])
    for first, mass, inertia, alpha, (centre, acceleration) in (
        (0, 0.4, 3e-5, 3.0, crank),
        (3, 0.7, 5e-4, arm[2], body),
    ):
        needed = mass * (acceleration - weight)
        right[first : first + 2] = needed
        right[first + 2] = inertia * alpha + cross(centre, needed)
    right[5] -= 2.0
    found = np.linalg.solve(system, right)
    known = {"A.force": found[0:2], "B.force": found[2:4], "D.force": found[4] * normal}
    for name, value in known.items():
        np.testing.assert_allclose(np.asarray(result[name])[row][:2], value, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(result["A.effort"][row], found[5], rtol=1e-8, atol=1e-9)


def cross(a: Any, b: Any) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def turning(orders: list[float], at: tuple[float, float]) -> tuple[Any, Any]:
    """Place from the pivot, and acceleration, of a point of a turning body."""
    angle, rate, second = orders
    place = np.array([float(x) for x in turned(angle, *at)])
    across = np.array([-place[1], place[0]])
    return place, second * across - rate * rate * place


def test_all_assemblies_are_found() -> None:
    """The circle of the pin's distance meets the ellipse in four points."""
    found = mk.loads(MODEL).modes()
    far, short_axis = np.hypot(0.055, 0.015), float(short())
    # x^2/a^2 + (d^2 - x^2)/b^2 = 1
    square = (far**2 / short_axis**2 - 1.0) / (1.0 / short_axis**2 - 1.0 / float(LONG) ** 2)
    x, y = np.sqrt(square), np.sqrt(far**2 - square)
    pin = np.arctan2(0.015, -0.055)
    expected = np.array([pin - np.arctan2(b * y, a * x) for a in (1, -1) for b in (1, -1)])
    angles = np.array([mode.coordinates["B.theta"] for mode in found.modes])
    apart = np.abs(np.exp(1j * angles)[:, None] - np.exp(1j * expected)[None, :])
    assert len(angles) == 4
    np.testing.assert_allclose(apart.min(axis=0), 0.0, atol=1e-12)
    assert sorted(apart.argmin(axis=0)) == [0, 1, 2, 3]


def test_a_freely_swinging_arm_keeps_its_energy() -> None:
    text = MODEL.partition("loads:")[0] + (
        "loads: [{type: gravity, g: standard}]\n"
        "motion: {}\n"
        "responses: {swing: {start: {A.theta: 0.3}, time: {from: 0, to: 1, step: 0.1}}}\n"
    )
    found = mk.loads(text).respond("swing")
    assert set(found["row.status"]) == {"ok"}
    crank = np.array([turned(t, 0.002, 0.006)[1] for t in found["A.theta"]], dtype=float)
    body = np.array([turned(t, -0.015, 0.009)[1] for t in found["B.theta"]], dtype=float)
    arms = (3e-5 + 0.4 * (0.002**2 + 0.006**2), 5e-4 + 0.7 * (0.015**2 + 0.009**2))
    rates = np.asarray(found["A.theta_dot"]), np.asarray(found["B.theta_dot"])
    kinetic = 0.5 * (arms[0] * rates[0] ** 2 + arms[1] * rates[1] ** 2)
    energy = kinetic + float(GRAVITY) * (0.4 * crank + 0.7 * body)
    assert np.ptp(energy) < 1e-9 * kinetic.max()


def test_true_errors_and_proofs_know_the_curve() -> None:
    model = mk.loads(MODEL)
    errors = model.analyze(errors=True).errors
    assert errors.digits is not None
    assert errors.digits >= 12
    certificate = model.certify()
    assert set(certificate.status) == {"proven"}
    assert certificate.is_one_branch


def test_parameters_of_the_curve_have_exact_slopes() -> None:
    """The arm's angle by the long axis, from the ellipse as written."""
    model = mk.loads(MODEL)
    slopes = model.sensitivities(["B.theta"], ["a"])["B.theta", "a"]
    result = model.analyze()
    with mp.workdps(30):
        for row in (0, 5, 11):
            places = [float(result[name][row]) for name in ("A.theta", "B.theta")]
            assert slopes[row] == pytest.approx(slope_by_long_axis(*places), rel=1e-9)


def slope_by_long_axis(theta: float, near: float) -> float:
    def arm(a: Any) -> Any:
        def off(angle: Any) -> Any:
            x, y = turned(theta, 0, mp.mpf(15) / 1000)
            p, q = turned(-angle, x - mp.mpf(55) / 1000, y)
            return (p / a) ** 2 + (q / short()) ** 2 - 1

        return mp.findroot(off, near)

    return float(mp.diff(arm, LONG, h=mp.mpf(10) ** -8))


def test_variants_and_widths_have_the_same_bits() -> None:
    model = mk.loads(MODEL)
    names = ["B.theta", "B.theta_ddot", "A.effort"]
    axes = ["75 mm", "76 mm", "78 mm"]
    table = model.vary({"a": axes}, names)
    for number, axis in enumerate(axes):
        alone = model.with_parameters({"a": axis}).analyze()
        for name in names:
            np.testing.assert_array_equal(table[name][number], alone[name])
    narrow = model.analyze(lanes=2, threads=1)
    np.testing.assert_array_equal(narrow["A.effort"], model.analyze()["A.effort"])
