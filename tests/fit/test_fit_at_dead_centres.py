"""Fits, and tolerances, of what is infinite in a row at a dead centre: they say what, where, and
what to do, and what they say to do helps.

A slider-crank that its slider drives: at x from the pivot the crank stands at
acos((x^2 + r^2 - l^2)/(2 x r)), and a torque on it costs the slider its derivative by x.
"""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from pump import pump

import mechkin_cli as mk

TEXT = pump("T", ", T: 2 N*m")
PEAK = {"of": "D.effort", "least": "peak"}
BOUNDS = {"T": ("0.5 N*m", "3 N*m")}
BEFORE = TEXT.replace(", 40 mm]", "]")


def effort(s: float, torque: float) -> float:
    """The slider's in N, for a torque in N*mm."""
    with mp.workdps(30):
        slope = mp.diff(lambda x: mp.acos((x**2 + 900 - 2500) / (60 * x)), mp.mpf(40) + s)
    return float(-torque * slope)


@pytest.mark.parametrize("least", ["peak", "rms"])
def test_an_infinite_peak_is_told_with_its_row_and_a_cure(least: str) -> None:
    f = mk.loads(TEXT).fit({**PEAK, "least": least}, BOUNDS, starts=1)
    assert f.status == "infinite"
    assert f.rows_not_ok == 0
    assert "D.effort is infinite in row 5 (D.s = 40 mm), which stands at a dead centre" in f.reason
    assert "end the sweep before it, or vary a dimension that moves the dead centre" in f.reason
    assert "misses" not in repr(f)
    assert f.targets[0].largest == np.inf


def test_both_cures_help() -> None:
    f = mk.loads(BEFORE).fit(PEAK, BOUNDS, starts=1)
    assert f.status == "fitted", f.reason
    assert f.parameters["T"] == pytest.approx(500.0, rel=1e-9)  # N*mm
    assert f.targets[0].largest == pytest.approx(effort(30.0, 500.0), rel=1e-8)
    moved = mk.loads(TEXT).fit(PEAK, {"r": ("30 mm", "34 mm")}, starts=2, generations=4)
    assert moved.status == "fitted", moved.reason
    assert moved.parameters["r"] > 31.0
    assert np.isfinite(moved.targets[0].largest)


def test_constraints_and_values_at_inputs_say_the_same() -> None:
    model = mk.loads(TEXT)
    angle = {"of": "A.theta", "at": [10, 20], "is": [-20, -40], "within": 1}
    limit = {"of": "D.effort", "max": "900 N"}
    f = model.fit(angle, BOUNDS, constraints=limit, starts=1)
    assert f.status == "infinite"
    assert "D.effort is infinite in row 5" in f.reason
    model = mk.loads(BEFORE.replace("30 mm], rate", "30 mm, 35 mm], rate"))
    values = {"of": "D.effort", "at": [10, 40], "is": [1, 2], "within": 1}
    f = mk.loads(TEXT).fit([angle, values], BOUNDS, starts=1)
    assert f.status == "infinite"
    assert "D.effort is infinite at D.s = 40 mm, a dead centre; ask for it before" in f.reason
    f = model.fit([angle, {**values, "at": [10, 41]}], BOUNDS, starts=1)
    assert f.status == "not-assembled"
    assert "D.effort has no value at D.s = 41 mm; ask for it at inputs" in f.reason


def test_renamed_and_in_metres() -> None:
    text = TEXT.replace("D.", "slide.").replace("D:", "slide:").replace("length: mm", "length: m")
    f = mk.loads(text).fit({**PEAK, "of": "slide.effort"}, BOUNDS, starts=1)
    assert f.status == "infinite"
    assert "slide.effort is infinite in row 5 (slide.s = 0.04 m)" in f.reason


def test_samples_of_what_is_infinite_are_lost() -> None:
    found = mk.loads(TEXT).tolerances({"T": "0.1 N*m"}, ["D.effort"], samples=16)
    sampled = found.sampled("D.effort")
    assert sampled.lost.tolist() == [0, 0, 0, 0, 16]
    assert found.lost_ends("D.effort").tolist() == [0, 0, 0, 0, 2]
    assert found.inaccurate("D.effort").tolist() == [False] * 4 + [True]
    assert np.isnan(sampled.mean[-1])
    assert np.isnan(sampled.deviation[-1])
    # the torque within its band makes the same part of the effort in every other row
    own = np.array([effort(10.0 * k, 2000.0) for k in range(4)])
    np.testing.assert_allclose(found.nominal("D.effort")[:-1], own, rtol=1e-9)
    parts = sampled.deviation[:-1] / own
    np.testing.assert_allclose(parts, parts[0], rtol=1e-9)
    assert "it is infinite at the dead centre at 40 mm" in repr(found)
    before = mk.loads(BEFORE).tolerances({"T": "0.1 N*m"}, ["D.effort"], samples=16)
    assert not before.inaccurate("D.effort").any()
    np.testing.assert_allclose(before.sampled("D.effort").mean, sampled.mean[:-1], rtol=1e-14)
