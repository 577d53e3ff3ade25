"""In-plane reactions of four-bar, slider-crank, shaper and six-bars, against closed forms and
against three Newton-Euler equations a body at 50 digits (maximal.py)."""

from __future__ import annotations

from math import asin, atan2, cos, hypot, pi, sin

import numpy as np
import pytest
from planar.maximal import Maximal

import mechkin_cli as mk

HEAD = """\
format: 1
name: {name}
plane: xy
units: {{length: m, angle: rad, mass: kg, force: N}}
"""
BODY = "{mass: %s, center_of_mass: %s, inertia: %s}"
FOUR_BAR = (
    HEAD.format(name="four-bar")
    + """\
links:
  crank: {mass: 0.5, center_of_mass: [0, 0.2], inertia: 0.02}
  coupler: {mass: 1.25, center_of_mass: [0.5, 0.75], inertia: 0.3}
  rocker: {mass: 0.75, center_of_mass: [1.3, 0.4], inertia: 0.11}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0]}
  A: {type: R, links: [crank, coupler], point: [0, 0.4]}
  B: {type: R, links: [rocker, coupler], point: [1.2, 0.9]}
  C: {type: R, links: [ground, rocker], point: [1.3, 0]}
motion: {inputs: {O.theta: {from: 0, to: 6, count: 7, rate: 5 rad/s}}}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: torque, link: rocker, torque: -3}
"""
)
SLIDER_CRANK = (
    HEAD.format(name="slider-crank")
    + """\
links:
  crank: {mass: 0.5, center_of_mass: [0.1, 0], inertia: 0.02}
  rod: {mass: 1.25, center_of_mass: [0.45, 0], inertia: 0.1}
  slider: {mass: 2, center_of_mass: [1, 0], inertia: 0.1}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0]}
  A: {type: R, links: [crank, rod], point: [0.25, 0]}
  B: {type: R, links: [rod, slider], point: [1, 0]}
  D: {type: P, links: [ground, slider], point: [1, 0], axis: [1, 0]}
motion: {inputs: {O.theta: {from: 0, to: 6, count: 9, rate: 5 rad/s}}}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: force, joint: D, value: -20}
"""
)
SHAPER = (
    HEAD.format(name="shaper")
    + """\
links:
  crank: {mass: 2, center_of_mass: [0.04, 0.2], inertia: 0.003}
  arm: {mass: 5, center_of_mass: [0, 0.21], inertia: 0.08}
  rod: {mass: 1.5, center_of_mass: [-0.075, 0.42], inertia: 0.003}
  ram: {mass: 10, center_of_mass: [-0.15, 0.42]}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0.2]}
  Q: {type: R, links: [ground, arm], point: [0, 0]}
  A: {type: Ps, links: [crank, arm], point: {crank: [0.08, 0.2], arm: [0, 0]}, slot: [0, 1]}
  B: {type: R, links: [arm, rod], point: [0, 0.42]}
  C: {type: R, links: [rod, ram], point: [-0.15, 0.42]}
  D: {type: P, links: [ground, ram], point: [-0.15, 0.42], axis: [1, 0]}
motion: {inputs: {O.theta: {from: 0, to: 6, count: 7, rate: 6 rad/s}}}
loads: [{type: gravity, g: [0, -9.80665]}, {type: force, joint: D, value: 400}]
"""
)
SIX_LINKS = """\
links:
  crank: {mass: 0.4, center_of_mass: [0, 0.02], inertia: 0.0001}
  coupler: {mass: 1.2, center_of_mass: [0.06, 0.09], inertia: 0.0035}
  rocker: {mass: 0.8, center_of_mass: [0.145, 0.045], inertia: 0.0009}
  rod: {mass: 0.7, center_of_mass: [0.12, 0.15], inertia: 0.0015}
  output: {mass: 1.5, center_of_mass: [0.2, 0.11], inertia: 0.0052}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0]}
  A: {type: R, links: [crank, coupler], point: [0, 0.04]}
  B: {type: R, links: [coupler, rocker], point: [0.13, 0.09]}
  C: {type: R, links: [ground, rocker], point: [0.15, 0]}
  D: {type: R, links: [%s, rod], point: [0.05, 0.14]}
  E: {type: R, links: [rod, output], point: [0.19, 0.16]}
  F: {type: R, links: [%s, output], point: [0.21, 0.04]}
motion: {inputs: {O.theta: {from: 0, to: 6, count: 5, rate: 8 rad/s}}}
loads:
  - {type: gravity, g: [0, -9.81]}
  - {type: spring, joint: F, coordinate: theta, stiffness: 3, free: -0.35}
"""
STEPHENSON = HEAD.format(name="Stephenson III") + SIX_LINKS % ("coupler", "ground")
WATT = HEAD.format(name="Watt II") + SIX_LINKS % ("rocker", "ground")
WATT_ONE = HEAD.format(name="Watt I") + SIX_LINKS % ("coupler", "rocker")
ALL = {
    "four-bar": FOUR_BAR,
    "slider-crank": SLIDER_CRANK,
    "shaper": SHAPER,
    "Stephenson III": STEPHENSON,
    "Watt II": WATT,
    "Watt I": WATT_ONE,
}
NEAR = 1e-13
"""In parts of the largest value and of the condition."""


