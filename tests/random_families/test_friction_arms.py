"""Random arms that stick and slide; `MECHKIN_RANDOM` multiplies their number."""

from __future__ import annotations

import os

import pytest
from random_families.friction_arms import compare

COUNT = 2 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", [4, 12, *range(100, 100 + COUNT - 2)])
def test_a_random_arm_against_an_integration_from_event_to_event(seed: int) -> None:
    found = compare(seed)
    # swinging arms part: what a nudge of 1e-10 makes of it is told apart from an error
    assert found.error <= 1e-9 + 30.0 * found.nudged
    assert found.energy <= 1e-10
