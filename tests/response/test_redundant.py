"""Loops with redundant constraints under loads that vary, as the same loops without."""

from __future__ import annotations

import re

import numpy as np
import pytest
from response.motions import PLANAR, off, respond

import mechkin_cli as mk

RUN = """responses:
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
    text = (PLANAR + RUN).replace("LOAD", load)
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


GEARED = """format: 1
PLANE
units: {length: m, angle: rad, mass: kg, force: N}
links:
  a: {mass: 1, center_of_mass: [-0.1, 0.1, 0]}
  b: {mass: 1, center_of_mass: [0.2, 0.4, 0]}
  c: {mass: 1, center_of_mass: [0.6, 0.4, 0]}
  d: {mass: 1, center_of_mass: [1.1, 0.1, 0]}
joints:
  S: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: R, links: [a, b], point: [-0.2, 0.3, 0], axis: [0, 0, 1]}
  B: {type: R, links: [b, c], point: [0.4, 0.6, 0], axis: [0, 0, 1]}
  C: {type: R, links: [c, d], point: [1.2, 0.2, 0], axis: [0, 0, 1]}
  T: {type: R, links: [ground, d], point: [1, 0, 0], axis: [0, 0, 1]}
couplings:
  K: COUPLING
loads: [{type: gravity, g: [0, -9.81, 0]}]
responses:
  run: {start: {S.theta: 0}, time: {from: 0, to: 0.4, step: 0.1}, tolerance: 1e-12}
"""
COUPLINGS = [
    "{type: linear, terms: {S.theta: 1, T.theta: 1.5}}",
    "{type: gear, joints: [S, T], radii: [0.6, 0.4]}",
    "{type: linear, terms: {A.theta: 1, C.theta: 0.7}}",
    '{type: function, of: S.theta, gives: T.theta, value: "0.5 rad*sin(theta)"}',
]


@pytest.mark.parametrize("coupling", COUPLINGS)
def test_a_coupling_takes_a_freedom_of_a_planar_loop_in_space(coupling: str) -> None:
    """Where constraints are redundant no count tells that one coordinate is free; in the plane it
    does, and the motion is the same."""
    text = GEARED.replace("COUPLING", coupling)
    names = ["S.theta", "A.theta", "B.theta", "T.theta", "T.theta_dot"]
    in_space = mk.loads(text.replace("PLANE\n", "")).respond("run", names)
    flat = re.sub(r"(center_of_mass|point): \[(.*?), 0\]", r"\1: [\2]", text)
    flat = flat.replace(", axis: [0, 0, 1]", "").replace("PLANE", "plane: xy")
    flat = flat.replace("g: [0, -9.81, 0]", "g: [0, -9.81]")
    in_plane = mk.loads(flat).respond("run", names)
    assert in_space.complete
    for name in names:
        np.testing.assert_allclose(in_space[name], in_plane[name], atol=1e-9)
    two = text.replace("PLANE\n", "").replace("{S.theta: 0}", "{S.theta: 0, B.theta: 0}")
    with pytest.raises(mk.InvalidFile, match="names 2 coordinates, which is more than are free"):
        mk.loads(two).respond("run")
    free = text.replace("PLANE\n", "").replace("couplings:\n  K: " + coupling + "\n", "")
    with pytest.raises(mk.InvalidFile, match="names 1 coordinate, but more are free"):
        mk.loads(free).respond("run")
