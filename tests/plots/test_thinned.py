"""Pictures of long runs: of fewer rows, with the same extremes, ends, gaps, marks and verdicts."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree
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


def assert_no_gap_is_crossed(values: np.ndarray, shown: np.ndarray) -> None:
    """Between rows with numbers that a line joins all have one, and gaps that are shown begin and
    end where they do."""
    known = np.isfinite(values)
    for first, behind in pairwise(shown.tolist()):
        if known[first] and known[behind]:
            assert known[first:behind].all()
        elif known[first] or known[behind]:
            assert behind == first + 1


@pytest.mark.parametrize("seed", range(12))
def test_closed_curves_pass_all_rows(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many turns, some of them alike: each row lies within a dot of the lines that are drawn,
    and each line within one of those of all rows."""
    draw = np.random.default_rng([7, seed])
    rows = int(draw.integers(3000, 9000))
    monkeypatch.setattr(thinned, "STRETCHES", int(draw.choice([3, 50, 200, 20_000])))
    turns = draw.choice([0.3, 7.0, 60.0, 400.0])
    angle = np.linspace(0.0, 2 * np.pi * turns, rows)
    grown = 1.0 + draw.choice([0.0, 0.5]) * np.linspace(0.0, 1.0, rows)
    x = grown * np.cos(angle) + 0.3 * np.cos(2 * angle)
    y = grown * np.sin(angle) * draw.choice([1.0, 1e-9, 1e9])
    if seed % 3 == 0:
        y[draw.random(rows) < 0.001] = np.nan
    cuts = [0, *sorted(draw.integers(1, rows, 4).tolist()), rows]
    found = thinned.thinned_picture(
        [
            (one_of(x, y, slice(max(begin - 1, 0), end)), slice(min(begin, 1), None))
            for begin, end in pairwise(cuts)
        ],
        rows,
    )
    drawn = found.x[0].values, found.panels[0][0].values
    scale = np.nanmax([x, y], axis=1) - np.nanmin([x, y], axis=1)
    for points, others in (((x, y), drawn), (drawn, (x, y))):
        assert distance(points, others, scale) < 1.01 / 1024 * np.sqrt(2)


def one_of(x: np.ndarray, y: np.ndarray, rows: slice) -> Drawing:
    along = PlotCurve("row", "", np.arange(float(x.size))[rows])
    curves, status = (PlotCurve("y", "mm", y[rows]),), np.zeros(x[rows].size, dtype=np.int8)
    return Drawing("any", curves, PlotCurve("x", "N", x[rows]), along, (), status, frozenset())


def distance(points: tuple, lines: tuple, scale: np.ndarray) -> float:
    """Of the farthest point, and of the farthest middle between two, from lines, in parts of the
    picture; by lines cut into pieces far below a dot."""
    place = np.stack(points, axis=1) / scale
    middles = (place[1:] + place[:-1]) / 2
    place = np.concatenate([place, middles])
    place = place[np.isfinite(place).all(axis=1)]
    way = np.stack(lines, axis=1) / scale
    steps = np.diff(way, axis=0)
    length = np.nan_to_num(np.abs(steps).max(axis=1))
    count = np.where(np.isfinite(steps).all(axis=1), np.ceil(length * 4096), 0).astype(int)
    owner = np.repeat(np.arange(count.size), count)
    number = np.arange(owner.size) - np.repeat(np.cumsum(count) - count, count)
    dense = way[:-1][owner] + (number / count[owner])[:, None] * steps[owner]
    every = np.concatenate([dense, way[np.isfinite(way).all(axis=1)]])
    return float(cKDTree(every).query(place)[0].max())


def test_a_curve_of_many_turns_is_no_larger_than_one_of_few() -> None:
    """Turns that would be drawn over others are left out, and the picture is that of one turn."""
    rows = 200_000
    angle = np.linspace(0.0, 2 * np.pi * 3777.7, rows)
    x, y = np.cos(angle), np.sin(angle)
    parts = [
        (one_of(x, y, slice(begin, begin + 20_000)), slice(None))
        for begin in range(0, rows, 20_000)
    ]
    found = thinned.thinned_picture(parts, rows)
    drawn = found.x[0].values, found.panels[0][0].values
    assert drawn[0].size < 65_536
    assert distance((x[:5000], y[:5000]), drawn, np.array([2.0, 2.0])) < 2 / 1024


@pytest.mark.parametrize("x", [None, "O4.theta"])
@pytest.mark.parametrize("largest", ["1e305", "1.7e308"])
def test_numbers_beyond_every_axis_are_refused(largest: str, x: str | None) -> None:
    model = mk.load(RCSR)
    y = [f"{largest}*sin(9*O1.theta)"]
    for run in (model.analyze(), model.stream(rows=5)):
        with pytest.raises(mk.UsageError, match=r"reaches .*, and no axis goes beyond 1e\+300"):
            run.picture(y, x)


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
        assert_no_gap_is_crossed(own, shown)
        finite = own[np.isfinite(own)]
        if finite.size:
            reached = curve.values[np.isfinite(curve.values)]
            assert (reached.max(), reached.min()) == (finite.max(), finite.min())
