"""Loops with redundant constraints under loads that vary, as the same loops without."""

from __future__ import annotations

import pytest
from response.motions import off, respond

PLANAR = """format: 1
links:
  crank: {mass: 1, center_of_mass: [0.05, 0.1, 0], inertia: {zz: 0.01}}
  coupler: {mass: 2, center_of_mass: [0.3, 0.3, 0], inertia: {zz: 0.05}}
  rocker: {mass: 1, center_of_mass: [0.7, 0.2, 0], inertia: {zz: 0.02}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [crank, coupler], point: [0.05, 0.2, 0], axis: [0, 0, 1]}
  C: {type: R, links: [coupler, rocker], point: [0.65, 0.4, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, rocker], point: [0.75, 0, 0], axis: [0, 0, 1]}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - LOAD
responses:
  run:
    start: {A.theta: 0, A.theta_dot: 3 rad/s}
    time: {from: 0, to: 1, step: 0.25}
    tolerance: 1e-12
"""
LOADS = [
    '{type: torque, joint: A, value: "2 N*m*sin(5 rad/s*time) - 0.2 N*m*s/rad*A.theta_dot"}',
    '{type: force, link: coupler, point: [0.3, 0.3, 0], force: ["3 N*cos(A.theta)", 0, 0]}',
]


@pytest.mark.parametrize("load", LOADS)
def test_a_planar_loop_under_a_varying_load_moves_as_one_without_redundancy(load: str) -> None:
    text = PLANAR.replace("LOAD", load)
    loose = text.replace("B: {type: R,", "B: {type: S,").replace(
        "point: [0.05, 0.2, 0], axis: [0, 0, 1]}", "point: [0.05, 0.2, 0]}"
    )
    loose = loose.replace("C: {type: R,", "C: {type: U,").replace(
        "point: [0.65, 0.4, 0], axis: [0, 0, 1]}",
        "point: [0.65, 0.4, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}",
    )
    tight, free = respond(text), respond(loose)
    for name in ("A.theta", "A.theta_dot", "D.theta", "D.theta_ddot"):
        assert off(tight[name], free[name]) < 1e-9, name
    assert max(tight["row.energy_error"]) < 1e-10
