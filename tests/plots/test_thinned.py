"""Pictures of long runs: of fewer rows, with the same extremes, ends, gaps, marks and verdicts."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from sweep.cut import cut

import mechkin_cli as mk
from mechkin_cli.plots import Drawing, PlotCurve, thinned

MECHANISMS = Path(__file__).parents[2] / "mechanisms"
RCSR = MECHANISMS / "dissertation" / "rcsr.yaml"
FOUR_BAR = MECHANISMS / "plane" / "planar_four_bar.yaml"


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Stretches of a few rows, in parts of a few dozen."""
    cut(monkeypatch, 24)
    monkeypatch.setattr(thinned, "STRETCHES", 40)


def assert_thinned(whole, found) -> None:
    """As much as is seen: curves reach as far, begin and end alike, and their rows are rows."""
    assert found.title == whole.title
    assert set(found.marks) == set(whole.marks)
    assert found.is_plane == whole.is_plane
    assert [words for words, _ in found.doubtful] == [words for words, _ in whole.doubtful]
    assert found.parameter.words == whole.parameter.words
    rows = np.searchsorted(whole.parameter.values, found.parameter.values)
    assert (whole.parameter.values[rows] == found.parameter.values).all()
    assert rows.size < whole.parameter.values.size
    assert (whole.solved[rows] == found.solved).all()
    assert np.count_nonzero(np.diff(found.solved)) == np.count_nonzero(np.diff(whole.solved))
    for before, behind in zip(
        (*whole.x, *(c for panel in whole.panels for c in panel)),
        (*found.x, *(c for panel in found.panels for c in panel)),
        strict=True,
    ):
        assert before.words == behind.words
        assert np.array_equal(before.values[rows], behind.values, equal_nan=True)
        assert np.nanmax(before.values) == np.nanmax(behind.values)
        assert np.nanmin(before.values) == np.nanmin(behind.values)
        assert np.array_equal(before.values[[0, -1]], behind.values[[0, -1]], equal_nan=True)


def long_text(path: Path, before: str, behind: str) -> str:
    text = path.read_text(encoding="utf-8")
    assert before in text
    return text.replace(before, behind)


@pytest.mark.usefixtures("few")
@pytest.mark.parametrize(
    ("y", "x"),
    [
        (["O4.theta", "O4.theta_dot"], None),
        (["O4.theta"], "O4.theta_dot"),
        (["O4.force"], None),
        ([], None),
    ],
)
def test_of_a_sweep(y: list[str], x: str | None) -> None:
    text = long_text(RCSR, "from: 150, to: 202, step: 2", "from: 150, to: 202, count: 601")
    model = mk.loads(text, "rcsr")
    whole = model.analyze().picture(y, x)
    assert_thinned(whole, model.stream().picture(y, x))


@pytest.mark.usefixtures("few")
def test_with_rows_that_are_not_reached() -> None:
    """Beyond a dead centre, which is a mark."""
    text = long_text(RCSR, "from: 150, to: 202, step: 2", "from: 150, to: 230, count: 601")
    model = mk.loads(text, "rcsr")
    whole = model.analyze().picture(["O4.theta"])
    assert not whole.solved.all()
    assert_thinned(whole, model.stream().picture(["O4.theta"]))


@pytest.mark.usefixtures("few")
def test_of_a_response_that_is_stopped() -> None:
    """Its event is a mark, at the stop's own moment."""
    text = """format: 1
plane: xy
units: {length: m, angle: rad}
links: {bob: {mass: 1, center_of_mass: [0, -1]}}
joints: {O: {type: R, links: [ground, bob], point: [0, 0]}}
loads: [{type: gravity, g: [0, -9.80665]}]
responses:
  swing:
    start: {O.theta: 1}
    time: {from: 0, to: 3, count: 901}
    stop: [{value: O.theta, at: -0.5}]
"""
    model = mk.loads(text, "pendulum")
    whole = model.respond("swing").picture(["O.theta"])
    assert whole.marks
    assert_thinned(whole, model.stream(run="swing").picture(["O.theta"]))


def test_the_command_holds_no_rows(tmp_path: Path) -> None:
    """A picture of as many rows as cannot be held."""
    text = long_text(RCSR, "from: 150, to: 202, step: 2", "from: 150, to: 202, count: 1000000")
    path = tmp_path / "long.yaml"
    path.write_text(text, encoding="utf-8")
    words = ["plot", str(path), "--y", "O4.theta", "--quiet", "-o", str(tmp_path / "p.svg")]
    found = subprocess.run(
        [sys.executable, "-P", "-m", "mechkin_cli", *words], capture_output=True, check=False
    )
    assert found.returncode == 0, found.stderr
    assert (tmp_path / "p.svg").stat().st_size < 2_000_000


@pytest.mark.parametrize("seed", range(200))
def test_of_any_rows_cut_anywhere(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers by chance, with gaps, what is infinite and verdicts that come and go: what is shown
    begins, ends and reaches as far, and changes its verdict as often, however parts are cut."""
    draw = np.random.default_rng(seed)
    rows = int(draw.integers(2, 400))
    monkeypatch.setattr(thinned, "STRETCHES", int(draw.integers(1, 60)))
    values = draw.normal(size=(2, rows))
    values[draw.random((2, rows)) < 0.1] = np.nan
    values[draw.random((2, rows)) < 0.02] = np.inf
    status = (draw.random(rows) < 0.05).astype(np.int8)
    places = np.arange(float(rows))

    def some(begin: int, end: int) -> Drawing:
        along = PlotCurve("row", "", places[begin:end])
        curves = tuple(PlotCurve(f"c{k}", "mm", own[begin:end]) for k, own in enumerate(values))
        return Drawing("any", curves, None, along, (), status[begin:end], frozenset())

    cuts = np.unique(np.concatenate([[0], draw.integers(0, rows, draw.integers(0, 6)), [rows]]))
    # neighbouring parts share a row, which is of the first of them
    parts = [
        (some(max(begin - 1, 0), end), slice(min(begin, 1), None))
        for begin, end in pairwise(cuts.tolist())
    ]
    found = thinned.thinned_picture(parts, rows)
    shown = found.parameter.values.astype(int)
    assert (np.diff(shown) > 0).all()
    assert shown[0] == 0
    assert shown[-1] == rows - 1
    changes = np.flatnonzero(np.diff(status))
    assert np.isin([changes, changes + 1], shown).all()
    for curve, own in zip(found.panels[0], values, strict=True):
        assert np.array_equal(curve.values, own[shown], equal_nan=True)
        finite = own[np.isfinite(own)]
        if finite.size:
            reached = curve.values[np.isfinite(curve.values)]
            assert (reached.max(), reached.min()) == (finite.max(), finite.min())
