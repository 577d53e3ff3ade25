"""A response that begins where one of its coordinates is at a dead centre."""

from __future__ import annotations

import mpmath as mp
import numpy as np

import mechkin_cli as mk

TEXT = """
format: 1
name: pump
plane: xy
units: {length: mm, angle: deg, force: N}
parameters: {r: 30 mm, l: 50 mm, x: "sqrt(l^2 - r^2)"}
links: {crank: {mass: 1, center_of_mass: [0, 0], inertia: 900}, rod: {}, block: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0]}
  B: {type: R, links: [crank, rod], point: [0, r]}
  C: {type: R, links: [rod, block], point: [x, 0]}
  D: {type: P, links: [ground, block], point: [x, 0], axis: [1, 0]}
responses:
  free:
    start: {START}
    time: {from: 0, to: 1, count: 3}
tables:
  - {name: t, columns: [time, A.theta, A.theta_dot, D.s]}
"""
NAMES = ["A.theta", "A.theta_dot", "D.s"]


def run(start: str) -> mk.Analysis:
    return mk.loads(TEXT.replace("START", start)).respond("free", NAMES)


def test_a_rate_that_the_coordinate_cannot_have_is_refused() -> None:
    r = run("D.s: 40, D.s_dot: 1 mm/s")
    (said,) = [note for note in r.diagnostics if note.severity == "error"]
    assert said.code == "start-at-dead-centre"
    assert "dead centre of D.s" in str(said)
    assert "start" in str(said.hint)
    assert np.isnan(r["A.theta_dot"]).all()


def test_the_rate_of_what_moves_there_starts_it() -> None:
    r = run("D.s: 40, A.theta_dot: 1 rad/s")
    assert set(r["row.status"]) == {"ok"}
    # a wheel without friction keeps its rate; the slide follows it
    np.testing.assert_allclose(r["A.theta_dot"], 1.0, rtol=1e-9)
    with mp.workdps(30):
        # from the dead centre at -90 degrees, the crank along x
        at = [30 * mp.cos(t) + mp.sqrt(2500 - 900 * mp.sin(t) ** 2) - 40 for t in (0, 0.5, 1)]
    np.testing.assert_allclose(r["D.s"], np.array(at, dtype=float), rtol=1e-8)


def test_at_rest_it_may_begin_there() -> None:
    r = run("D.s: 40")
    assert set(r["row.status"]) == {"ok"}
    np.testing.assert_allclose(r["A.theta"], -90.0, atol=1e-5)


def test_just_beside_it_is_no_dead_centre() -> None:
    r = run("D.s: 39.999, D.s_dot: 1 mm/s")
    assert r["row.status"][0] == "ok"
