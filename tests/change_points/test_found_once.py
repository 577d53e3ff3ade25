"""Mechanisms on which rows were lost once or a dead centre not named (`found/`): closed forms."""

from __future__ import annotations

from math import acos, cos, degrees, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk

FOUND = Path(__file__).parent / "found"


def run(name: str) -> mk.Analysis:
    return mk.load(FOUND / f"{name}.yaml").analyze()


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("start-beside-drawing", 91.2789297011),
        ("fold-not-named-across-a-turn", 91.2789297011),
        ("fold-not-named-scr", 343.0918305903),
        ("fold-not-named-chain", 303.286525421),
        ("fold-not-named-rsr", 320.55761841597),
    ],
)
def test_plain_dead_centres(name: str, place: float) -> None:
    """Places where the two links about the far pin are in line, |p - q| = |l1 -+ l2|."""
    result = run(name)
    (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
    assert abs(note.numbers[0].value - place) < 1e-8
    before = result["A0.theta"] < place
    assert set(result["row.status"][before].tolist()) == {"ok"}
    assert set(result["row.status"][~before].tolist()) == {"beyond-dead-centre"}


@pytest.mark.parametrize(
    "name",
    [
        "straight-row-on-branch-point-leg",
        "straight-row-on-branch-point-sc",
        "straight-row-on-branch-point-cs",
        "straight-not-passed-345",
        "straight-not-passed-rsr",
    ],
)
def test_parallelograms_pass_their_branch_points(name: str) -> None:
    """Their rockers turn as their cranks do; a row on a branch point may have a position alone."""
    result = run(name)
    crank = "A.theta" if "A.theta" in result.model.quantities else "A0.theta"
    rocker = crank.replace("A", "D")
    assert np.abs(result[rocker] - result[crank]).max() < 1e-6
    assert set(result["row.status"].tolist()) <= {"ok", "rank-unclear"}
    assert "branch-point-passed" in {d.code for d in result.diagnostics}


@pytest.mark.parametrize(("near", "side"), [("A.theta: 20", 1.0), ("A.theta: -20", -1.0)])
def test_a_start_on_a_fold_is_judged_at_the_second_row(near: str, side: float) -> None:
    """A slider-crank of 40 and 100 drawn outstretched; the slider moves inwards."""
    text = (FOUND / "start-on-fold.yaml").read_text(encoding="utf-8")
    result = mk.loads(text.replace("A.theta: 1", near)).analyze()
    for s, angle in zip((-1.0, -5.0, -9.0), result["A.theta"][1:], strict=True):
        x = 140.0 + s
        want = degrees(acos((x * x + 40.0**2 - 100.0**2) / (2.0 * 40.0 * x)))
        assert abs(angle - side * want) < 1e-6


def test_a_crank_turns_a_lead_screw_with_a_spring() -> None:
    """Three hundred turns and more of the screw between two rows."""
    result = run("crank-lead-screw")
    assert set(result["row.status"].tolist()) == {"ok"}
    square = 300.0**2 + 50.0**2 + 20.0**2
    for crank, slide, screw in zip(
        result["A.theta"], result["D.s"], result["E.theta"], strict=True
    ):
        a = radians(crank)
        bx, by = 60.0 * cos(a) - 80.0 * sin(a), 60.0 * sin(a) + 80.0 * cos(a)
        want = bx - 360.0 + sqrt(square - (30.0 - by) ** 2 - 20.0**2)
        assert abs(slide - want) < 1e-9
        assert abs(screw + 360.0 * want) < 1e-6


def test_no_turn_is_lost() -> None:
    assert set(run("lost-after-eleven-turns")["row.status"].tolist()) == {"ok"}


@pytest.mark.parametrize("order", [1, -1])
def test_a_drawing_serves_the_rows_on_its_other_side(order: int) -> None:
    """Crank 3, rod sqrt 10, rocker sqrt 13 and ground 6: the rocker swings to where crank and rod
    are in line, and the row nearest to the drawing lies beyond that."""
    text = (FOUND / "start-beside-drawing.yaml").read_text(encoding="utf-8")
    head, _, _ = text.partition("motion:")
    rows = [-25, 40, 100][::order]
    result = mk.loads(head + f"motion: {{inputs: {{D.theta: {{values: {rows}}}}}}}").analyze()
    drawn = degrees(acos(2 / sqrt(13)))
    fold = drawn - degrees(acos((49 - (3 + sqrt(10)) ** 2) / (12 * sqrt(13))))
    assert result["row.status"].tolist() == ["beyond-dead-centre", "ok", "ok"][::order]
    (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
    assert abs(note.numbers[0].value - fold) < 1e-8
