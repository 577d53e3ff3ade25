"""Motions through folded places, and by those that miss one by little; `MECHKIN_RANDOM` multiplies
the number of both."""

from __future__ import annotations

import os

import pytest
from random_families.change_points.judge import judged, miss
from random_families.change_points.near import near_case
from random_families.change_points.neutral import case

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
PARTS = (1e-3, -1e-5, 1e-7, -1e-9, 1e-11)


@pytest.mark.parametrize("number", range(12 * TIMES))
def test_folds_are_passed_along_the_smooth_curve(number: int) -> None:
    off, words = miss(number)
    assert off < 1e-8, words


@pytest.mark.parametrize("number", range(len(PARTS) * TIMES))
def test_by_a_gap_the_motion_turns_off(number: int) -> None:
    off, words = judged(number, near_case(number, PARTS[number % len(PARTS)]))
    assert off < 1e-5, words


def test_the_judge_sees_a_wrong_branch() -> None:
    """Told to turn off where it folds, and to fold where it turns off."""
    folded, near = near_case(3, 0.0), near_case(3, 1e-3)
    assert judged(3, near)[0] < 1e-5
    assert abs(folded.theta[-1] - near.theta[-1]) + abs(folded.phi[-1] - near.phi[-1]) > 0.1
    off, words = miss(3)
    assert case(3).crossings > 0
    assert off < 1e-8, words
