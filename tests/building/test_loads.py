"""Every kind of load on a pendulum and on a slider, against the closed form of the effort.

Files in mm, kg, N: a bare moment is N mm, a bare torsional stiffness N mm/rad.
"""

from math import cos, radians, sin, sqrt

import pytest

import mechkin_cli as mk

MASS, ARM, HEIGHT, INERTIA = 2.0, 300.0, 500.0, 700.0
RATE, ACCELERATION, G = 3.0, -5.0, 9810.0
ANGLES = [-80.0, -30.0, 0.0, 20.0, 65.0]

PENDULUM = f"""\
format: 1
units: {{length: mm, mass: kg, force: N}}
links:
  arm: {{mass: 0, center_of_mass: [{ARM}, 0, 0]}}
joints: {{O: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}}}
points:
  tip: {{link: arm, at: [{ARM}, 0, 0]}}
  hook: {{link: ground, at: [0, {HEIGHT}, 0]}}
motion:
  inputs: {{O.theta: {{values: {ANGLES}, rate: {RATE}, acceleration: {ACCELERATION}}}}}
"""
HEAVY = f"{{mass: {MASS}, center_of_mass: [{ARM}, 0, 0], inertia: {{zz: {INERTIA}}}}}"


def efforts(loads: str) -> list[float]:
    """What the drive of the pendulum without mass applies, in N mm."""
    return list(mk.loads(f"{PENDULUM}loads: [{loads}]\n").analyze()["O.effort"])


def distance(angle: float) -> float:
    return sqrt(ARM**2 + HEIGHT**2 - 2 * ARM * HEIGHT * sin(angle))


def lever(angle: float) -> float:
    """Lever of the line from the tip to the hook about the joint; minus d(distance)/d(theta)."""
    return ARM * HEIGHT * cos(angle) / distance(angle)


LOADS = {
    "{type: torque, joint: O, value: 11}": lambda a: -11,
    "{type: torque, joint: O, value: 0.011 N*m}": lambda a: -11,
    "{type: torque, link: arm, torque: [5, 6, 7]}": lambda a: -7,
    "{type: torque, link: arm, torque: [5, 6, 7], axes: link}": lambda a: -7,
    "{type: force, link: arm, point: [300, 0, 0], force: [0, 4, 9]}": lambda a: -4 * ARM * cos(a),
    "{type: force, link: arm, point: [300, 0, 0], force: [0, 4, 9], axes: link}": lambda a: (
        -4 * ARM
    ),
    "{type: spring, joint: O, coordinate: theta, stiffness: 60, free: 10, preload: 2}": lambda a: (
        2 + 60 * (a - radians(10))
    ),
    "{type: spring, joint: O, coordinate: theta, stiffness: 1 N*mm/deg}": lambda a: a / radians(1),
    "{type: damper, joint: O, coordinate: theta, damping: 13}": lambda a: 13 * RATE,
    "{type: spring, between: [tip, hook], stiffness: 0.2, free: 250, preload: 3}": lambda a: (
        -(3 + 0.2 * (distance(a) - 250)) * lever(a)
    ),
    "{type: spring, between: [hook, tip], stiffness: 200 N/m, free: 25 cm}": lambda a: (
        -0.2 * (distance(a) - 250) * lever(a)
    ),
    "{type: damper, between: [tip, hook], damping: 0.4}": lambda a: 0.4 * RATE * lever(a) ** 2,
}


@pytest.mark.parametrize("load", LOADS)
def test_effort_against_one_load(load: str) -> None:
    expected = [LOADS[load](radians(angle)) for angle in ANGLES]
    assert efforts(load) == pytest.approx(expected, rel=1e-12, abs=1e-9)


def test_loads_add_up() -> None:
    expected = [sum(load(radians(angle)) for load in LOADS.values()) for angle in ANGLES]
    assert efforts(", ".join(LOADS)) == pytest.approx(expected, rel=1e-12)


def test_weight_and_inertia_of_a_pendulum() -> None:
    text = PENDULUM.replace(f"{{mass: 0, center_of_mass: [{ARM}, 0, 0]}}", HEAVY)
    found = mk.loads(f"{text}loads: [{{type: gravity, g: [0, {-G}, 0]}}]\n").analyze()
    angles = [radians(angle) for angle in ANGLES]
    # kg mm^2/s^2 = 1e-3 N mm
    about_joint = MASS * ARM**2 + INERTIA
    effort = [1e-3 * (MASS * G * ARM * cos(a) + about_joint * ACCELERATION) for a in angles]
    along = [1e-3 * MASS * (G * sin(a) - ARM * RATE**2) for a in angles]
    across = [1e-3 * MASS * (G * cos(a) + ARM * ACCELERATION) for a in angles]
    force = [
        (n * cos(a) - t * sin(a), n * sin(a) + t * cos(a), 0)
        for a, n, t in zip(angles, along, across, strict=True)
    ]
    assert list(found["O.effort"]) == pytest.approx(effort, rel=1e-12)
    for row, expected in zip(found["O.force"], force, strict=True):
        assert list(row) == pytest.approx(expected, rel=1e-12, abs=1e-12)


SLIDER = """\
format: 1
units: {length: mm, mass: kg, force: N}
links: {block: {mass: 3, center_of_mass: [0, 0, 0]}}
joints: {P: {type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}
motion: {inputs: {P.s: {values: [-40, 0, 90], rate: 50, acceleration: 800}}}
loads:
"""


@pytest.mark.parametrize(
    ("load", "expected"),
    [
        ("{type: force, joint: P, value: 7}", [2.4 - 7] * 3),
        ("{type: gravity, g: [-2000, -9810, 0]}", [2.4 + 6] * 3),
        (
            "{type: spring, joint: P, coordinate: s, stiffness: 0.5, free: 20}",
            [2.4 - 30, 2.4 - 10, 2.4 + 35],
        ),
        ("{type: damper, joint: P, coordinate: s, damping: 20 N*s/m}", [2.4 + 1] * 3),
    ],
)
def test_effort_of_a_slider(load: str, expected: list[float]) -> None:
    found = mk.loads(f"{SLIDER}  - {load}\n").analyze()["P.effort"]
    assert list(found) == pytest.approx(expected, rel=1e-12)
