"""A few of the random kinks within kinks; more: `python -P tests/random_families/nested_kinks
--seeds 0:1000`."""

from __future__ import annotations

import os

import pytest
from random_families.nested_kinks.case import run_one

COUNT = 6 * int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(COUNT))
def test_kinks_within_kinks_are_those_of_tiny_steps(seed: int) -> None:
    found = run_one(seed)
    assert not found.fault, f"{found.fault}\n{found.text}"
