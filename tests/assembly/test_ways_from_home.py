"""Which rows an assembled drawing is followed to, decided by the folds of planar four-bars."""

from __future__ import annotations

from math import acos, cos, degrees, hypot, radians, sin

import numpy as np
import pytest

import mechkin_cli as mk

GROUND, CRANK, ROD, ROCKER = 4.0, 3.0, 2.0, 2.5
SPAN = degrees(acos((GROUND**2 + CRANK**2 - (ROD + ROCKER) ** 2) / (2.0 * GROUND * CRANK)))
"""The crank swings so far to both sides of the ground link."""


def places(crank: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """The pins of the rod where its rocker's pin lies above the line of the others."""
    x, y = CRANK * cos(radians(crank)), CRANK * sin(radians(crank))
    dx, dy = GROUND - x, -y
    d = hypot(dx, dy)
    along = (ROD**2 - ROCKER**2 + d * d) / (2.0 * d)
    across = (ROD**2 - along**2) ** 0.5
    return (x, y), (x + (along * dx - across * dy) / d, y + (along * dy + across * dx) / d)


def four_bar(crank: float, inputs: str, links: str = "", joints: str = "") -> mk.Analysis:
    """Drawn with its crank at an angle, so that it swings from -SPAN - crank to SPAN - crank."""
    (ax, ay), (bx, by) = places(crank)
    return mk.loads(f"""
format: 1
name: four-bar
links: {{crank: {{}}, rod: {{}}, rocker: {{}}{links}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, rod], point: [{ax!r}, {ay!r}, 0], axis: [0, 0, 1]}}
  C: {{type: S, links: [rod, rocker], point: [{bx!r}, {by!r}, 0]}}
  D: {{type: R, links: [ground, rocker], point: [{GROUND}, 0, 0], axis: [0, 0, 1]}}
{joints}
motion:
  inputs:
    A.theta: {inputs}
""").analyze(["A.theta", "D.theta"])


def rocker(crank: float) -> float:
    (_, _), (x, y) = places(crank)
    return degrees(np.arctan2(y, x - GROUND))


@pytest.mark.parametrize("drawn", [70.0, -70.0])
@pytest.mark.parametrize("first", [-100.0, -95.0])
@pytest.mark.parametrize("back", [False, True])
def test_the_nearest_row_lies_beyond_a_fold(drawn: float, first: float, back: bool) -> None:
    """Rows on the drawing's other side are reached all the same, and no others."""
    sign = 1.0 if drawn > 0.0 else -1.0
    ends = (sign * first, sign * (first + 360.0))
    a, b = ends[::-1] if back else ends
    result = four_bar(drawn, f"{{from: {a}, to: {b}, count: 7}}")
    crank = result["A.theta"]
    reached = np.abs(crank + drawn) < SPAN
    assert reached.sum() == 2
    assert set(result["row.status"][reached].tolist()) == {"ok"}
    assert set(result["row.status"][~reached].tolist()) == {"beyond-dead-centre"}
    for angle, found in zip(crank[reached], result["D.theta"][reached], strict=True):
        off = found - (rocker(drawn + angle) - rocker(drawn))
        assert abs((off + 180.0) % 360.0 - 180.0) < 1e-9


@pytest.mark.parametrize("turns", [1, 3, -1, -2])
@pytest.mark.parametrize(("first", "last"), [(37.0, 437.0), (-20.0, 300.0), (150.0, 390.0)])
def test_whole_turns_away_from_rows_of_the_drawing(first: float, last: float, turns: int) -> None:
    """A sweep some turns on has the rows of the same sweep in the drawing's own turn."""

    def run(turns: int) -> mk.Analysis:
        ends = first + 360.0 * turns, last + 360.0 * turns
        return four_bar(-20.0, f"{{from: {ends[0]}, to: {ends[1]}, count: 21}}")

    own, away = run(0), run(turns)
    assert {"ok", "beyond-dead-centre"} == set(own["row.status"].tolist())
    # in the other sense of turns the nearest turn is that of the last rows
    if turns > 0:
        assert own["row.status"].tolist() == away["row.status"].tolist()
        assert np.nanmax(np.abs(own["D.theta"] - away["D.theta"])) < 1e-9
    reached = away["row.status"] == "ok"
    crank = (away["A.theta"][reached] + 180.0) % 360.0 - 180.0
    assert reached.any()
    assert (np.abs(crank - 20.0) < SPAN).all()


def test_what_follows_the_crank_says_nothing_of_the_turn() -> None:
    """A shaft at three times the crank's speed is beyond half a turn where the crank is not."""
    result = four_bar(
        -70.0,
        "{from: 80, to: 380, step: 15}\n    E.theta: {with: 3*A.theta}",
        ", wheel: {}, bar: {}, slide: {}",
        "  E: {type: R, links: [ground, wheel], point: [0, 9, 0], axis: [0, 0, 1]}\n"
        "  F: {type: S, links: [wheel, bar], point: [1, 9, 0]}\n"
        "  G: {type: S, links: [bar, slide], point: [6, 9, 0]}\n"
        "  H: {type: P, links: [ground, slide], point: [6, 9, 0], axis: [1, 0, 0]}",
    )
    reached = result["A.theta"] - 70.0 < SPAN
    assert 0 < reached.sum() < reached.size
    assert set(result["row.status"][reached].tolist()) == {"ok"}
    assert set(result["row.status"][~reached].tolist()) == {"beyond-dead-centre"}
