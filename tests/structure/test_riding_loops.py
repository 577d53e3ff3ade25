"""A loop on a link that another loop moves: its link is moved first, answers are the oracle's."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from oracle import assemble_rows, read

import mechkin_cli as mk

TEXT = """\
format: 1
units: {angle: rad}
links: {a: {}, b: {}, c: {}, d: {}}
joints:
  D: {type: C, links: [a, c], point: [0, 1, 0], axis: [1, 0, 1]}
  E: {type: S, links: [c, d], point: [1, 3, 1]}
  F: {type: U, links: [d, a], point: [2, 1, 0], axis: [1, 1, 0], axis2: [1, 0, 3]}
  O: {type: C, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: S, links: [a, b], point: [1, 0, 1]}
  B: {type: C, links: [ground, b], point: [3, 1, 0], axis: [0, 1, 3]}
motion:
  inputs:
    O.theta: {from: 0, to: 0.2, count: 3, rate: 1, acceleration: 0.5}
    D.s: {from: 0, to: 0.1, count: 3, rate: -0.5, acceleration: 0.3}
"""
RIGID = TEXT.replace("D: {type: C", "D: {type: R").split("    D.s:")[0]
"""Without an input of its own the riding loop cannot move."""

BOTH = pytest.mark.parametrize("text", [TEXT, RIGID], ids=["driven", "rigid"])
RATES = ("", "_dot", "_ddot")


@cache
def solutions(text: str):
    return assemble_rows(read(text))


@BOTH
def test_as_the_oracle(text):
    joints = read(text).joints.items()
    names = [f"{n}.{c}{rate}" for n, j in joints for c in j.coordinates for rate in RATES]
    analysis = mk.loads(text).analyze(names)
    assert not analysis.result.status.any()
    for name in names:
        wanted = np.array([float(row[name]) for row in solutions(text)])
        assert np.max(np.abs(analysis[name] - wanted)) <= 1e-13


@BOTH
def test_the_carrying_loop_comes_first(text):
    graph = mk.loads(text).graph
    first, second = (graph.closings[block.closings[0]].joint.name for block in graph.blocks)
    assert first in "OAB"
    assert second in "DEF"
