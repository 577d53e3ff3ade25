"""Pairs that hold idle freedoms: they stand where the text puts their joints, on orthonormal axes,
and what is not conventional is right to both parts."""

from __future__ import annotations

import numpy as np
import pytest
from idle.test_idle_chains import SPHERE_PLANE_SLEEVE, TILTED
from session.tapes import mp

import mechkin_cli as mk
from mechkin_cli.model.model import Model
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.plan.records import flatten
from mechkin_cli.session.kernel_run import Ask, PreciseConstants, RowInputs
from mechkin_cli.tape.decimals import double_doubles

CONCENTRIC = """
format: 1
links: {crank: {}, ball: {}, slide: {}, sleeve: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0.2, 1]}
  S: {type: S, links: [crank, ball], point: [0.4, 0.1, 0.2]}
  T: {type: S, links: [ball, slide], point: [0.4, 0.1, 0.2]}
  P: {type: P, links: [slide, sleeve], point: [0.9, 0, 0], axis: [1, 0.3, 0.1]}
  C: {type: C, links: [ground, sleeve], point: [1, 0.5, 0.3], axis: [0.2, 0.1, 1]}
motion: {inputs: {A.theta: {from: 0, to: 40, step: 10, rate: 5 rad/s}}}
"""


SLIDING = TILTED.replace("MASS", "").replace("ONE", "a, pad").replace("TWO", "b, pad")


@pytest.mark.parametrize("text", [CONCENTRIC, SLIDING])
def test_made_pairs_stand_on_the_text(text: str) -> None:
    made: Model = mk.loads(text)
    session = made.session
    assert any(one.told or one.stop for one in session.problem.held)
    one = session.precise
    found = one.constants(session)
    size = session.layout.mechanism.box_diagonal()
    doubles = np.array(flatten(plan_records(session.layout, size)))
    assert np.all(np.abs(found[:, 0] - doubles) <= 4e-15 * np.maximum(1.0, np.abs(doubles)))
    for joint in one.problem_of(session).solved_mechanism.joints.values():
        for part in joint.parts:
            pairs = double_doubles(one.tape([*part.before.x, *part.before.y, *part.before.z]))
            axes = [[mp.mpf(a) + mp.mpf(b) for a, b in pairs[k : k + 3]] for k in (0, 3, 6)]
            for k in range(3):
                for i in range(3):
                    dot = sum(p * q for p, q in zip(axes[k], axes[i], strict=True))
                    assert abs(dot - (k == i)) <= 1e-31


def test_what_is_not_conventional_is_right_to_both_parts() -> None:
    """The sleeve's height is that of the sphere's centre on the crank."""
    made = mk.loads(SPHERE_PLANE_SLEEVE)
    result = made.analyze(["C.s"], tables=[]).result
    session, given = result.session, made.session.precise.inputs(result.session)
    wanted = (session.problem.quantities()["C.s"],)
    states = result.row_states.states
    constants = session.precise.constants(session)
    batch = session.run(
        RowInputs(given.reduced, states, whole=given.whole, full=given.values),
        Ask(readout=session.readout(wanted)),
        PreciseConstants(constants, session.precise.outputs(session, wanted)),
    )
    assert batch.outputs is not None
    length = mp.sqrt(mp.mpf("1.04"))
    u = [1 / length, mp.mpf(0), mp.mpf("0.2") / length]
    p = [mp.mpf("0.1"), mp.mpf("0.5"), mp.mpf("0.2")]
    along = u[0] * p[0] + u[2] * p[2]
    for row in range(5):
        angle = mp.pi * row / 18
        height = (
            p[2] * mp.cos(angle)
            + (u[0] * p[1] - u[1] * p[0]) * mp.sin(angle)
            + u[2] * along * (1 - mp.cos(angle))
        )
        high, low = batch.outputs[0, :, row]
        assert abs(mp.mpf(high) + mp.mpf(low) + height - p[2]) <= 1e-30
