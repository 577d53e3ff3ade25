"""The balance of powers: what it tells, and where nothing works.

`test_changed_sources.py` shows that it sees a fault in the balance of forces.
"""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk

MECHANISM = """
format: 1
links:
  crank: {mass: 2, center_of_mass: [0.05, 0, 0], inertia: {xx: .01, yy: .02, zz: .02}}
  rod: {mass: 1, center_of_mass: [0.2, 0.1, 0], inertia: {xx: .01, yy: .02, zz: .03, xy: .005}}
  slider: {mass: 3, center_of_mass: [0.4, 0, 0]}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: U, links: [crank, rod], point: [0.1, 0, 0], axis: [0, 0, 1], axis2: [0, 1, 0]}
  C: {type: S, links: [rod, slider], point: [0.4, 0.1, 0.05]}
  D: {type: P, links: [ground, slider], point: [0.4, 0.1, 0.05], axis: [1, 0, 0]}
points: {p: {link: rod, at: [0.2, 0.1, 0.1]}, q: {link: ground, at: [0.2, 0.4, 0]}}
motion: {inputs: {A.theta: {from: 20, to: 120, step: 20, rate: 3 rad/s, acceleration: 2 rad/s^2}}}
loads:
  - {type: gravity, g: [1, -9.81, 0.5]}
  - {type: spring, between: [p, q], stiffness: 200, free: 0.1, preload: 3}
  - {type: damper, between: [p, q], damping: 7}
  - {type: spring, joint: D, coordinate: s, stiffness: 100, free: 0.1}
  - {type: damper, joint: A, coordinate: theta, damping: 0.4}
  - {type: force, joint: D, value: -20}
  - {type: force, link: slider, point: [0.5, 0, 0], force: [3, 4, 5], axes: link}
  - {type: torque, link: rod, torque: [1, 2, 3]}
"""


def test_all_parts_balance() -> None:
    error = mk.loads(MECHANISM).analyze(["A.effort"])["row.power_error"]
    assert error.max() < 1e-14
    assert error.max() > 0.0


def test_nothing_is_told_where_nothing_moves() -> None:
    still = MECHANISM.replace("rate: 3 rad/s, acceleration: 2 rad/s^2", "rate: 0 rad/s")
    analysis = mk.loads(still).analyze(["A.effort"])
    assert np.isnan(analysis["row.power_error"]).all()
    assert np.abs(analysis["A.effort"]).max() > 1.0


NOTHING_WORKS = """
format: 1
links: {k: {}, c: {}, r: {}}
joints:
  P: {type: P, links: [ground, k], point: [0.7, -0.2, 0.1], axis: [0.3, 0.8, 0.3]}
  R: {type: R, links: [k, c], point: [-0.9, 0.5, 0.1], axis: [-1.3, 0.9, 0.4]}
  S: {type: S, links: [c, r], point: [-0.3, 0.6, -0.4]}
  C: {type: C, links: [ground, r], point: [-0.1, -0.7, -0.2], axis: [0.3, 0.8, 0.3]}
motion: {inputs: {P.s: {from: 0, to: 1, step: 0.1, rate: 1}}}
loads:
  - {type: torque, joint: C, value: 3}
"""
"""All is carried along by P, parallel to C's axis: C does not turn, and P moves against nothing."""


@pytest.mark.parametrize("factor", [1e-6, 1.0, 1e9])
@pytest.mark.parametrize("rate", ["1", "1e-5", "3000"])
def test_nothing_is_told_where_nothing_works(factor: float, rate: str) -> None:
    text = NOTHING_WORKS.replace("value: 3", f"value: {3 * factor!r}")
    analysis = mk.loads(text.replace("rate: 1}", f"rate: {rate}}}")).analyze(["C.force"])
    assert np.isnan(analysis["row.power_error"]).all()
    assert np.abs(analysis["P.s_dot"]).min() > 0.0


@pytest.mark.parametrize("part", [1.0, 1e-4, 1e-8])
def test_what_works_a_little_is_told(part: float) -> None:
    """A small force along P beside the large torque that does not work."""
    text = NOTHING_WORKS + f"  - {{type: force, joint: P, value: {part}}}\n"
    analysis = mk.loads(text).analyze(["P.effort"])
    assert np.abs(analysis["P.effort"] + part).max() < 1e-13
    # both powers are the same product but for a rounding of the torque's level
    assert analysis["row.power_error"].max() < 1e-14 / part


@pytest.mark.parametrize("off", [0.0, 3.0, 30.0, 3000.0])
def test_what_works_is_told_wherever_the_drawing_lies(off: float) -> None:
    text = NOTHING_WORKS + "  - {type: force, joint: P, value: 1}\n"
    for old in ("[0.7, ", "[-0.9, ", "[-0.3, ", "[-0.1, "):
        text = text.replace(f"point: {old}", f"point: [{float(old[1:-2]) + off}, ")
    assert mk.loads(text).analyze(["P.effort"])["row.power_error"].max() < 1e-10
