"""Errors of every kind of quantity: rates, jerks, reactions, energies, derived ones, expressions;
under springs, dampers, loads by expressions, laws of time, redundant constraints."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

SPACE = """
format: 1
units: {length: mm, force: N}
links:
  crank: {mass: 0.4, center_of_mass: [10, 0, 0], inertia: {xx: 80.3, yy: 20, zz: 90}}
  rod: {mass: 0.6, center_of_mass: [40, 25, 0], inertia: {xx: 40, yy: 800, zz: 800}}
  rocker: {mass: 1.1, center_of_mass: [65, 25, 0], inertia: {xx: 40, yy: 80, zz: 80}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: U, links: [crank, rod], point: [20.3, 0, 0], axis: [0, 0, 1], axis2: [0.6, -0.3, 0]}
  C: {type: S, links: [rod, rocker], point: [60.1, 50.7, 0]}
  D: {type: R, links: [ground, rocker], point: [70, 0, 0], axis: [0, 0.1, 1]}
points:
  tip: {link: rod, at: [40, 60, 0]}
  base: {link: ground, at: [0, 80.2, 3]}
loads:
  - {type: gravity, g: standard}
  - {type: spring, between: [tip, base], stiffness: 0.31, free: 12}
  - {type: spring, joint: A, coordinate: theta, stiffness: 3 N*mm/rad, free: 20}
  - {type: damper, joint: D, coordinate: theta, damping: 20 N*mm*s/rad}
  - {type: torque, joint: D, value: "0.3 N*mm + 0.01 N*tip.position.x*sin(D.theta)"}
  - {type: torque, joint: D, value: "0.2 N*mm*s/rad*A.theta_dot"}
motion: MOTION
tables:
  - name: all
    columns:
      - A.theta
      - D.theta
      - D.theta_ddot
      - tip.jerk.x
      - C.force.x
      - norm(D.moment)
      - A.effort
      - rod.alpha.z
      - row.kinetic_energy
      - row.potential_energy
      - ground.shaking_force.x
      - C.q1
      - rod.screw_pitch
      - D.theta.mechanical_advantage
      - A.effort.per_acceleration
      - wrap(3*A.theta)
      - min(D.theta, 0.1 rad)
      - row.condition
"""

MOTIONS = {
    "turns": "{inputs: {A.theta: {from: 3, to: 800, step: 20, rate: 2 rad/s, acceleration: 1.3}}}",
    "a law": """
  time: {from: 0, to: 2, step: 0.1}
  inputs: {A.theta: {law: cycloidal, from: 0, to: 333.3}}
""",
}


@pytest.mark.parametrize("name", MOTIONS)
def test_every_column_is_repeated(name):
    errors = mk.loads(SPACE.replace("MOTION", MOTIONS[name])).analyze(errors=True).errors
    assert errors.why == {"all.row.condition": "a verdict"}
    assert sum(column.lost for column in errors.columns) == 0
    assert errors.digits is not None
    assert errors.digits >= 13


PLANE = """
format: 1
units: {length: mm, force: N}
links:
  crank: {mass: 0.4, center_of_mass: [10, 0, 0]}
  rod: {mass: 0.6, center_of_mass: [40, 25, 0], inertia: {xx: 40, yy: 80, zz: 80}}
  rocker: {mass: 1.1, center_of_mass: [65, 25, 0], inertia: {xx: 40, yy: 80, zz: 80}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, rod], point: [20.3, 0, 0], axis: [0, 0, 1]}
  C: {type: R, links: [rod, rocker], point: [60.1, 50.7, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [70, 0, 0], axis: [0, 0, 1]}
motion: {inputs: {A.theta: {from: 0, to: 360, step: 20, rate: 2 rad/s}}}
tables:
  - {name: forces, columns: [A.effort, C.force.x, C.force.y, C.moment.x, D.theta_ddot]}
"""


def test_reactions_that_are_not_unique_stay_empty():
    errors = mk.loads(PLANE).analyze().errors
    assert np.isnan(errors["C.moment.x"]).all()
    assert sum(column.lost for column in errors.columns) == 0
    for label in ("A.effort", "C.force.x", "C.force.y", "D.theta_ddot"):
        (column,) = [c for c in errors.columns if c.label == label]
        assert column.digits.min() >= 13
