"""Mechanisms with couplings against a dense system: `python -m random_families.coupled 0:100` takes
more."""

from __future__ import annotations

import os

import pytest
from random_families.coupled import judge

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

SLIDES = (8, 14, 94)
"""Where the slide of a rack would be the cheapest joint to cut a loop at."""
RINGS = (27, 38, 45)
"""Rings, whose sense is a truth value of what the file tells."""


@pytest.mark.parametrize("seed", [*range(4 * TIMES), *SLIDES, *RINGS])
def test_motion_and_forces_are_those_of_a_dense_system(seed: int) -> None:
    swept, moved = judge(seed)
    assert swept.word in ("ok", "beyond"), swept
    assert moved.word == "ok", moved