@pytest.mark.parametrize("name", list(ALL))
def test_motion_and_forces_of_dense_newton_euler_equations(name: str) -> None:
    oracle = Maximal(ALL[name])
    links = "".join(f"  o{x}: {{link: {x}, at: [0, 0]}}\n" for x in oracle.links)
    axes = "".join(f"  d{x}: {{link: {x}, vector: [1, 0]}}\n" for x in oracle.links)
    run = mk.loads(f"{ALL[name]}points:\n{links}directions:\n{axes}").analyze()
    solved = np.flatnonzero(run["row.status"] == "ok")
    assert solved.size >= 3
    forces = np.concatenate([run[f"{joint}.force"][solved] for joint in oracle.joints])
    size = float(np.max(np.abs(forces)))
    for row in solved:
        start = []
        for link in oracle.links:
            start += [*run[f"o{link}.position"][row]]
            start.append(float(run[f"atan2(d{link}.y, d{link}.x)"][row]))
        true = oracle.moving(start, float(run["O.theta"][row]))
        near = NEAR * max(1.0, float(run["row.condition"][row]))
        for joint in oracle.joints:
            *force, moment = true.reaction(joint)
            assert run[f"{joint}.force"][row] == pytest.approx(
                [*map(float, force)], abs=near * size
            )
            assert run[f"{joint}.moment"][row] == pytest.approx(float(moment), abs=near * size)
        assert run["O.effort"][row] == pytest.approx(float(true.effort), abs=near * size)


def test_the_slider_crank_of_textbooks() -> None:
    """x = r cos t + sqrt(l^2 - r^2 sin^2 t); the slider's forces follow from its acceleration, and
    the effort from the power balance (Dresig and Holzweissig, Dynamics of Machinery, 2.2)."""
    run = mk.loads(SLIDER_CRANK).analyze()
    r, l, omega = 0.25, 0.75, 5.0  # noqa: E741
    for row, t in enumerate(run["O.theta"]):
        root = (l * l - (r * sin(t)) ** 2) ** 0.5
        bend = -((r * r * sin(t) * cos(t)) ** 2) / root**3
        bend -= (r * r * (cos(t) ** 2 - sin(t) ** 2)) / root
        assert run["D.s"][row] == pytest.approx(r * cos(t) + root - 1, abs=1e-15)
        acceleration = omega**2 * (bend - r * cos(t))
        assert run["D.s_ddot"][row] == pytest.approx(acceleration, abs=1e-13)
        # rod on slider: mass times acceleration less the load
        along = 2 * acceleration + 20
        assert run["B.force.x"][row] == pytest.approx(along, abs=1e-12)
        # the rod's balance of moments about A; its centre lies 0.2/0.75 from A to B
        phi = -asin(r * sin(t) / l)
        rate = -r * cos(t) * omega / (l * cos(phi))
        turn = (r * sin(t) * omega**2 + l * sin(phi) * rate**2) / (l * cos(phi))
        share = 0.2 / 0.75
        x = -r * cos(t) * omega**2 * (1 - share) + share * acceleration
        y = -r * sin(t) * omega**2 * (1 - share)
        arm = 0.2 * cos(phi), 0.2 * sin(phi)
        moment = 0.1 * turn + 1.25 * (arm[0] * (y + 9.81) - arm[1] * x)
        # the slider takes force (X, Y) from the rod, the rod its opposite
        across = (along * l * sin(phi) - moment) / (l * cos(phi))
        assert run["B.force.y"][row] == pytest.approx(across, abs=1e-12)
        assert run["D.force.y"][row] == pytest.approx(2 * 9.81 - across, abs=1e-12)
        assert run["A.force"][row] == pytest.approx(
            [1.25 * x + along, 1.25 * (y + 9.81) + across], abs=1e-12
        )


def test_the_four_bar_by_its_diagonal() -> None:
    """Freudenstein's triangles: the rocker's angle from the law of cosines."""
    run = mk.loads(FOUR_BAR).analyze()
    a, b, c = 0.4, hypot(1.2, 0.5), hypot(0.1, 0.9)
    for row, theta in enumerate(run["O.theta"]):
        x, y = a * cos(theta + pi / 2), a * sin(theta + pi / 2)
        e, lean = hypot(1.3 - x, -y), atan2(y, x - 1.3)
        inner = (c * c + e * e - b * b) / (2 * c * e)
        angle = lean - np.arccos(inner)
        drawn = atan2(0.9, -0.1)
        off = np.remainder(run["C.theta"][row] + drawn - angle + pi, 2 * pi) - pi
        assert off == pytest.approx(0, abs=1e-14)


def test_the_pole_of_a_link_is_where_its_neighbours_cross() -> None:
    """Aronhold and Kennedy: the coupler's instant centre lies on crank and rocker produced."""
    run = mk.loads(FOUR_BAR).analyze()
    pole = run["coupler.screw_point"]
    assert pole.shape == (7, 2)
    for joint, (x, y) in (("A", (0.0, 0.0)), ("B", (1.3, 0.0))):
        at = run[f"{joint}.point"]
        across = (at[:, 0] - x) * (pole[:, 1] - y) - (at[:, 1] - y) * (pole[:, 0] - x)
        assert across == pytest.approx(np.zeros(7), abs=1e-11)
