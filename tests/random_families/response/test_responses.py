"""A few of the random responses; more: `python -P tests/random_families/response --seeds 0:100`."""

from __future__ import annotations

import os

import pytest
from random_families.response.case import run_one

COUNT = 3 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(COUNT))
def test_a_random_mechanism_moves_as_newton_and_euler_say(seed: int) -> None:
    outcome = run_one(seed)
    assert not outcome.fault, f"{outcome.fault}\n{outcome.text}"
