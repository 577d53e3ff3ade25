"""Random mechanisms with friction at every joint against dense free-body equations at 40 digits."""

from __future__ import annotations

import os

import pytest
from friction.rubbed import differences, with_friction
from oracle import to_text
from oracle.friction import NoFixedPoint
from properties.cases import case

import mechkin_cli as mk
from mechkin_cli.verdict import Status

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
NAMES = [f"loop {seed}" for seed in range(6 * TIMES)]
NAMES += [f"structure {seed}" for seed in (0, 1, 5, 6)[: 4 * TIMES]]
ROUNDING = 2.0**-52


@pytest.mark.parametrize("name", NAMES)
def test_random_mechanisms(name):
    data = with_friction(case(name).text, 7)
    try:
        found = differences(name, data)
    except NoFixedPoint:
        analysis = mk.loads(to_text(data)).analyze(["J1.force"], tables=[])
        assert analysis.result.status[case(name).row] == Status.friction_undecided
        return
    assert all(error <= 50 * ROUNDING * case(name).condition for error in found.values()), found
