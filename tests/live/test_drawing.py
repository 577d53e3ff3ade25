"""What a page draws of changed dimensions is what the page of a file with them draws."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import pytest
from live.test_cells import NODE, computed

from mechkin_cli import loads
from mechkin_cli.view.scene import page_data

SLIDER = """
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
parameters: {r: 30 mm, h: 10 mm, k: 2 N/mm, f: 5 N}
links:
  crank: {mass: 1, center_of_mass: [r/2, 0, 0]}
  rod: {}
  slider: {mass: 2, center_of_mass: [130, h, 0]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: S, links: [crank, rod], point: [r, 0, 0]}
  C: {type: S, links: [rod, slider], point: [130, h, 0]}
  D: {type: P, links: [ground, slider], point: [130, h, 0], axis: [1, 0, 0]}
points:
  wall: {link: ground, at: [200, 2*h, 5]}
  eye: {link: slider, at: [140, h, 0]}
  tip: {link: crank, at: [r, 8, 0]}
motion: {inputs: {A.theta: {from: 0, to: 330, step: 30, rate: 10 rad/s}}}
loads:
  - {type: gravity, g: [0, -9810, 0]}
  - {type: spring, between: [wall, eye], stiffness: k, free: 40 mm, preload: f}
  - {type: damper, between: [tip, wall], damping: 0.01}
  - {type: spring, joint: A, coordinate: theta, stiffness: 2 N*mm/deg}
  - {type: damper, joint: D, coordinate: s, damping: 0.001}
  - {type: force, link: crank, point: tip, force: [f, 2, 1], axes: link}
  - {type: force, link: crank, point: [r, 0, 0], force: ["-0.1 N*s*A.theta_dot", 0, 0]}
  - {type: torque, link: slider, torque: [0, f*h, 0]}
  - {type: force, joint: D, value: "-0.02 N*s/mm*D.s_dot"}
view: {between: [{kind: cylinder, points: [tip, wall]}]}
"""
OWN = "{r: 30 mm, h: 10 mm, k: 2 N/mm, f: 5 N}"
CASE = {"r": 33.0, "h": 14.0, "k": 3.0, "f": -7.0}


@pytest.mark.skipif(NODE is None, reason="needs node")
def test_arrows_and_ties_are_those_of_the_changed_file() -> None:
    model = loads(SLIDER)
    data, _ = page_data([model.analyze()], modes=False)
    text = SLIDER.replace(OWN, "{r: 33 mm, h: 14 mm, k: 3 N/mm, f: -7 N}")
    wanted, _ = page_data([loads(text).analyze()], modes=False)
    for case, page in (({}, data), (CASE, wanted)):
        (found,) = computed(data, [case])
        assert found["end"] == "complete"
        theirs = {one["name"]: one for one in page["runs"][0]["branches"][0]["arrows"]}
        mine = {one["name"]: one for one in found["arrows"]}
        assert mine.keys() == theirs.keys()
        assert {"spring on slider", "force on crank, 2", "load at D.s"} <= mine.keys()
        for name, arrow in theirs.items():
            values = np.frombuffer(base64.b64decode(arrow["values"]["f32"]), np.float32)
            own = np.frombuffer(base64.b64decode(mine[name]["values"]), np.float32)
            size = np.abs(values).max()
            np.testing.assert_allclose(own, values, atol=1e-6 * size, err_msg=name)
            np.testing.assert_allclose(mine[name]["place"], arrow["place"], atol=1e-9)
        ties: list[dict[str, Any]] = page["runs"][0]["ties"]
        drawn = found["drawn"]["runs"][0]["ties"] if case else data["runs"][0]["ties"]
        for tie, one in zip(ties, drawn, strict=True):
            np.testing.assert_allclose(one["places"], tie["places"], atol=1e-9)
