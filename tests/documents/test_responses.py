"""The example of the page on responses against closed forms."""

from math import radians, sin, sqrt

import pytest
from documents.reading import blocks, page
from mpmath import ellipk

import mechkin_cli as mk


def test_the_example_of_responses_against_elliptic_functions_and_a_balance_of_power() -> None:
    (text,) = blocks(page("docs/responses.md"), "yaml")
    model = mk.loads(text, "responses.yaml")
    assert model.runs == ("swing", "start_up")
    swing = model.respond("swing")
    half = 2.0 * ellipk(sin(radians(40.0)) ** 2) / sqrt(9.81 / 0.25)
    assert swing["time"][-1] == pytest.approx(float(half), rel=1e-9)
    assert swing["A.theta"][-1] == pytest.approx(-80.0, abs=1e-6)
    assert swing["row.event"][-1] == "dead centre of A.theta"
    assert max(swing["row.energy_error"]) < 1e-9
    (table,) = swing.tables
    assert table.name == "half_swing"
    start_up = model.respond("start_up")
    assert start_up["row.event"][-1] == "3 turns of A.theta"
    assert start_up["A.theta"][-1] == pytest.approx(3.0 * 360.0, rel=1e-12)
    torque = 8000.0 - 400.0 * start_up["A.theta_dot"]
    assert start_up["A.effort"] == pytest.approx(torque, rel=1e-12)
    weight, arm, inertia = 2.0 * 9.81, 250.0, 2.0 * 0.25**2 * 1e3
    for effort, angle, rate, acceleration in zip(
        start_up["A.effort"],
        start_up["A.theta"],
        start_up["A.theta_dot"],
        start_up["A.theta_ddot"],
        strict=True,
    ):
        left = effort - weight * arm * sin(radians(angle)) - 20.0 * rate
        assert acceleration * inertia == pytest.approx(left, rel=1e-9, abs=1e-9)
