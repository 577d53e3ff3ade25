"""Stacks of tolerances against their formulas on differences of plain runs, and against samples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechkin_cli as mk

TEXT = Path("mechanisms/plane/planar_four_bar.yaml").read_text(encoding="utf-8")
SMALL = {"a": "0.01 mm", "b": ["-0.01 mm", 0.03], "c": 0.02}
"""So small that the four-bar is linear in them."""


def slope(name: str, value: float, quantity: str) -> np.ndarray:
    """By central differences of plain runs."""
    model, step = mk.loads(TEXT), 1e-3
    above, below = (
        model.with_parameters({name: value + k}).analyze()[quantity] for k in (step, -step)
    )
    return (above - below) / (2 * step)


@pytest.mark.parametrize("method", ["latin", "sobol", "random"])
@pytest.mark.parametrize(("distribution", "sigmas"), [("uniform", 3**0.5), ("normal", 3.0)])
def test_a_linear_stack(method: str, distribution: str, sigmas: float) -> None:
    model = mk.loads(TEXT)
    t = model.tolerances(
        SMALL, ["C.theta"], samples=512, method=method, seed=3, distribution=distribution
    )
    a, b, c = (slope(n, v, "C.theta") for n, v in (("a", 40), ("b", 120), ("c", 90)))
    nominal = model.analyze()["C.theta"]
    low, high = t.worst("C.theta")
    size = np.abs([0.01 * a, 0.02 * b, 0.02 * c]).max()
    half = 0.01 * np.abs(a) + 0.02 * np.abs(b) + 0.02 * np.abs(c)
    assert np.abs(high - (nominal + 0.01 * b + half)).max() < 1e-5 * size
    assert np.abs(low - (nominal + 0.01 * b - half)).max() < 1e-5 * size
    root = np.sqrt((0.01 * a) ** 2 + (0.02 * b) ** 2 + (0.02 * c) ** 2)
    least, most = t.root_sum_square("C.theta")
    assert np.abs((most - least) / 2 - root).max() < 1e-5 * size
    assert np.abs(t.scatter("C.theta") - root / sigmas).max() < 1e-5 * size
    shares = t.shares("C.theta")
    assert np.abs(shares["a"] - (0.01 * a / root) ** 2).max() < 1e-5
    assert np.abs(sum(shares.values()) - 1.0).max() < 1e-12
    sampled = t.sampled("C.theta")
    # five standard errors, in all of 25 rows; what is not linear is far below them
    assert (np.abs(sampled.mean - nominal - 0.01 * b) < 5 * sampled.mean_error).all()
    off = np.abs(sampled.deviation - t.scatter("C.theta"))
    assert (off < 5 * sampled.deviation_error).all()
    drawn = t.drawn("C.theta")
    assert np.abs(sampled.mean - drawn.mean(axis=0)).max() < 1e-12
    assert np.abs(sampled.deviation - drawn.std(axis=0, ddof=1)).max() < 1e-12
    assert np.abs(t.quantile("C.theta", 0.9) - np.quantile(drawn, 0.9, axis=0)).max() < 1e-12
    assert not t.inaccurate("C.theta").any()
    assert "of the scatter of C.theta at" in repr(t)


def test_parameters_that_are_written_with_one_another_scatter_alone() -> None:
    text = TEXT.replace("b: 120 mm", "b: 3*a")
    t = mk.loads(text).tolerances({"a": 0.01, "b": 0.01}, ["C.theta"], at=[60], samples=8)
    alone = mk.loads(TEXT).sensitivities(["C.theta"], ["a", "b"], at=[60])
    for name in "ab":
        assert np.abs(t.slopes["C.theta", name] / alone["C.theta", name] - 1.0).max() < 1e-12


def test_a_dead_centre_inside_a_band() -> None:
    """A rod of 0.33 m reaches the slide from a crank that stands 0.3214 m off: not with 0.32."""
    text = Path("mechanisms/plane/slider_crank.yaml").read_text(encoding="utf-8")
    text = text.replace("crank: 0.1 m", "crank: 0.5 m").replace("rod: 0.35 m", "rod: 0.33 m")
    text = text.replace("to: 360, step: 10", "to: 40, step: 10")
    t = mk.loads(text).tolerances({"rod": 0.01}, ["D.s"], samples=256)
    assert t.inaccurate("D.s").tolist() == [False, False, False, False, True]
    edge = 0.5 * np.sin(np.radians(40.0))
    expected = 256 * (edge - 0.32) / 0.02
    assert abs(t.sampled("D.s").lost[-1] - expected) <= 1  # a Latin hypercube has even slices
    assert t.lost_ends("D.s").tolist() == [0, 0, 0, 0, 1]
    assert "have no position somewhere in the bands" in repr(t)


def test_what_is_refused() -> None:
    model = mk.loads(TEXT)
    for given, more, words in (
        ({"e": 1}, {}, "there is no parameter e"),
        ({"a": "1 deg"}, {}, "a = 1 deg"),
        ({"a": [0.2, 0.1]}, {}, "has no width"),
        ({"a": [1, 2, 3]}, {}, "one number, or two"),
        ({"a": 0.1}, {"method": "dice"}, "method is one of"),
        ({"a": 0.1}, {"distribution": "flat"}, "distribution is one of"),
        ({"a": 0.1}, {"samples": 1}, "2 or more"),
        ({"a": 0.1}, {"samples": -3}, "2 or more, not -3"),
        ({"a": 0.1}, {"samples": 10**12}, r"limit 100000000.*a study"),
        ({"a": 0.1}, {"seed": -1}, "a whole number, 0 or more, not -1"),
        ("a", {}, "a mapping"),
        ({}, {}, r"a mapping .*not \{\}"),
    ):
        with pytest.raises(mk.UsageError, match=words):
            model.tolerances(given, ["C.theta"], **more)
    with pytest.raises(mk.UsageError, match="is a vector"):
        model.tolerances({"a": 0.1}, ["pen.position"])


@pytest.mark.parametrize("part", [-0.1, 2.0, float("nan")])
def test_a_quantile_is_of_a_part(part: float) -> None:
    drawn = mk.loads(TEXT).tolerances({"a": 0.1}, ["C.theta"], samples=4)
    with pytest.raises(mk.UsageError, match="from 0 to 1"):
        drawn.quantile("C.theta", part)
