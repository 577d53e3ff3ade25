"""Inputs that come to a dead centre and turn back: the rows behind it retrace the branch, against
closed forms."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

import mechkin_cli as mk

SLIDER_CRANK = """format: 1
plane: xy
units: {{length: m, angle: deg}}
links: {{crank: {{}}, rod: {{}}, slider: {{}}}}
joints:
  O: {{type: R, links: [ground, crank], point: [0, 0]}}
  A: {{type: R, links: [crank, rod], point: [{ax!r}, {ay!r}]}}
  B: {{type: R, links: [rod, slider], point: [{x!r}, 0]}}
  S: {{type: P, links: [ground, slider], point: [{x!r}, 0], axis: [1, 0]}}
motion: {{inputs: {{S.s: {{values: {values}}}}}}}
"""
FOUR_BAR = """format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [crank, coupler], point: [{bx!r}, {by!r}]}}
  C: {{type: R, links: [coupler, rocker], point: [{cx!r}, {cy!r}]}}
  D: {{type: R, links: [ground, rocker], point: [{d!r}, 0]}}
motion: {{inputs: {{A.theta: {{values: {values}}}}}}}
"""


def there_and_back(rng: random.Random, first: float, end: float) -> list[float]:
    """Inputs from `first` to `end` and back, once or twice, by other steps each time."""
    values = [first]
    for _ in range(rng.choice([1, 1, 2])):
        for way in (1, -1):
            parts = sorted(rng.uniform(0.05, 0.95) for _ in range(rng.randint(0, 4)))
            span = [first + part * (end - first) for part in parts]
            values += [*span, end] if way > 0 else [*reversed(span), first]
    return values


@pytest.mark.parametrize("seed", range(40))
def test_a_slider_comes_to_the_end_of_its_stroke_and_back(seed: int) -> None:
    rng = random.Random(seed)
    crank, rod = float(rng.randint(1, 40)) / 8, float(rng.randint(41, 99)) / 8
    angle = rng.uniform(0.3, 2.8)
    x = crank * math.cos(angle) + math.sqrt(rod**2 - (crank * math.sin(angle)) ** 2)
    end = rng.choice([rod + crank, rod - crank]) - x
    values = there_and_back(rng, 0.0, end)
    place = [crank * math.cos(angle), crank * math.sin(angle)]
    text = SLIDER_CRANK.format(ax=place[0], ay=place[1], x=x, values=values)
    analysis = mk.loads(text).analyze(["O.theta"])
    for value, theta, status in zip(
        values, analysis["O.theta"], analysis["row.status"], strict=True
    ):
        s = x + value
        cosine = (crank**2 + s**2 - rod**2) / (2 * crank * s)
        if value == end:
            # rounding may put the end of the stroke an ulp beyond it
            assert status in ("dead-centre", "beyond-dead-centre")
            continue
        assert status == "ok"
        assert abs(theta - math.degrees(math.acos(cosine) - angle)) < 1e-6
    assert "dead-centre-touched" in [one.code for one in analysis.diagnostics]


@pytest.mark.parametrize("seed", range(40))
def test_a_crank_comes_to_its_dead_centre_and_back(seed: int) -> None:
    rng = random.Random(1000 + seed)
    a, b, c, d = 2.0, rng.uniform(1.2, 1.8), rng.uniform(1.2, 1.8), rng.uniform(2.2, 3.0)
    # where coupler and rocker are stretched
    end = math.acos((a * a + d * d - (b + c) ** 2) / (2 * a * d))
    first = end - rng.uniform(0.2, 0.9) * min(end, 1.5)

    def rocker(theta: float) -> float:
        span = math.sqrt(a * a + d * d - 2 * a * d * math.cos(theta))
        inner = math.acos((span**2 + c * c - b * b) / (2 * span * c))
        return math.atan2(a * math.sin(theta), a * math.cos(theta) - d) - inner

    at = rocker(first)
    values = there_and_back(rng, 0.0, end - first)
    text = FOUR_BAR.format(
        bx=a * math.cos(first),
        by=a * math.sin(first),
        cx=d + c * math.cos(at),
        cy=c * math.sin(at),
        d=d,
        values=values,
    )
    analysis = mk.loads(text).analyze(["D.theta"])
    for value, theta, status in zip(
        values, analysis["D.theta"], analysis["row.status"], strict=True
    ):
        if value == values[0] + (end - first):
            assert status in ("dead-centre", "beyond-dead-centre")
            continue
        assert status == "ok"
        turned = np.remainder(theta - (rocker(first + value) - at) + math.pi, 2 * math.pi) - math.pi
        assert abs(turned) < 1e-7


@pytest.mark.parametrize("seed", range(20))
def test_a_parallelogram_that_turns_back_in_line_stays_one_and_says_branch_point(seed: int) -> None:
    rng = random.Random(2000 + seed)
    first = rng.uniform(0.3, 2.8)
    a, d = rng.uniform(0.5, 2.0), rng.uniform(2.2, 4.0)
    end = rng.choice([0.0, math.pi]) - first
    values = there_and_back(rng, 0.0, end)
    x, y = a * math.cos(first), a * math.sin(first)
    text = FOUR_BAR.format(bx=x, by=y, cx=d + x, cy=y, d=d, values=values)
    text += "assembly: {at_branch_points: straight}\n"
    analysis = mk.loads(text).analyze(["D.theta"])
    assert abs(analysis["D.theta"] - np.array(values)).max() < 1e-9
    codes = {one.code for one in analysis.diagnostics}
    assert "branch-point-touched" in codes
    assert "dead-centre-touched" not in codes
    # the last row may turn back no more, and is not passed either
    turns = [row for row in range(1, len(values) - 1) if values[row] == end]
    (note,) = (one for one in analysis.diagnostics if one.code == "branch-point-touched")
    assert len(note.numbers) == len(turns)
