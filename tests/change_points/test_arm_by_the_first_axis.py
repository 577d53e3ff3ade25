"""A six-joint arm whose wrist straightens where its centre passes the first axis by a micrometre:
four joints turn by half turns within a thousandth of a degree."""

from __future__ import annotations

import random

import numpy as np
import pytest
from random_families.no_wrong_row.arms import Near, arm
from random_families.no_wrong_row.branch import TURN, Undecided, way
from random_families.no_wrong_row.case import Case, text_of
from random_families.no_wrong_row.design import Impossible, random_unit
from random_families.no_wrong_row.drawing import Drawing
from random_families.no_wrong_row.loops import crank
from random_families.no_wrong_row.travel import monotone
from random_families.no_wrong_row.verdicts import judged

REACHED = 1e-3
"""A discriminant of the first joint below this on the way: its axis is met."""


def drawn(seed: int, gap: float, straight: float) -> Drawing:
    """An arm that meets both singular places on the way from 0 to 360 degrees, before any fold."""
    rng = random.Random(seed)
    while True:
        drawing = Drawing(rng)
        crank(drawing, "A", np.zeros(3), random_unit(rng))
        try:
            arm(drawing, rng, "B", gap, Near("by the axis", "straight", straight))
            one = way(drawing.linkage(), 1, TURN)
        except (Impossible, Undecided):
            continue
        if any(name == "B_1" and margin < REACHED for _, name, margin in one.critical):
            return drawing


@pytest.mark.parametrize("step", [0.7, 7.0, 45.0])
@pytest.mark.parametrize("straight", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("gap", [1e-6, 1e-3])
@pytest.mark.parametrize("seed", range(4))
def test_the_wrist_straightens_by_the_first_axis(
    seed: int, gap: float, straight: float, step: float
) -> None:
    drawing = drawn(seed, gap, straight)
    count = int(360 / step)
    text = f"{{from: 0, to: {step * (count - 1)!r}, step: {step!r}}}"
    travel = monotone(step * np.arange(count), text)
    verdict = judged(Case(0, drawing, text_of(drawing, travel), travel, [gap], {}))
    assert not verdict.faults
    assert verdict.counts["right"] > 0
