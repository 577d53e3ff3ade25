"""Tables joined by monotone curves, straight lines and splines with other ends: against scipy,
closed forms and mpmath."""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from scipy.interpolate import CubicSpline, PchipInterpolator

import mechkin_cli as mk
from mechkin_cli.mechanism.curve import Ends, Interpolation, joined_curve

COUNT = 40 * int(os.environ.get("MECHKIN_RANDOM", "5"))
LAW = """\
format: 1
units: {length: mm, angle: deg, mass: kg, force: N}
links: {m: {mass: 2, center_of_mass: [0, 0, 0]}}
joints: {A: {type: P, links: [ground, m], point: [0, 0, 0], axis: [1, 0, 0]}}
motion:
  time: {from: 0, to: 4, step: 0.125}
  inputs: {A.s: {law: table, file: t.csv JOINED}}
"""
LOAD = """\
format: 1
units: {length: m, angle: deg, mass: kg, force: N}
links: {m: {mass: 2, center_of_mass: [0, 0, 0]}}
joints: {A: {type: P, links: [ground, m], point: [0, 0, 0], axis: [1, 0, 0]}}
loads: [{type: force, joint: A, value: {table: t.csv, over: time JOINED}}]
responses:
  run: {start: {A.s: 0, A.s_dot: 0}, time: {from: 0, to: 4, step: 0.25}, tolerance: 1e-12}
"""
REST = "time,s\n0,0\n1,0\n2,100\n3,100\n4,100\n"
"""A cylinder that rests, moves and rests."""


def peer(interpolation: Interpolation, ends: Ends, x: np.ndarray, y: np.ndarray) -> Any:
    if interpolation == "monotone":
        return PchipInterpolator(x, y)
    return CubicSpline(x, y, bc_type=ends)


@pytest.mark.parametrize(
    ("interpolation", "ends"),
    [("monotone", "not-a-knot"), ("spline", "natural"), ("spline", "clamped")],
)
def test_random_tables_against_scipy(interpolation: Interpolation, ends: Ends) -> None:
    random = np.random.default_rng(4)
    for _ in range(COUNT):
        points = int(random.integers(2, 12))
        x = np.cumsum(random.uniform(0.05, 2.0, points))
        y = random.choice([random.normal(size=points), np.round(random.normal(size=points))])
        at = np.linspace(x[0], x[-1], 101)
        found = joined_curve(x.tolist(), y.tolist(), interpolation, ends).evaluate(at)
        expected = peer(interpolation, ends, x, y)
        scale = 1.0 + np.abs(expected(at, 1)).max()
        assert np.abs(found[0] - expected(at)).max() < 1e-13 * scale
        assert np.abs(found[1] - expected(at, 1)).max() < 1e-12 * scale
        if interpolation == "monotone":
            assert y.min() - 1e-13 <= found[0].min()
            assert found[0].max() <= y.max() + 1e-13


def test_clamped_ends_at_40_digits() -> None:
    """The hermite cubics whose curvature is continuous, from a dense system in mpmath."""
    x, y = [0.0, 1.0, 2.5, 3.0], [0.0, 2.0, -1.0, 4.0]
    with mp.workdps(40):
        h = [mp.mpf(b) - mp.mpf(a) for a, b in pairwise(x)]
        rises = [(mp.mpf(b) - mp.mpf(a)) / s for a, b, s in zip(y, y[1:], h, strict=False)]
        matrix, right = mp.eye(4), mp.matrix([0, 0, 0, 0])
        for i in (1, 2):
            matrix[i, i - 1], matrix[i, i] = 1 / h[i - 1], 2 / h[i - 1] + 2 / h[i]
            matrix[i, i + 1] = 1 / h[i]
            right[i] = 3 * (rises[i - 1] / h[i - 1] + rises[i] / h[i])
        slopes = mp.lu_solve(matrix, right)
    found = joined_curve(x, y, "spline", "clamped").evaluate(np.array(x))[1]
    assert np.abs(found - [float(s) for s in slopes]).max() < 1e-14


def test_mirrored_and_shifted_tables_are_mirrored_and_shifted_curves() -> None:
    x, y, at = [0.0, 1.0, 1.5, 4.0], [0.0, 2.0, 2.0, -1.0], np.linspace(0.0, 4.0, 33)
    ways = ("monotone", "not-a-knot"), ("linear", "not-a-knot"), ("spline", "natural")
    for joining in ways:
        own = joined_curve(x, y, *joining).evaluate(at)[0]
        back = joined_curve([-one for one in reversed(x)], y[::-1], *joining).evaluate(-at)[0]
        high = joined_curve(x, [2.0 * one + 8.0 for one in y], *joining).evaluate(at)[0]
        np.testing.assert_allclose(back, own, atol=1e-14)
        np.testing.assert_allclose(high, 2.0 * own + 8.0, atol=1e-13)


def moved(tmp_path: Path, joined: str, table: str = REST, text: str = LAW) -> mk.Model:
    (tmp_path / "t.csv").write_text(table)
    (tmp_path / "law.yaml").write_text(text.replace(" JOINED", joined))
    return mk.load(tmp_path / "law.yaml")


def test_a_cylinder_at_rest_stays_at_rest(tmp_path: Path) -> None:
    smooth = moved(tmp_path, "").analyze()
    assert abs(smooth["A.s_dot"][0]) > 20.0
    (note,) = [d for d in smooth.diagnostics if d.code == "table-overshoot"]
    assert note.severity == "note"
    assert "write interpolation: monotone" in str(note)
    found = moved(tmp_path, ", interpolation: monotone").analyze()
    assert not [d for d in found.diagnostics if d.code == "table-overshoot"]
    resting = (found["time"] <= 1.0) | (found["time"] >= 2.0)
    assert set(found["A.s_dot"][resting]) == {0.0}
    u = found["time"][~resting] - 1.0
    np.testing.assert_allclose(found["A.s"][~resting], 100 * (3 * u**2 - 2 * u**3), atol=1e-12)
    clamped = moved(tmp_path, ", ends: clamped").analyze()
    assert clamped["A.s_dot"][0] == 0.0
    assert found.errors["A.s"].max() < 1e-12


def test_a_load_joined_by_straight_lines(tmp_path: Path) -> None:
    table = "t,F\n0,0\n1,2\n2,2\n3,-2\n4,0\n"
    rows = moved(tmp_path, ", interpolation: linear", table, LOAD).respond("run")
    knots, forces = np.arange(5.0), np.array([0.0, 2.0, 2.0, -2.0, 0.0])
    impulses = np.concatenate([[0.0], np.cumsum((forces[1:] + forces[:-1]) / 2.0)])
    for t, v in zip(rows["time"], rows["A.s_dot"], strict=True):
        k = min(int(t), 3)
        f = np.interp(t, knots, forces)
        assert v == pytest.approx((impulses[k] + (t - k) * (forces[k] + f) / 2.0) / 2.0, abs=1e-9)


@pytest.mark.parametrize(
    ("joined", "words"),
    [
        (", interpolation: linear", "the rate of a linear law jumps at every point"),
        (", interpolation: monotone, ends: natural", "a monotone curve has no natural ends"),
        (", interpolation: cubic", "interpolation"),
    ],
)
def test_what_is_refused(tmp_path: Path, joined: str, words: str) -> None:
    with pytest.raises(mk.InvalidFile, match=words):
        moved(tmp_path, joined)
