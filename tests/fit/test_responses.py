"""Fits of motions under forces: closed forms of a pendulum and an oscillator."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from scipy.optimize import brentq
from sensitivities.test_responses import OSCILLATOR, PENDULUM, angle, place

import mechkin_cli as mk

MOMENTS = [0.25, 0.5, 0.75]


def test_a_pendulum_is_known_by_three_moments() -> None:
    """Length and pull of the closed form with elliptic functions."""
    known = {"l": mp.mpf("0.62"), "pull": mp.mpf("17"), "from": mp.mpf(-30)}
    wanted = [float(angle(mp.mpf(t), known)) for t in MOMENTS]
    f = mk.loads(PENDULUM).fit(
        {"of": "A.theta", "run": "swing", "at": MOMENTS, "is": wanted},
        {"l": (0.3, 0.9), "pull": (10, 30)},
        starts=1,
    )
    assert f.status == "fitted", f.reason
    assert f.slopes == "exact"
    assert f.parameters["l"] == pytest.approx(0.62, abs=1e-8)
    assert f.parameters["pull"] == pytest.approx(17.0, abs=1e-6)
    assert f.targets[0].largest < 1e-7
    assert f.targets[0].inputs.tolist() == MOMENTS


def swing(d: float, times: np.ndarray) -> np.ndarray:
    own: dict[str, Any] = {"c": 300.0, "mu": 1.5, "x0": 40.0, "d": d}
    return np.array([float(place(t, own)) for t in times])


def test_the_least_damping_that_keeps_the_overshoot() -> None:
    """A bound of a response that binds, against the closed form at its rows."""
    times = np.array([0.0, 0.1, 0.2])
    f = mk.loads(OSCILLATOR.replace("to: 0.5", "to: 0.2")).fit(
        {"of": "d", "run": "swing", "least": "rms"},
        {"d": (1, 40)},
        constraints={"of": "P.s", "run": "swing", "min": "-12 m"},
        starts=1,
    )
    expected = brentq(lambda d: swing(d, times).min() + 12, 1, 40, xtol=1e-12)
    assert f.status == "fitted", f.reason
    assert f.parameters["d"] == pytest.approx(expected, abs=1e-5)
    assert f.constraints[0].value == pytest.approx(-12.0, abs=1e-5)


def test_the_damping_of_the_least_mean_square() -> None:
    times = np.arange(0.0, 0.501, 0.1)
    f = mk.loads(OSCILLATOR).fit(
        {"of": "P.s", "run": "swing", "least": "rms"}, {"d": (1, 42)}, starts=2, generations=3
    )
    share = np.full(6, 0.2)
    share[[0, -1]] = 0.1

    def slope(d: float) -> float:
        h = 1e-3
        squares = [share @ swing(d + k * h, times) ** 2 for k in (-1, 1)]
        return float(squares[1] - squares[0])

    expected = brentq(slope, 2, 42, xtol=1e-10)
    assert f.status == "fitted", f.reason
    assert f.parameters["d"] == pytest.approx(expected, abs=1e-4)
    size = float(np.sqrt(share @ swing(expected, times) ** 2))
    assert f.targets[0].largest == pytest.approx(size, rel=1e-9)


def test_a_stop_before_the_moment_is_no_answer() -> None:
    """The row of a stop is not that of the moment after it. The dead centre of the pendulum, half a
    period on, comes after 0.75 s where the pull is small."""
    text = PENDULUM.replace("step: 0.25}", "step: 0.25}\n    stop: [{dead_centre: A.theta}]")
    target = {"of": "A.theta", "run": "swing", "at": [0.75], "is": [-140]}
    late = mk.loads(text).fit(target, {"pull": (10, 15)}, starts=1)
    assert late.status == "not-assembled"  # at the moment 1 it has stopped
    assert "misses" in late.reason
    assert "of 5 rows of swing" in late.reason
    short = mk.loads(text.replace("to: 1,", "to: 0.75,")).fit(target, {"pull": (10, 21)}, starts=1)
    plain = mk.loads(PENDULUM).fit(target, {"pull": (10, 21)}, starts=1)
    assert short.status == plain.status == "fitted"
    assert short.parameters["pull"] == pytest.approx(plain.parameters["pull"], rel=1e-9)
    assert short.targets[0].largest < 1e-8


@pytest.mark.parametrize(
    ("target", "told"),
    [
        ({"of": "P.s", "run": "swnig", "at": [0.1], "is": [1]}, "did you mean swing"),
        ({"of": "P.s", "run": "swing", "at": [0.13], "is": [1]}, "the nearest at 0.1 s"),
        ({"of": "P.s", "run": "swing", "is": [1]}, "at:"),
        ({"of": "P.point", "run": "swing", "is": [[0, 0, 0]]}, "at which moments of swing"),
        ({"of": "P.s", "run": "swing", "at": ["3 m"], "is": [1]}, "3 m"),
    ],
)
def test_bad_questions_are_told_with_a_cure(target: dict[str, Any], told: str) -> None:
    with pytest.raises(mk.UsageError, match=told):
        mk.loads(OSCILLATOR).fit(target, {"d": (1, 40)})
