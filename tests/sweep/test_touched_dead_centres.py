"""Inputs that come to a dead centre and turn back: the rows behind it retrace the branch, against
closed forms."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest
from sweep.turning_back import FOUR_BAR, SLIDER_CRANK

import mechkin_cli as mk


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


LAWS = {
    "polynomial": "{{law: polynomial, coefficients: [0, '4*({end!r} m)/(1 s)', "
    "'-4*({end!r} m)/(1 s^2)']}}",
    "sine": "{{with: '{end!r} m*sin(180 deg*time/(1 s))', drive: own}}",
    "square": "{{with: '{end!r} m*sin(180 deg*time/(1 s))^2', drive: own}}",
}
"""Each comes to its end in the middle of every second, and goes back."""


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("seed", range(8))
def test_a_law_comes_to_a_dead_centre_between_rows_or_at_one(seed: int, law: str) -> None:
    rng = random.Random(3000 + seed)
    crank, rod = float(rng.randint(1, 40)) / 8, float(rng.randint(41, 99)) / 8
    angle = rng.uniform(0.3, 2.8)
    x = crank * math.cos(angle) + math.sqrt(rod**2 - (crank * math.sin(angle)) ** 2)
    end = rng.choice([rod + crank, rod - crank]) - x
    text = SLIDER_CRANK.format(
        ax=crank * math.cos(angle), ay=crank * math.sin(angle), x=x, values="[0]"
    )
    seconds = 2 if law == "square" else 1
    count = rng.randint(5, 12)
    motion = f"{{time: {{from: 0, to: {seconds}, count: {count}}}, inputs: {{S.s: "
    text = text[: text.index("motion:")] + f"motion: {motion}{LAWS[law].format(end=end)}}}}}\n"
    analysis = mk.loads(text).analyze(["O.theta"])
    turned_back = 0
    for value, theta, status in zip(
        analysis["S.s"], analysis["O.theta"], analysis["row.status"], strict=True
    ):
        if abs(value - end) < 1e-12:
            assert status in ("dead-centre", "beyond-dead-centre")
            continue
        assert status == "ok"
        s = x + value
        cosine = (crank**2 + s**2 - rod**2) / (2 * crank * s)
        assert abs(theta - math.degrees(math.acos(cosine) - angle)) < 1e-6
        turned_back += 1
    assert turned_back >= count - 2 * seconds
    assert "dead-centre-touched" in [one.code for one in analysis.diagnostics]


@pytest.mark.parametrize("beyond", [1e-6, 1e-3])
def test_a_law_that_goes_beyond_a_dead_centre_between_rows_is_lost(beyond: float) -> None:
    text = SLIDER_CRANK.format(ax=0.6, ay=0.8, x=0.6 + math.sqrt(8.36), values="[0]")
    end = 4 - 0.6 - math.sqrt(8.36) + beyond
    motion = f"{{time: {{from: 0, to: 1, count: 6}}, inputs: {{S.s: {LAWS['sine'].format(end=end)}"
    analysis = mk.loads(text[: text.index("motion:")] + f"motion: {motion}}}}}\n").analyze()
    assert analysis["row.status"].tolist() == ["ok"] * 3 + ["beyond-dead-centre"] * 3


FIVE_BAR = """format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{one: {{}}, rod: {{}}, other: {{}}, two: {{}}}}
joints:
  A: {{type: R, links: [ground, one], point: [0, 0]}}
  E: {{type: R, links: [ground, two], point: [{d!r}, 0]}}
  B: {{type: R, links: [one, rod], point: [0, {r!r}]}}
  D: {{type: R, links: [two, other], point: [{d!r}, {r!r}]}}
  C: {{type: R, links: [rod, other], point: [{x!r}, {y!r}]}}
points: {{c: {{link: rod, at: [{x!r}, {y!r}]}}}}
motion: {{inputs: {{A.theta: {{values: {first}}}, E.theta: {{values: {second}}}}}}}
"""


@pytest.mark.parametrize("seed", range(20))
def test_two_cranks_come_to_a_dead_centre_and_turn_anywhere(seed: int) -> None:
    """Where both rods lie in line the tips are as far apart as these are long."""
    rng = random.Random(4000 + seed)
    d, r, rod = 1.0, rng.uniform(0.3, 0.5), rng.uniform(0.55, 0.62)
    lean = math.asin((2 * rod - d) / (2 * r))
    first, second = [0.0], [0.0]
    for _ in range(2):
        first += [lean, rng.uniform(-0.1, 0.8) * lean]
        second += [-lean, -rng.uniform(-0.1, 0.8) * lean]
    text = FIVE_BAR.format(
        d=d, r=r, x=d / 2, y=r + math.sqrt(rod * rod - d * d / 4), first=first, second=second
    )
    analysis = mk.loads(text).analyze(["c.position"])
    for row, (u, v) in enumerate(zip(first, second, strict=True)):
        status = analysis["row.status"][row]
        if u == lean:
            assert status in ("dead-centre", "beyond-dead-centre")
            continue
        assert status == "ok"
        b = np.array([-r * math.sin(u), r * math.cos(u)])
        e = np.array([d - r * math.sin(v), r * math.cos(v)])
        way = e - b
        half = math.hypot(*way) / 2
        up = np.array([-way[1], way[0]]) / (2 * half)
        known = (b + e) / 2 + math.sqrt(rod * rod - half * half) * up
        found = np.array([analysis[f"c.position.{axis}"][row] for axis in "xy"])
        assert np.abs(found - known).max() < 1e-9
