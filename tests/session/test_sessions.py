"""Sessions of parts of a file and with loads of all kinds; what rounding constants alone does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from session.tapes import model, mp, true_outputs

import mechkin_cli as mk
from mechkin_cli.plan.plan import plan_records
from mechkin_cli.plan.records import flatten
from mechkin_cli.session.double_double import Precise
from mechkin_cli.session.kernel_run import Ask, PreciseConstants, RowInputs
from mechkin_cli.tape.decimals import double_doubles

LOADED = """
format: 1
parameters: {k: 2.3 N/m, r: 0.1}
links:
  arm: {mass: 1.1, center_of_mass: [0.3, 0, 0], inertia: {xx: 0.01, yy: 0.02, zz: 0.3}}
  slide: {mass: 0.7, center_of_mass: [0.9, 0, 0]}
joints:
  O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0.1, 1]}
  Q: {type: P, links: [arm, slide], point: [0.7, 0, 0], axis: [1, 0, 0]}
points: {tip: {link: slide, at: [1.1, 0.2, 0]}, post: {link: ground, at: [0, 1.1, 0]}}
motion:
  time: {from: 0, to: 1, step: 0.1}
  inputs: {O.theta: {law: constant-rate, at: 5, rate: 12.3 deg/s}, Q.s: {at: 0.1}}
loads:
  - {type: gravity, g: standard}
  - {type: torque, joint: O, value: 0.1 N*m*sin(3.3*O.theta) + r*0.7 N*m}
  - {type: force, joint: Q, value: -k*Q.s - 0.1 N*s*tip.velocity.x/(1 m)}
  - {type: spring, between: [post, tip], stiffness: 33.3 N/m, free: 0.3}
tables: [{name: t, columns: [O.theta, O.effort]}]
"""


def checked(session: Any, one: Precise) -> Any:
    """Constants that are right to both parts, and next to the session's doubles."""
    tape = one.tape(one._constants(session))
    found = double_doubles(tape)
    size = session.size or session.layout.mechanism.box_diagonal()
    doubles = np.array(flatten(plan_records(session.layout, size)))
    assert np.all(np.abs(found[:, 0] - doubles) <= 4e-15 * np.maximum(1.0, np.abs(doubles)))
    for (high, low), true in zip(found, true_outputs(tape), strict=True):
        assert abs(mp.mpf(high) + mp.mpf(low) - true) <= mp.mpf(2) ** -104 * abs(true) + 1e-55
    return found


def test_constants_of_programs() -> None:
    made = mk.loads(LOADED)
    found = checked(made.session, made.session.precise).tolist()
    tenth = [0.1, float(-mp.mpf(0.1) + mp.mpf(1) / 10)]
    assert tenth in found  # of the law
    assert [0.7, float(mp.mpf(7) / 10 - mp.mpf(0.7))] in found  # the mass, and of the law
    assert [0.1 * 0.7, float(mp.mpf("0.07") - mp.mpf(0.1 * 0.7))] in found or any(
        abs(mp.mpf(a) + mp.mpf(b) - mp.mpf("0.07")) < 1e-33 for a, b in found
    )


def test_standard_gravity_is_exact() -> None:
    made = mk.loads(LOADED)
    one = made.session.precise
    found = double_doubles(one.tape(one.problem.mechanism.gravity))
    assert abs(mp.mpf(found[2, 0]) + mp.mpf(found[2, 1]) + mp.mpf("9.80665")) < 1e-30


def test_loops_that_are_followed() -> None:
    made = model("rcsr_csr_loop_one")
    part = made.analyze().result.session
    assert part.problem is not made.session.problem
    assert checked(part, part.precise).shape[0] < checked(made.session, part.precise).shape[0]


def test_sessions_with_other_loads() -> None:
    session = mk.loads(LOADED).session
    mechanism = session.problem.mechanism
    one_load = replace(mechanism, loads=(mechanism.loads[-1],))
    checked(
        session.loaded(replace(session.problem, mechanism=one_load, load_laws=())), session.precise
    )


def test_curves_of_loads_are_constants_like_others(tmp_path: Path) -> None:
    (tmp_path / "f.csv").write_text("time,force\n0,1\n0.4,2\n1,1.3\n", encoding="utf-8")
    file = tmp_path / "f.yaml"
    file.write_text(
        LOADED.replace("-k*Q.s - 0.1 N*s*tip.velocity.x/(1 m)", "{table: f.csv, over: time}")
    )
    session = mk.load(file).session
    checked(session, session.precise)
    assert (session.precise.enclosed_constants(session)[:, 2] > 0.0).any()


def test_rounding_the_constants_alone_moves_the_rows() -> None:
    """RCSR's theta4 at the rows of its tables: by some 1e-16, and no more."""
    made = model("rcsr")
    result = made.analyze(["O4.theta"], tables=[]).result
    session = result.session
    wanted = (session.problem.quantities()["O4.theta"],)
    given = session.precise.inputs(session)
    exact = session.precise.constants(session)
    rounded = np.stack([exact[:, 0], np.zeros(len(exact))], axis=1)

    def theta4(constants: Any) -> Any:
        states = result.row_states.states
        batch = session.run(
            RowInputs(given.reduced, states, whole=given.whole, full=given.values),
            Ask(readout=session.readout(wanted)),
            PreciseConstants(constants, session.precise.outputs(session, wanted)),
        )
        assert batch.good.all()
        return batch.outputs[0]

    true, other = theta4(exact), theta4(rounded)
    moved = np.abs((true[0] - other[0]) + (true[1] - other[1])).max()
    assert 2e-16 < moved < 2e-15
