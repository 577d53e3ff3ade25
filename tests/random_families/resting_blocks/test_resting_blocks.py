"""A few of the random blocks; more: `python -P tests/random_families/resting_blocks --seeds
0:60`."""

from __future__ import annotations

import os

import pytest
from random_families.resting_blocks.case import run_one

COUNT = 6 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(COUNT))
def test_blocks_rest_and_slip_as_scipy_says(seed: int) -> None:
    found = run_one(seed)
    assert not found.fault, f"{found.fault}\n{found.text}"
