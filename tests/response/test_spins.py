"""A coupler between two balls: its spin is a freedom with inertia, which the start has to name."""

from __future__ import annotations

import numpy as np
import pytest
from oracle.document import document
from oracle.dynamics.response import prepare
from response.motions import off, respond

import mechkin_cli as mk

BALLS = """format: 1
units: {angle: rad}
links:
  crank: {mass: 1, center_of_mass: [0, 0.1, 0], inertia: {xx: .01, yy: .01, zz: .01}}
  rod: {mass: 0.5, center_of_mass: [0.3, 0.35, 0.05], inertia: {xx: .002, yy: .004, zz: .004}}
  rocker: {mass: 1, center_of_mass: [0.6, 0.15, 0.1], inertia: {xx: .01, yy: .01, zz: .01}}
joints:
  O: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  A: {type: S, links: [crank, rod], point: [0, 0.2, 0]}
  B: {type: S, links: [rod, rocker], point: [0.6, 0.3, 0.1]}
  D: {type: R, links: [ground, rocker], point: [0.6, 0, 0.1], axis: [0, 0.2, 1]}
loads: [{type: gravity, g: [3, -9.81, 2]}]
responses:
  run:
    start: {O.theta: 0}
    time: {from: 0, to: 0.3, step: 0.1}
    tolerance: 1e-13
"""


def with_spin_named() -> str:
    """As the message says: one ball is an R along the line and a U."""
    ball = "  B: {type: S, links: [rod, rocker], point: [0.6, 0.3, 0.1]}"
    parts = (
        "  N: {type: R, links: [rod, pin], point: [0.6, 0.3, 0.1], axis: [0.6, 0.1, 0.1]}\n"
        "  B: {type: U, links: [pin, rocker], point: [0.6, 0.3, 0.1], axis: [0, 1, -1],"
        " axis2: [0, 0, 1]}"
    )
    text = BALLS.replace(ball, parts).replace("  rocker: {mass", "  pin: {}\n  rocker: {mass")
    return text.replace("{O.theta: 0}", "{O.theta: 0, N.theta: 0}")


def test_a_mass_off_the_line_of_two_balls_is_refused_with_the_cure() -> None:
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(BALLS, "balls.yaml").respond("run")
    (error,) = caught.value.diagnostics
    assert str(error).startswith("balls.yaml:5:8: error: rod spins freely about A-B")
    assert "give it a coordinate that start names: write one S as an R along that line" in str(
        error
    )


def test_what_the_cure_says_moves_as_newton_and_euler_say() -> None:
    text = with_spin_named()
    exact = prepare(document(text)).run(1e-13)
    found = respond(text)
    for name in ("O.theta", "N.theta", "D.theta", "N.theta_dot", "O.theta_ddot"):
        assert off(found[name], exact[name]) < 1e-9, name
    assert np.ptp(found["N.theta"]) > 0.1
    assert max(found["row.energy_error"]) < 1e-11


def test_a_mass_on_the_line_keeps_no_spin() -> None:
    on_line = BALLS.replace("[0.3, 0.35, 0.05]", "[0.3, 0.25, 0.05]").replace(
        "inertia: {xx: .002, yy: .004, zz: .004}", "inertia: {xx: .003, yy: .003, zz: .003}"
    )
    found = respond(on_line)
    assert max(found["row.energy_error"]) < 1e-11


def test_a_sleeve_that_turns_freely_may_be_started_by_its_coordinate() -> None:
    sleeve = BALLS.replace(
        "B: {type: S, links: [rod, rocker], point: [0.6, 0.3, 0.1]}",
        "B: {type: C, links: [rod, rocker], point: [0.6, 0.3, 0.1], axis: [0.6, 0.1, 0.1]}",
    ).replace("D: {type: R,", "D: {type: C,")
    with pytest.raises(mk.InvalidFile) as caught:
        mk.loads(sleeve, "sleeve.yaml").respond("run")
    assert "name B.theta in start: it is a freedom as others are" in str(caught.value)
    named = sleeve.replace("{O.theta: 0}", "{O.theta: 0, B.theta: 0}")
    exact, found = prepare(document(named)).run(1e-13), respond(named)
    for name in ("O.theta", "B.theta", "D.s", "B.theta_dot"):
        assert off(found[name], exact[name]) < 1e-9, name
