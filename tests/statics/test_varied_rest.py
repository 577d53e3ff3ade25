"""Windows and sweeps at rest among the runs that are varied, studied and fitted: against each
variant by itself, and closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from references import FILE_OF

import mechkin_cli as mk

RIDE: dict[str, Any] = {
    "format": 1,
    "plane": "xy",
    "units": {"length": "m", "force": "N"},
    "parameters": {"rate": "2 kN/m", "weight": "10 kg"},
    "links": {"b": {"mass": "weight", "center_of_mass": [0, 0]}},
    "joints": {"S": {"type": "P", "links": ["ground", "b"], "point": [0, 0], "axis": [0, 1]}},
    "points": {"seat": {"link": "b", "at": [0, 0]}},
    "loads": [
        {"type": "gravity", "g": [0, -10]},
        {"type": "spring", "joint": "S", "coordinate": "s", "stiffness": "rate"},
        {"type": "force", "link": "b", "point": "seat", "force": [0, "-1 N/s*time"]},
    ],
    "motion": {"time": {"from": 0, "to": 400, "step": 100}, "rest": ["S.s"]},
    "equilibria": {"empty": {"window": {"S.s": {"from": -1, "to": 1}}}},
}
"""A load of 100 N for each 100 s on a spring."""


def sunk(rate: float, load: float, weight: float = 10) -> float:
    return -(10 * weight + load) / rate


@pytest.fixture(scope="module")
def toggle() -> mk.Model:
    return mk.load(FILE_OF["toggle"])


def test_variants_of_a_sweep_at_rest_are_those_by_themselves(toggle: mk.Model) -> None:
    rates = [4.0, 10.0, 13.0]
    names = ["A.theta", "knee.position"]
    found = toggle.vary({"k": rates}, names)
    for number, rate in enumerate(rates):
        alone = toggle.with_parameters({"k": rate}).analyze(names)
        for name in names:
            assert np.array_equal(found[name][number], alone[name], equal_nan=True)
        assert found.codes[number].tolist() == alone.result.status.tolist()
    assert found.complete.tolist() == [False, True, True]
    reduced = toggle.vary({"k": rates}, ["A.theta"], reduce="min")
    assert reduced["A.theta"].tolist() == np.nanmin(found["A.theta"], axis=1).tolist()


def test_variants_of_a_window_have_as_many_rows_as_the_most_equilibria(toggle: mk.Model) -> None:
    pushes = [30.0, 0.0, 12.0]
    found = toggle.vary({"push": pushes}, ["A.theta", "row.least_stiffness"], run="pushed")
    counts = []
    for number, push in enumerate(pushes):
        alone = toggle.with_parameters({"push": push}).equilibrium("pushed")
        count = alone.rows
        counts.append(count)
        own = found["A.theta"][number]
        assert own[:count].tolist() == alone["A.theta"].tolist()
        assert np.isnan(own[count:]).all()
    assert found["A.theta"].shape == (3, max(counts))
    assert len(set(counts)) > 1
    assert found.complete.all()


def test_a_study_of_a_sweep_at_rest_and_of_a_window() -> None:
    m = mk.load(RIDE)
    study = {
        "vary": {"rate": ["1 kN/m", "2 kN/m", "4 kN/m"]},
        "keep": [{"of": "S.s", "as": ["min", "max"]}],
    }
    found = m.study(study)
    assert found["min(S.s)"] == pytest.approx([sunk(r, 400) for r in (1e3, 2e3, 4e3)])
    assert found["max(S.s)"] == pytest.approx([sunk(r, 0) for r in (1e3, 2e3, 4e3)])
    window = m.study({**study, "run": "empty", "rows": ["S.s"]})
    assert window["max(S.s)"] == pytest.approx([sunk(r, 0) for r in (1e3, 2e3, 4e3)])
    assert window.rows["S.s"] == pytest.approx([sunk(r, 0) for r in (1e3, 2e3, 4e3)])


def test_a_study_of_a_window_keeps_the_rows_that_there_are(toggle: mk.Model) -> None:
    study = {
        "run": "pushed",
        "vary": {"push": ["30 N", "0 N", "12 N"]},
        "keep": [{"of": "A.theta", "as": ["max"]}],
        "rows": ["A.theta"],
    }
    found = toggle.study(study)
    counts = [
        toggle.with_parameters({"push": push}).equilibrium("pushed").rows for push in (30, 0, 12)
    ]
    assert np.bincount(found.rows["variant"]).tolist() == counts
    assert np.isfinite(found.rows["A.theta"]).all()


def test_a_spring_rate_is_fitted_to_ride_heights_over_the_load() -> None:
    m = mk.load(RIDE)
    heights = [sunk(1250, 100, 7.5), sunk(1250, 300, 7.5)]
    found = m.fit(
        {"of": "S.s", "at": ["100 s", "300 s"], "is": heights},
        {"rate": ("0.8 kN/m", "4 kN/m"), "weight": ("5 kg", "20 kg")},
        starts=1,
        generations=2,
    )
    assert found.parameters["rate"] == pytest.approx(1250, rel=1e-9)
    assert found.parameters["weight"] == pytest.approx(7.5, rel=1e-9)
    assert max(abs(met).max() for met in (one.deviations for one in found.targets)) < 1e-10


def test_a_sweep_at_rest_over_an_input_is_fitted_at_its_values() -> None:
    """A spring of torsion between an arm that is driven and one that rests under a moment."""
    twist = {
        "format": 1,
        "plane": "xy",
        "units": {"length": "m", "angle": "deg", "force": "N"},
        "parameters": {"c": "3 N*m"},
        "links": {"a": {}, "b": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": [0, 0]},
            "B": {"type": "R", "links": ["a", "b"], "point": [1, 0]},
        },
        "loads": [
            {"type": "spring", "joint": "B", "coordinate": "theta", "stiffness": "c/(1 rad)"},
            {"type": "torque", "joint": "B", "value": "1 N*m/rad*A.theta"},
        ],
        "motion": {
            "inputs": {"A.theta": {"from": 0, "to": 60, "step": 20}},
            "rest": ["B.theta"],
        },
    }
    m = mk.load(twist)
    r = m.analyze(["B.theta"])
    assert r["B.theta"] == pytest.approx([0, 20 / 3, 40 / 3, 20], abs=1e-9)
    found = m.fit(
        {"of": "B.theta", "at": [30], "is": [12]},
        {"c": ("1 N*m", "5 N*m")},
        starts=1,
        generations=2,
    )
    assert found.parameters["c"] == pytest.approx(2.5, rel=1e-9)
