"""Some of the random stops and loads that jump; more:
`python -P tests/random_families/jumping_values --seeds 0:4000`."""

from __future__ import annotations

import os

import pytest
from random_families.jumping_values.case import run_load, run_stop

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


@pytest.mark.parametrize("seed", range(60 * TIMES))
def test_stops_are_where_their_value_passes(seed: int) -> None:
    found = run_stop(seed)
    assert not found.fault, f"{found.fault}\n{found.text}"


@pytest.mark.parametrize("seed", range(12 * TIMES))
def test_loads_that_jump_within_jumps(seed: int) -> None:
    found = run_load(seed)
    assert not found.fault, f"{found.fault}\n{found.text}"


def test_a_floor_of_a_floor_that_comes_to_zero() -> None:
    """What rests at its zero leaves it with the kink that moves it."""
    found = run_stop(587)
    assert not found.fault, f"{found.fault}\n{found.text}"
