"""A few of the random responses with kinks; more: `python -P tests/random_families/kinks --seeds
0:200`."""

from __future__ import annotations

import os

import pytest
from random_families.kinks.case import run_one

COUNT = 3 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(1, 1 + COUNT))
def test_kinks_change_no_motion_of_newton_and_euler(seed: int) -> None:
    outcome = run_one(seed)
    assert not outcome.fault, f"{outcome.fault}\n{outcome.text}"
