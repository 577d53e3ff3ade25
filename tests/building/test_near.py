"""Units of the coordinates that `assembly: near` names."""

from __future__ import annotations

import math

import mechkin_cli as mk

TEXT = """\
format: 1
units: {length: mm}
links: {one: {}, two: {}, three: {}, four: {}}
joints:
  A: {type: U, links: [ground, one], point: [0, 0, 0], axis: [1, 0, 0], axis2: [0, 1, 0]}
  B: {type: E, links: [one, two], point: [1, 0, 0], normal: [0, 0, 1], x: [1, 0, 0]}
  C: {type: R, links: [two, three], point: [0, 1, 0], axis: [1, 1, 1]}
  D: {type: R, links: [ground, four], point: [0, 2, 3], axis: [1, -1, 2]}
  F: {type: U, links: [three, four], point: [0, 2, 5], axis: [1, 4, 0], axis2: [0, 1, 3]}
motion: {inputs: {D.theta: {at: 0}, C.theta: {at: 0}, A.theta1: {at: 0}}}
assembly: {near: {A.theta2: 90, B.x: 2, B.y: 3, B.theta: 180, F.theta1: -90 deg}}
"""


def test_angles_and_lengths():
    near = mk.loads(TEXT).problem.assembly.near
    half = math.pi / 2
    wanted = {"A.theta2": half, "B.x": 0.002, "B.y": 0.003, "B.theta": 2 * half, "F.theta1": -half}
    assert near.keys() == wanted.keys()
    for name, value in wanted.items():
        assert abs(near[name] - value) <= 1e-15 * abs(value)
