"""Kinks within kinks, and steps that end exactly at one: closed forms, whatever the rows."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
from response.motions import respond
from scipy.integrate import solve_ivp

import mechkin_cli as mk

SLIDER = """format: 1
name: slider
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{a: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{A: {{type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}}}}
loads:
  - {{type: force, joint: A, value: "1 N*({load})"}}
responses:
  r: {{start: {{A.s: 0 m, A.s_dot: {rate} m/s}}, time: {{from: 0, to: {end}, count: {count}}}}}
"""
T, V, S = "time/(1 s)", "A.s_dot/(1 m/s)", "A.s/(1 m)"
LIMIT = (1.3 + 2.9 * 3.5) / 2.9

CASES = {
    # load: (rate at the start, duration, rate at the end)
    f"max(0, sign({T} - 0.3))": (0.0, 1.0, 0.7),
    f"max(0, sign({T} - 0.3))*max(0, sign(0.6 - {T}))": (0.0, 1.0, 0.3),
    f"min(0.2, sign(0.505 - {T}))": (0.0, 1.0, 0.2 * 0.505 - 0.495),
    # to 0.1 at 0.2, then 1
    f"max(0.2, sign({V} - 0.1))": (0.0, 1.0, 0.6),
    f"min(min(0.56, {T}), {T})": (0.0, 1.0, 0.4032),
    f"min(min(0.56, {T}), max({T}, {T}))": (0.0, 1.0, 0.4032),
    f"abs(min(-0.4, {S}))": (0.3, 1.0, 0.7),
    f"sqrt(1 + abs(min(-1.24, {S}))*abs(min(-1.24, {S})))": (0.0, 1.0, (1 + 1.24**2) ** 0.5),
    f"abs(abs({V}))": (-0.69, 1.0, -0.69 * exp(-1)),
    f"1 + max({V}, 0.12)": (0.0, 1.0, 1.12 * exp(1 - 0.12 / 1.12) - 1),
    f"min(1.3, 11.45 - 2.9*{V})": (0.0, 3.0, LIMIT + (3.5 - LIMIT) * exp(-2.9 * (3 - 35 / 13))),
}


@pytest.mark.parametrize("load", CASES)
def test_a_kink_within_a_kink_is_passed_by_both(load: str) -> None:
    rate, end, expected = CASES[load]
    for count in (2, 3, 5, 11, 21, 101, 1001):
        text = SLIDER.format(load=load, rate=rate, end=end, count=count)
        rows = mk.loads(text).respond("r", ["A.s_dot", "A.s_ddot"])
        assert set(rows["row.status"]) == {"ok"}
        assert rows["A.s_dot"][-1] == pytest.approx(expected, abs=1e-10), count


def test_the_first_row_has_the_sides_of_the_kinks_within() -> None:
    for load, rate, expected in (
        (f"abs(min(-0.4, {S}))", 0.3, 0.4),
        (f"abs(abs({V}))", -0.69, 0.69),
        (f"abs(max(-0.87, {S}))", -1.0, 0.0),
        (f"min(max({S}, 1), {T})", 0.0, 0.0),
    ):
        text = SLIDER.format(load=load, rate=rate, end=1, count=5)
        first = mk.loads(text).respond("r", ["A.s_ddot"])["A.s_ddot"][0]
        assert first == pytest.approx(expected, abs=1e-15), load


def test_where_a_step_ends_at_its_kink_does_not_matter() -> None:
    """The kink lies at the end of a step, or next to it, for some of the constants and rows."""
    for k in range(2, 98, 5):
        c = k / 100
        expected = (1 + c) * exp(1 - c / (1 + c)) - 1
        for count in (2, 5):
            text = SLIDER.format(load=f"1 + max({V}, {c})", rate=0, end=1, count=count)
            have = mk.loads(text).respond("r", ["A.s_dot"])["A.s_dot"][-1]
            assert np.abs(have - expected) < 1e-9, (c, count)


HIDING = """format: 1
name: a kink that hides another
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{a: {{mass: 1, center_of_mass: [0, 0, 0]}}, b: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints:
  A: {{type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}}
  B: {{type: P, links: [ground, b], point: [0, 0, 0], axis: [0, 1, 0]}}
loads:
  - type: force
    joint: A
    value: 1 N*max(min(A.s/(1 m), A.s_dot/(1 m/s))*(B.s/(1 m) + B.s_dot/(1 m/s)), 1)
  - {{type: force, joint: B, value: 1 N*(B.s/(1 m) + A.s_dot/(1 m/s) + time/(1 s))}}
responses:
  run:
    start: {{A.s: 0.183, A.s_dot: -1.647, B.s: -0.007, B.s_dot: 0}}
    time: {{from: 0, to: 1, count: {count}}}
"""


def test_a_kink_hidden_by_another_that_ends_within_the_same_step() -> None:
    def rates(time: float, y: list[float]) -> list[float]:
        a, b, v, w = y
        return [v, w, max(min(a, v) * (b + w), 1.0), b + v + time]

    start = [0.183, -0.007, -1.647, 0.0]
    exact = solve_ivp(rates, (0, 1), start, method="DOP853", rtol=1e-12, atol=1e-13, max_step=1e-3)
    for count in (2, 3, 11, 101, 500):
        found = respond(HIDING.format(count=count))
        assert found["A.s_dot"][-1] == pytest.approx(exact.y[2, -1], abs=1e-7), count
