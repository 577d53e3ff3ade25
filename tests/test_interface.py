"""The Python interface beyond what the commands use."""

from __future__ import annotations

import numpy as np
import pytest
from references import RCSR

import mechkin_cli as mk

ARM = """\
format: 1
links:
  one: {mass: 2, center_of_mass: [0.5, 0, 0], inertia: {xx: 0.01, yy: 0.2, zz: 0.2}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
parameters: {k: 1}
motion: {inputs: {A.theta: {from: 0, to: 90, step: 30, rate: 1 rad/s, acceleration: 2 rad/s^2}}}
loads: [{type: gravity, g: [0, -10, 0]}, {type: torque, joint: A, value: LOAD}]
"""


def arm(load: str = "0", parameters=()):
    return mk.loads(ARM.replace("LOAD", load), "arm.yaml", dict(parameters))


def test_words_of_rows():
    analysis = mk.load(RCSR).analyze(tables=["table_03"])
    assert analysis["row.status"].tolist() == ["ok"] * 27
    assert set(analysis["row.mode"]) == {"B"}  # theta4 at 37 degrees is the larger of the two


def test_a_parameter_may_be_a_number():
    theta = np.radians([0.0, 30.0, 60.0, 90.0])
    held = (0.2 + 2 * 0.25) * 2 + 2 * 10 * 0.5 * np.cos(theta)
    effort = arm("k*3 N*m", {"k": 0.5}).analyze()["A.effort"]
    assert np.abs(effort - (held - 1.5)).max() < 1e-13


def test_an_unknown_mode_is_refused_before_anything_is_written():
    with pytest.raises(mk.UsageError, match="no mode Q at the first row: modes A, B"):
        mk.load(RCSR).analyze(mode="Q")


def test_open_chains_have_a_power_balance_and_no_condition():
    result = arm().analyze().result
    assert (result.power_error <= 1e-15).all()
    assert np.isnan(result.condition).all()
