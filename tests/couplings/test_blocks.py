"""What is solved together: a coupling with one unknown of its own is a block by itself, before or
behind the loops that go by it; bits do not depend on lanes and threads."""

from __future__ import annotations

import numpy as np
import pytest
from random_families.coupled import draw, text_of

import mechkin_cli as mk
from benchmarks import rcsr
from mechkin_cli.kernel.functions import widths

MOTION = "from: 150 deg, to: 202 deg, step: 2 deg"


def sizes(model: mk.Model) -> list[int]:
    """Of the blocks, in order."""
    return [len(block.unknowns) for block in model.session.graph.blocks]


def test_wheels_in_front_of_a_loop_leave_its_block_as_it_is() -> None:
    alone = mk.loads(rcsr.dimensions().text(MOTION))
    driven = mk.loads(rcsr.behind_wheels("from: -300 deg, to: -404 deg, step: -4 deg"))
    assert sizes(driven) == [1, *sizes(alone)]
    one, other = alone.analyze(), driven.analyze()
    for name in ("O4.theta", "O4.theta_dot", "O2.s_ddot"):
        np.testing.assert_allclose(other[name], one[name], rtol=1e-12)
    wheel = 0.01 * -0.4
    np.testing.assert_allclose(other["M.effort"], wheel - 0.5 * one["O1.effort"], rtol=1e-11)


def test_a_wheel_that_nothing_else_goes_by_comes_behind_its_loop() -> None:
    text = rcsr.dimensions().text(MOTION).replace("links:\n", f"links:\n{rcsr.MOTOR}", 1)
    behind = rcsr.WHEELS.replace("[M, O1]", "[M, O4]")
    behind = behind.replace("pressure_angle: 20 deg", "ideal: true").replace(
        "point: [-s1, 0.9, 0], axis: [-1, 0, 0]",
        "point: [s4*cos(alpha4), P4 + 0.9 m, -s4*sin(alpha4)], "
        "axis: [cos(alpha4), 0, -sin(alpha4)]",
    )
    model = mk.loads(text.replace("joints:\n", behind, 1))
    assert sizes(model) == [3, 1]
    result = model.analyze()
    np.testing.assert_allclose(result["M.theta"], -2.0 * result["O4.theta"], rtol=1e-14)


TRAIN = """format: 1
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{a: {{}}, b: {{}}, c: {{}}, d: {{}}}}
couplings:
  G: {{type: gear, joints: [A, B], teeth: [{0}, {1}]}}
  H: {{type: gear, joints: [B, C], teeth: [{1}, {2}]}}
  F: {{type: function, of: A.theta, gives: D.s, value: "1 m*sin(theta)"}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [ground, b], point: [1, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [ground, c], point: [2, 0, 0], axis: [0, 0, 1]}}
  D: {{type: P, links: [ground, d], point: [0, 1, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{from: -40, to: 4000, count: 99, rate: 3, acceleration: 2}}}}}}
"""


@pytest.mark.parametrize("teeth", [(17, 53, 31), (53, 17, 4999), (1, 999, 7)])
def test_a_train_is_the_product_of_its_ratios_whatever_the_guess(
    teeth: tuple[int, int, int],
) -> None:
    model = mk.loads(TRAIN.format(*teeth))
    assert sizes(model) == [1, 1, 1]
    session = model.session
    inputs = session.inputs.reduced
    near, far = (np.full((session.plan.states, inputs.shape[1]), at) for at in (0.0, -2345.678))
    one, other = session.close(inputs, near), session.close(inputs, far)
    assert one.good.all()
    assert one.states.tobytes() == other.states.tobytes()
    run = model.analyze(["C.theta", "C.theta_dot", "C.theta_ddot", "D.s", "D.s_ddot"])
    assert run.result.sound
    ratio, angle = teeth[0] / teeth[2], run["A.theta"]
    np.testing.assert_allclose(run["C.theta"], ratio * angle, rtol=1e-15)
    np.testing.assert_allclose(run["C.theta_dot"], 3 * ratio, rtol=1e-15)
    np.testing.assert_allclose(run["C.theta_ddot"], 2 * ratio, rtol=1e-15)
    np.testing.assert_allclose(run["D.s"], np.sin(angle), atol=1e-15)
    second = 2 * np.cos(angle) - 9 * np.sin(angle)
    np.testing.assert_allclose(run["D.s_ddot"], second, atol=1e-14)


@pytest.mark.parametrize("seed", [1, 3, 8, 27])
def test_bits_do_not_depend_on_lanes_and_threads(seed: int) -> None:
    model = mk.loads(text_of(draw(seed))[0])
    names = [
        *model.problem.mechanism.coordinates,
        *(f"{k}.power" for k in model.problem.mechanism.couplings),
    ]
    one = model.analyze(lanes=2, threads=1)
    for lanes, threads in (*((width, 1) for width in widths()), (0, 2)):
        other = model.analyze(lanes=lanes, threads=threads)
        for name in names:
            assert one[name].tobytes() == other[name].tobytes()
