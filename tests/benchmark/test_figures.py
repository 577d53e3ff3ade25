"""The figures of large runs measure what they say, on few rows."""

import numpy as np
import pytest
from benchmark import figures
from benchmark.chains import STEP, chain_text

import mechkin_cli as mk


def test_a_chain_of_four_bars_closes_where_circles_meet():
    """Rocker after rocker from the crank, by the intersection of two circles in the plane."""
    loops = 3
    analysis = mk.loads(chain_text(loops)).analyze()
    angle = np.radians(np.arange(0.0, 11.0)) + np.pi / 2
    lengths = [1.6 + 0.1 * (k % 2) for k in range(loops + 1)]
    for k in range(loops):
        x, y = lengths[k] * np.cos(angle) - STEP, lengths[k] * np.sin(angle)
        coupler = np.hypot(STEP, lengths[k + 1] - lengths[k])
        away = np.hypot(x, y)
        cosine = (lengths[k + 1] ** 2 + away**2 - coupler**2) / (2 * lengths[k + 1] * away)
        angle = np.arctan2(y, x) - np.arccos(cosine)
        found = analysis[f"G{k + 1}.theta"]
        assert np.abs(found - np.degrees(angle - np.pi / 2)).max() < 1e-9


def test_a_chain_may_be_written_in_any_order():
    forward, backward = chain_text(3), chain_text(3, [2, 1, 0])
    assert sorted(forward.splitlines()) == sorted(backward.splitlines())
    assert forward != backward


def test_the_platform_moves_along_a_curved_path():
    model = mk.loads(figures.platform_text(41))
    analysis = model.analyze(tables=[])
    assert analysis.result.complete
    odd, even = (analysis[f"L{k}.s"] / analysis[f"L{k}.s"][-1] for k in (1, 2))
    assert np.abs(odd - even).max() > 0.05


@pytest.mark.parametrize("name", ["platform", "chains", "closing", "wheels", "threads"])
def test_a_figure_has_a_line_per_case(name, monkeypatch):
    monkeypatch.setattr(figures, "LOOPS", (2, 3))
    table = figures.FIGURES[name](1, 30)
    assert len(table.rows) >= 2
    assert all(row["value"] != 0.0 for row in table.rows)


def test_a_limit_is_met_or_not():
    assert figures.row("a", 2.0, "s", limit=1.5)["met"] is False
    assert figures.row("a", 1.0, "s", limit=1.5)["met"] is True
    assert figures.row("a", 1.7, "times", least=1.8)["met"] is False
    assert figures.row("a", 1.0, "s")["met"] is None
