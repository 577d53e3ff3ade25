"""Rows that come back from next to a dead centre, against the closed form of a four-bar.

Crank r, coupler and rocker of one length l, ground d: the rocker stands at beta - acos(e / 2l),
where e and beta are the distance and the direction from its pivot to the crank's end.
"""

from __future__ import annotations

from math import acos, atan2, cos, degrees, hypot, radians, sin, sqrt

import pytest

import mechkin_cli as mk

TEXT = """\
format: 1
name: four-bar
units: {{length: m, angle: deg}}
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, coupler], point: [2, 0, 0]}}
  C: {{type: S, links: [coupler, rocker], point: {{coupler: [3.5, 0, 0], rocker: [5.5, 0, 0]}}}}
  D: {{type: R, links: [ground, rocker], point: [4, 0, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{values: {values}}}}}}}
assembly: {{near: {{D.theta: 122}}}}
"""

FOLD = degrees(acos(11 / 16))
"""The crank at the dead centre, where e = 2l = 3, in degrees."""


def rocker(crank: float) -> float:
    """Angle of the rocker in degrees, on the branch that has 121.9 degrees at 30."""
    x, y = 2 * cos(radians(crank)) - 4, 2 * sin(radians(crank))
    return (degrees(atan2(y, x) - acos(hypot(x, y) / 3)) + 360) % 360


@pytest.mark.parametrize(
    "values",
    [
        [30, FOLD - 1e-9, 10],
        [30, FOLD - 1e-10, FOLD - 2e-10, FOLD - 1e-10, FOLD - 1e-10, 10, 46],
        [30, 1e-10 - FOLD, 0, FOLD - 1e-9, 30, 46, -46, 1e-9 - FOLD, -20],
        [FOLD - 1e-9, 30, FOLD - 1e-9, 30],
    ],
)
def test_rows_come_back_on_their_own_branch(values: list[float]) -> None:
    analysis = mk.loads(TEXT.format(values=values)).analyze(["D.theta"])
    for crank, angle in zip(values, analysis["D.theta"], strict=True):
        # the branch is e ~ sqrt(distance) there: a rounding of the crank moves the rocker by this
        doubt = 1e-11 + 1e-12 / sqrt(FOLD - abs(crank))
        assert abs((angle - rocker(crank) + 180) % 360 - 180) <= doubt
    assert "dead-centre" not in {d.code for d in analysis.diagnostics}


def test_rows_after_one_beyond_stay_empty_and_the_message_says_why() -> None:
    analysis = mk.loads(TEXT.format(values=[30, FOLD - 1e-9, 47, 10])).analyze(["D.theta"])
    assert analysis["row.status"].tolist() == ["ok"] * 2 + ["beyond-dead-centre"] * 2
    (note,) = analysis.diagnostics
    assert "rows 3 to 4 lie beyond it on the way of the rows and stay empty" in note.message


def test_one_missing_row_is_told_in_the_singular() -> None:
    (note,) = mk.loads(TEXT.format(values=[30, 47])).analyze(["D.theta"]).diagnostics
    assert "row 2 lies beyond it and stays empty" in note.message


def test_inputs_that_move_together_come_to_a_dead_centre() -> None:
    """Crank and ground's length change at once: e = 2l at another place of both."""
    text = TEXT.format(values=[30, 40, 50]).replace(
        "D: {type: R, links: [ground, rocker]", "D: {type: R, links: [slide, rocker]"
    )
    text = text.replace("rocker: {}}", "rocker: {}, slide: {}}", 1).replace(
        "motion:",
        "  P: {type: P, links: [ground, slide], point: [4, 0, 0], axis: [1, 0, 0]}\nmotion:",
    )
    text = text.replace("50]}}}", "50]}, P.s: {values: [0, 0.1, 0.2]}}}")
    analysis = mk.loads(text).analyze(["D.theta"])
    assert analysis["row.status"].tolist() == ["ok", "ok", "beyond-dead-centre"]

    def excess(part: float) -> float:
        """e - 2l on the chord between the last two rows."""
        crank, ground = radians(40 + 10 * part), 4.1 + 0.1 * part
        return hypot(2 * cos(crank) - ground, 2 * sin(crank)) - 3

    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    (note,) = analysis.diagnostics
    assert [number.name for number in note.numbers] == ["A.theta", "P.s"]
    assert abs(note.numbers[0].value - (40 + 10 * low)) < 1e-9
    assert abs(note.numbers[1].value - (0.1 + 0.1 * low)) < 1e-10
