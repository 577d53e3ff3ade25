"""Intervals contain the true values; larger sets by a command, see tests/kernel/intervals.py."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kernel.compiler import COMPILER
from kernel.intervals import OPERATIONS, Intervals, check
from mpmath import mp

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C++ compiler on this machine")


@pytest.fixture(scope="module")
def enclose(tmp_path_factory: pytest.TempPathFactory) -> Intervals:
    return Intervals(tmp_path_factory.mktemp("intervals"))


@pytest.mark.parametrize("name", OPERATIONS)
def test_no_value_lies_outside(enclose: Intervals, name: str) -> None:
    known, outside = check(enclose, name, 500, 1)
    assert not outside
    assert known > 150


def pairs(number: tuple[float, float]) -> np.ndarray:
    """A midpoint that is a double, and a radius, in two lanes."""
    middle, radius = number
    return np.array([[middle] * 2, [0.0] * 2, [radius] * 2])


@pytest.mark.parametrize(
    ("name", "x", "y"),
    [
        ("divide", (1.0, 0.0), (1.0, 1.0)),
        ("divide", (0.0, 0.0), (0.0, 0.0)),
        ("divide", (1.0, 0.0), (1e-300, 2e-300)),
        ("sqrt", (1.0, 1.0 + 1e-15), (0.0, 0.0)),
        ("log", (1.0, 1.0), (0.0, 0.0)),
        ("asin", (0.3, 0.7000000000000001), (0.0, 0.0)),
        ("acos", (-1.0, 1e-16), (0.0, 0.0)),
        ("tan", (1.5, 0.1), (0.0, 0.0)),
        ("atan2", (0.5, 0.6), (0.5, 0.6)),
        ("principal_angle", (0.0, 0.6), (-0.5, 0.6)),
        ("power", (-1.0, 0.0), (0.5, 0.0)),
        ("power", (1.0, 1.5), (-1.0, 0.0)),
    ],
)
def test_where_there_is_no_value_nothing_is_said(
    enclose: Intervals, name: str, x: tuple[float, float], y: tuple[float, float]
) -> None:
    assert not np.isfinite(enclose(name, pairs(x), pairs(y))[2]).any()


@pytest.mark.parametrize("name", OPERATIONS)
@pytest.mark.parametrize("unknown", [math.nan, math.inf])
def test_of_the_unknown_nothing_is_known(enclose: Intervals, name: str, unknown: float) -> None:
    known = pairs((0.5, 0.0))
    assert not np.isfinite(enclose(name, pairs((0.5, unknown)), known)[2]).any()


@pytest.mark.parametrize("radius", [1e-320, 1e-30, 1e-16, 0.5])
@pytest.mark.parametrize("y", [-1.0, -1e-9, -0.0, 0.0, 1e-9, 0.5])
def test_an_angle_that_may_be_on_either_side_of_its_cut_has_both(
    enclose: Intervals, y: float, radius: float
) -> None:
    found = enclose("principal_angle", pairs((y * radius, radius)), pairs((-1.0, 0.25)))[:, 0]
    with mp.workdps(60):
        low, high = (mp.mpf(found[0]) + mp.mpf(found[1]) + s * mp.mpf(found[2]) for s in (-1, 1))
        assert low <= -mp.pi
        assert mp.pi <= high < mp.pi + 1e-15


@pytest.mark.parametrize("zero", [0.0, -0.0])
def test_the_angle_of_a_zero_is_half_a_turn_and_no_more(enclose: Intervals, zero: float) -> None:
    high, low, radius = enclose("principal_angle", pairs((zero, 0.0)), pairs((-1.0, 0.25)))[:, 0]
    assert (high, radius < 1e-28) == (math.pi, True)
    with mp.workdps(60):
        assert abs(mp.mpf(high) + mp.mpf(low) - mp.pi) <= mp.mpf(radius)


def test_radii_are_of_the_size_of_rounding(enclose: Intervals) -> None:
    random = np.random.default_rng(2)
    x, y = np.zeros((3, 1000)), np.zeros((3, 1000))
    x[0], y[0] = random.uniform(0.5, 2, (2, 1000))
    for name in ("add", "multiply", "divide", "sqrt", "sin", "atan2", "exp"):
        found = enclose(name, x, y)
        assert np.max(found[2] / np.abs(found[0])) < 2.0**-97
