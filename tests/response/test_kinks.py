"""Kinks of loads where nothing bends: magnitudes, signs and the larger of two of what is rounding
alone."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk

RESTING = (Path(__file__).parent / "kinks" / "resting_slide.yaml").read_text()
GIVEN = '"-0.1 N*s^2/m^2*C.s_dot*abs(C.s_dot)"'


def swing(text: str) -> Any:
    return mk.loads(text).respond("swing", tables=[])


SMOOTH = swing(RESTING.replace(GIVEN, "0"))


TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
LOADS = [
    "-0.1 N*s^2/m^2*C.s_dot*abs(C.s_dot)",
    "-10 N/m*min(0 m, C.s) - 10 N*sign(C.s)*abs(C.s_dot)*(1 s/m)",
    "-100 N*s^2/m^2*C.s_dot*abs(C.s_dot)",
    "-10 N*sign(C.s_dot)",
    "-10 N/m*max(0 m, C.s)",
]
"""Each takes seconds: the sign of what is rounding changes all the time."""


@pytest.mark.parametrize("load", LOADS if TIMES > 1 else LOADS[:2])
def test_a_coordinate_that_never_moves_has_no_kinks(load: str) -> None:
    assert GIVEN in RESTING
    rows = swing(RESTING.replace(GIVEN, f'"{load}"'))
    assert set(rows["row.status"]) == {"ok"}
    assert np.abs(rows["A.theta"] - SMOOTH["A.theta"]).max() < 1e-8


def test_the_same_kinks_of_what_moves_are_there() -> None:
    """The check above can fail: a load with a sign on a joint that moves changes the motion."""
    at_joint = "{type: torque, joint: A, value: "
    load = f'  - {at_joint}"-0.1 N*m*sign(A.theta_dot)"}}\nresponses:'
    rows = swing(RESTING.replace("responses:", load))
    assert np.abs(rows["A.theta"] - SMOOTH["A.theta"]).max() > 1e-3


def test_a_jump_by_the_sign_of_rounding_says_so() -> None:
    """The slide does not move, but the crank would: the load has no one value."""
    at_joint = "{type: torque, joint: A, value: "
    load = f'  - {at_joint}"0.5 N*m*sign(C.s/1 m)"}}\nresponses:'
    rows = swing(RESTING.replace("responses:", load))
    assert set(rows["row.status"]) == {"ok", "friction-undecided"}
    (error,) = (d for d in rows.diagnostics if d.severity == "error")
    assert error.code == "held-at-jump"
    assert '"0.5 N*m*sign(C.s/1 m)" jumps with the sign of what is zero' in error.message
