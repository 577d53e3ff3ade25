"""Functions of a coordinate with constants that are zero: recorded alike by doubles and by exact
numbers, whose constants are compared one by one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import mechkin_cli as mk

TEXT = """format: 1
plane: xy
units: {length: m, angle: rad}
parameters: {k: 0 m, n: 0}
links: {p: {mass: 1, center_of_mass: [0, 0]}, w: {mass: 1, center_of_mass: [0, 1]}}
joints:
  S: {type: P, links: [ground, p], point: [0, 0], axis: [1, 0]}
  W: {type: P, links: [ground, w], point: [0, 1], axis: [1, 0]}
couplings:
  K: {type: function, of: S.s, gives: W.s, value: "VALUE"}
"""
SWEPT = "motion: {inputs: {S.s: {from: 0.5, to: 1, count: 3, rate: 1 m/s}}}\n"
FREE = "responses: {r: {start: {S.s: 1, S.s_dot: 1 m/s}, time: {from: 0, to: 1, count: 3}}}\n"
FUNCTIONS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "if(s > 0 m, s, 0 m)": lambda s: s,
    "if(s <= 0 m, 0 m, 2*s)": lambda s: 2.0 * s,
    "s*(s >= 0 m)": lambda s: s,
    "if(s/(1 m) > 0, s, 0 m)": lambda s: s,
    "max(s, 0 m)": lambda s: s,
    "max(s, k)": lambda s: s,
    "(s - k)*2": lambda s: 2.0 * s,
    "s*n + s": lambda s: s,
    "n*s - 3*s + k": lambda s: -3.0 * s,
    "s + k/(1 + s/(1 m))": lambda s: s,
    "s - k*sin(s/(1 m)*1 rad)": lambda s: s,
    "s^2/(1 m) + n*s": lambda s: s * s,
    "s + n*sqrt(s*s + 1 m^2 + k*k)": lambda s: s,
}


@pytest.mark.parametrize("value", FUNCTIONS)
def test_zeros_are_recorded_as_other_numbers(value: str) -> None:
    text = TEXT.replace("VALUE", value)
    swept = mk.loads(text + SWEPT).analyze(["S.s", "W.s", "row.error_bound"])
    assert swept.complete
    np.testing.assert_allclose(swept["W.s"], FUNCTIONS[value](swept["S.s"]), atol=1e-14)
    assert np.all(swept["row.error_bound"] < 1e-12)
    free = mk.loads(text + FREE).respond("r", ["S.s", "W.s"])
    assert free.complete
    np.testing.assert_allclose(free["W.s"], FUNCTIONS[value](free["S.s"]), atol=1e-12)
