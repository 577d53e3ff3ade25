"""Loads with choices and steps in responses: their jumps and kinks are found as those of `sign` and
`abs` are, so that the motion has all digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from response.oscillators import MASS
from response.test_oscillators import EXACT, run

REST = "start: {S.s: 0, S.s_dot: 0}"
MOVING = "start: {S.s: 0.3, S.s_dot: -1}"


def pushed(load: str, start: str = REST) -> Any:
    return run([f'- {{type: force, joint: S, value: "{load}"}}'], [start])


@pytest.mark.parametrize(
    ("load", "impulse"),
    [
        ("2 N*if(time > 1 s and time < 2 s, 1, 0)", lambda t: 2 * np.clip(t - 1, 0, 1)),
        ("if(time < 1 s, 0 N, if(time > 2 s, 0 N, 2 N))", lambda t: 2 * np.clip(t - 1, 0, 1)),
        ("2 N*(not time < 1 s)", lambda t: 2 * np.clip(t - 1, 0, None)),
        (
            "1 N*floor(time/(0.5 s))",
            lambda t: sum(np.clip(t - k / 2, 0, None) for k in range(1, 7)),
        ),
        (
            "2 N*mod(time/(1 s), 0.75)",
            lambda t: np.floor(t / 0.75) * 0.75**2 + (t - 0.75 * np.floor(t / 0.75)) ** 2,
        ),
        (
            "clip(4 N/s*(time - 1 s), 0 N, 2 N)",
            lambda t: 2 * np.clip(t - 1, 0, 0.5) ** 2 + 2 * np.clip(t - 1.5, 0, None),
        ),
    ],
)
def test_impulses_in_closed_form(load: str, impulse: Any) -> None:
    rows = pushed(load)
    assert np.abs(rows["S.s_dot"] - impulse(rows["time"]) / MASS).max() < EXACT


@pytest.mark.parametrize(
    "load",
    [
        "if(S.s > 0 m, -50 N/m*S.s, 0 N)",
        "-50 N/m*S.s*if(S.s >= 0 m, 1, 0)",
        "-50 N/m*S.s*(S.s > 0 m)",
        "if(not S.s <= 0 m and time >= 0 s, -50 N/m*S.s, 0 N)",
        "if(S.s > 0 m, -50 N/m*S.s, 0 N*sqrt(1 + S.s/(1 m)*S.s/(1 m)))",
    ],
)
def test_a_spring_that_only_pushes_is_one_however_it_is_written(load: str) -> None:
    one, other = pushed("-50 N/m*max(S.s, 0 m)", MOVING), pushed(load, MOVING)
    assert np.abs(one["S.s"] - other["S.s"]).max() < EXACT
    assert np.abs(one["S.s"] - pushed("-50 N/m*S.s", MOVING)["S.s"]).max() > 0.1


def test_what_has_no_value_beyond_a_kink_is_integrated_up_to_it() -> None:
    """Hertz's contact is a power of what is negative where nothing touches. Its motion until then
    conserves m v^2/2 + 20 k x^2.5, and goes on at the rate with which it leaves."""
    for load in ("if(S.s > 0 m, -50 N*pow(S.s/1 m, 1.5), 0 N)", "-50 N*pow(max(S.s/1 m, 0), 1.5)"):
        rows = pushed(load, "start: {S.s: 0.3, S.s_dot: 0}")
        energy = MASS * rows["S.s_dot"] ** 2 / 2 + 20 * np.maximum(rows["S.s"], 0.0) ** 2.5
        assert np.abs(energy - energy[0]).max() < EXACT
        assert rows["S.s"].min() < -1.0
