"""What is solved together: a coupling with one unknown of its own is a block by itself, before or
behind the loops that go by it; bits do not depend on lanes and threads."""

from __future__ import annotations

import numpy as np
import pytest
from random_families.coupled import draw, text_of

import mechkin_cli as mk
from benchmarks import rcsr

MOTION = "from: 150 deg, to: 202 deg, step: 2 deg"
MOTOR = """  motor: {mass: 1, center_of_mass: [-s1, 0.9 m, 0], inertia: {xx: .01, yy: .01, zz: .01}}
"""
GEAR = """couplings: {G: {type: gear, joints: [M, O1], teeth: [20, 40], pressure_angle: 20 deg}}
joints:
  M: {type: R, links: [ground, motor], point: [-s1, 0.9, 0], axis: [-1, 0, 0]}
"""


def geared() -> str:
    """RCSR whose crank is driven through a pair of wheels."""
    text = rcsr.dimensions().text(MOTION)
    law = "rate: 0.1 rad/s, acceleration: 0.2 rad/s^2"
    text = text.replace(MOTION, "from: -300 deg, to: -404 deg, step: -4 deg")
    text = text.replace(law, "rate: -0.2 rad/s, acceleration: -0.4 rad/s^2")
    text = text.replace("  O1.theta: {from", "  M.theta: {from")
    return text.replace("links:\n", f"links:\n{MOTOR}", 1).replace("joints:\n", GEAR, 1)


def sizes(model: mk.Model) -> list[int]:
    """Of the blocks, in order."""
    return [len(block.unknowns) for block in model.session.graph.blocks]


def test_wheels_in_front_of_a_loop_leave_its_block_as_it_is() -> None:
    alone, driven = mk.loads(rcsr.dimensions().text(MOTION)), mk.loads(geared())
    assert sizes(driven) == [1, *sizes(alone)]
    one, other = alone.analyze(), driven.analyze()
    for name in ("O4.theta", "O4.theta_dot", "O2.s_ddot"):
        np.testing.assert_allclose(other[name], one[name], rtol=1e-12)
    wheel = 0.01 * -0.4
    np.testing.assert_allclose(other["M.effort"], wheel - 0.5 * one["O1.effort"], rtol=1e-11)


def test_a_wheel_that_nothing_else_goes_by_comes_behind_its_loop() -> None:
    text = rcsr.dimensions().text(MOTION).replace("links:\n", f"links:\n{MOTOR}", 1)
    behind = GEAR.replace("[M, O1]", "[M, O4]").replace("pressure_angle: 20 deg", "ideal: true")
    behind = behind.replace(
        "point: [-s1, 0.9, 0], axis: [-1, 0, 0]",
        "point: [s4*cos(alpha4), P4 + 0.9 m, -s4*sin(alpha4)], "
        "axis: [cos(alpha4), 0, -sin(alpha4)]",
    )
    model = mk.loads(text.replace("joints:\n", behind, 1))
    assert sizes(model) == [3, 1]
    result = model.analyze()
    np.testing.assert_allclose(result["M.theta"], -2.0 * result["O4.theta"], rtol=1e-14)


@pytest.mark.parametrize("seed", [1, 3, 8, 27])
def test_bits_do_not_depend_on_lanes_and_threads(seed: int) -> None:
    model = mk.loads(text_of(draw(seed))[0])
    names = [
        *model.problem.mechanism.coordinates,
        *(f"{k}.power" for k in model.problem.mechanism.couplings),
    ]
    one = model.analyze(lanes=2, threads=1)
    for lanes, threads in ((4, 1), (0, 1), (0, 2)):
        other = model.analyze(lanes=lanes, threads=threads)
        for name in names:
            assert one[name].tobytes() == other[name].tobytes()
