"""Long sweeps are solved in parts: what they give does not depend on how they are cut.

Parts are made small here, so that dead centres, branch points, lost rows and turning inputs lie at
their borders; references are runs in one part, and closed forms.
"""

from __future__ import annotations

import math
import os
import random
from pathlib import Path

import numpy as np
import pytest
from references import FILE_OF, SWEPT
from sweep.cut import cut
from sweep.turning_back import FOUR_BAR, SLIDER_CRANK

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


def cells(analysis: mk.Analysis) -> dict[str, np.ndarray]:
    """All numbers of the tables, by table and label."""
    return {
        f"{table.name}, {column.label}": column.numbers
        for table in analysis.tables
        for column in table.columns
        if isinstance(column.values, np.ndarray) and not column.label.startswith("row.")
    }


def said(analysis: mk.Analysis) -> list[str]:
    return sorted(map(str, analysis.diagnostics))


@pytest.mark.parametrize("rows", [2, 7, 31])
@pytest.mark.parametrize("path", SWEPT, ids=lambda path: path.stem)
def test_kept_mechanisms_do_not_depend_on_their_parts(
    path: Path, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = mk.load(path).analyze()
    expected = cells(whole)
    cut(monkeypatch, rows)
    found = mk.load(path).analyze()
    assert list(found["row.status"]) == list(whole["row.status"])
    assert found.result.letter == whole.result.letter
    assert said(found) == said(whole)
    for name, values in cells(found).items():
        own = expected[name]
        size = np.abs(own[np.isfinite(own)]).max(initial=0.0)
        assert np.array_equal(np.isnan(values), np.isnan(own)), name
        assert np.array_equal(np.isinf(values), np.isinf(own)), name
        there = np.isfinite(own)
        # what is zero but for rounding is so in either
        off = np.abs(values[there] - own[there]).max(initial=0.0)
        assert off <= 1e-9 * max(size, 1e-3), name


DRIVEN = FOUR_BAR.replace("A.theta: {{values: {values}}}", "{motion}")
assert DRIVEN != FOUR_BAR


@pytest.mark.parametrize("seed", range(60 * TIMES))
def test_a_slider_that_turns_back_at_its_dead_centre_on_a_border(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """x^2 + r^2 - 2 r x cos(theta) = l^2 at every row; past the end of the stroke the rows retrace
    the branch, however close the border of a part is to it."""
    rng = random.Random(seed)
    crank, rod = float(rng.randint(1, 40)) / 8, float(rng.randint(41, 99)) / 8
    angle = rng.uniform(0.3, 2.8)
    x = crank * math.cos(angle) + math.sqrt(rod**2 - (crank * math.sin(angle)) ** 2)
    side = rng.choice([1, -1])
    # as far beyond the end as rounding puts it
    end = rod + side * crank - x + side * rng.choice([0.0, 0.0, 1e-13])
    values = [0.0]
    for _ in range(rng.randint(1, 4)):
        way = sorted(rng.random() ** rng.choice([1, 4]) for _ in range(rng.randint(0, 5)))
        values += [*(part * end for part in way), end]
        values += [part * end for part in reversed(way)]
    cut(monkeypatch, rng.randint(2, 6))
    place = {"ax": crank * math.cos(angle), "ay": crank * math.sin(angle), "x": x}
    run = mk.loads(SLIDER_CRANK.format(values=values, **place).replace("deg", "rad")).analyze(
        ["O.theta"]
    )
    assert len(run["S.s"]) == len(values)
    for slide, theta, status in zip(values, run["O.theta"], run["row.status"], strict=True):
        if status == "beyond-dead-centre":
            assert slide == end  # by rounding
            continue
        assert status in {"ok", "near-singular", "rank-unclear", "dead-centre"}
        at = (x + slide) ** 2 + crank**2 - rod**2
        cosine = max(-1.0, min(1.0, at / (2.0 * crank * (x + slide))))
        assert abs(math.cos(theta + angle) - cosine) < 1e-12
        assert 0.0 <= theta + angle + 1e-7 <= math.pi + 2e-7


@pytest.mark.parametrize("seed", range(20 * TIMES))
def test_a_parallelogram_goes_straight_through_its_branch_points_on_borders(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = random.Random(seed)
    a, d, first = rng.uniform(0.5, 2.0), rng.uniform(2.2, 4.0), rng.uniform(0.3, 2.8)
    x, y = a * math.cos(first), a * math.sin(first)
    start, turns = rng.uniform(-9.0, 3.0), rng.uniform(1.0, 4.0)
    count = rng.randint(20, 90)
    motion = f"A.theta: {{from: {start!r}, to: {start + 2.0 * math.pi * turns!r}, count: {count}}}"
    text = DRIVEN.format(bx=x, by=y, cx=d + x, cy=y, d=d, motion=motion)
    text += "assembly: {at_branch_points: straight}\n"
    cut(monkeypatch, rng.randint(2, 9))
    run = mk.loads(text).analyze(["D.theta", "C.theta"])
    # angles count from the first row, where they lie within half a turn
    driven = run["A.theta"]
    expected = driven - 2.0 * math.pi * np.ceil((driven[0] - math.pi) / (2.0 * math.pi))
    assert np.abs(run["D.theta"] - expected).max() < 1e-9
    (note,) = [one for one in run.diagnostics if one.code == "branch-point-passed"][:1]
    assert note.severity == "note"


@pytest.mark.parametrize("rows", [2, 5, 8])
@pytest.mark.parametrize("way", [1, -1])
def test_a_branch_that_ends_is_told_once_with_all_rows_behind_it(
    rows: int, way: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, last = sorted((-0.5, way * 2.5)) if way < 0 else (-0.5, 2.5)
    motion = f"A.theta: {{from: {first}, to: {last}, count: 61}}"
    text = DRIVEN.format(bx=0.0, by=2.0, cx=2.0, cy=1.0, d=2.0, motion=motion)
    whole = mk.loads(text).analyze()
    cut(monkeypatch, rows)
    found = mk.loads(text).analyze()
    assert "beyond-dead-centre" in set(whole["row.status"])
    assert list(found["row.status"]) == list(whole["row.status"])
    ends = [str(one) for one in found.diagnostics if one.code == "dead-centre"]
    assert ends == [str(one) for one in whole.diagnostics if one.code == "dead-centre"]


@pytest.mark.parametrize("rows", [3, 10])
def test_whole_turns_are_counted_from_the_first_row(
    rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Rows before the drawing are followed back first; turns count from row 1 nevertheless."""
    text = FILE_OF["rssr"].read_text(encoding="utf-8")
    before = "O1.theta: {from: 0, to: 360, step: 10"
    assert before in text
    text = text.replace(before, "O1.theta: {from: -800, to: 1000, step: 25")
    names = [name for name in mk.loads(text).problem.mechanism.coordinates if "theta" in name]
    whole = mk.loads(text).analyze(names)
    cut(monkeypatch, rows)
    found = mk.loads(text).analyze(names)
    for name in names:
        assert np.abs(found[name] - whole[name]).max() < 1e-9
