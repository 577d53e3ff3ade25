"""Rates that the file leaves out are taken as zero: a note says so where a given rate would change
a number."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mechkin_cli as mk

FILE: dict[str, Any] = {
    "format": 1,
    "plane": "xy",
    "units": {"length": "mm", "angle": "deg", "force": "N"},
    "links": {"crank": {}, "rod": {}, "slider": {}},
    "joints": {
        "O": {"type": "R", "links": ["ground", "crank"], "point": [0, 0]},
        "A": {"type": "R", "links": ["crank", "rod"], "point": [40, 0]},
        "B": {"type": "R", "links": ["rod", "slider"], "point": [150, 0]},
        "D": {"type": "P", "links": ["ground", "slider"], "point": [150, 0], "axis": [1, 0]},
    },
}
LOADS: dict[str, list[dict[str, Any]]] = {
    "none": [],
    "constant": [{"type": "force", "joint": "D", "value": "5 N"}],
    "of the place": [{"type": "force", "joint": "D", "value": "0.1 N/mm*D.s"}],
    "of the rate": [{"type": "force", "joint": "D", "value": "if(D.s_dot < 0 mm/s, 9 N, 0 N)"}],
    "damper": [{"type": "damper", "joint": "D", "coordinate": "s", "damping": "0.1 N*s/mm"}],
    "friction": [
        {"type": "force", "joint": "D", "value": "5 N"},
        {"type": "friction", "joint": "D", "coefficient": 0.1, "length": "20 mm"},
    ],
}
COLUMNS = [
    "D.s",
    "D.s_dot",
    "D.s_ddot",
    "rod.omega",
    "O.effort",
    "norm(A.force)",
    "D.s.mechanical_advantage",
    "O.theta.reduced_inertia",
    "row.power_error",
]


def _analysis(loads: str, *, mass: bool, column: str, motion: dict[str, Any]) -> mk.Analysis:
    slider = {"mass": 2, "center_of_mass": [150, 0]} if mass else {}
    swept = {"from": 20, "to": 340, "count": 5} | motion
    file = FILE | {
        "links": FILE["links"] | {"slider": slider},
        "loads": LOADS[loads],
        "motion": {"inputs": {"O.theta": swept}},
        "tables": [{"name": "t", "columns": [column]}],
    }
    return mk.load(file).analyze()


def _noted(analysis: mk.Analysis) -> bool:
    return any(diagnostic.code == "no-rate" for diagnostic in analysis.diagnostics)


@pytest.mark.parametrize("mass", [False, True])
@pytest.mark.parametrize("loads", LOADS)
def test_it_is_told_where_a_rate_would_change_a_number(loads: str, mass: bool) -> None:
    for column in [*COLUMNS, *(["row.kinetic_energy"] if mass else [])]:
        silent = _analysis(loads, mass=mass, column=column, motion={})
        still = _analysis(loads, mass=mass, column=column, motion={"rate": 0})
        moving = _analysis(loads, mass=mass, column=column, motion={"rate": "3 rad/s"})
        np.testing.assert_array_equal(silent[column], still[column])
        matters = not np.array_equal(still[column], moving[column], equal_nan=True)
        assert _noted(silent) == matters, column
        assert not _noted(still)
        assert not _noted(moving)


def test_the_note_says_what_rests_and_what_is_left_out() -> None:
    analysis = _analysis("damper", mass=True, column="D.s_dot*O.effort", motion={})
    (note,) = (d for d in analysis.diagnostics if d.code == "no-rate")
    assert str(note) == (
        "note: O.theta has no rate, which is taken as zero: D.s_dot is as at rest, and forces are "
        "as at rest, without the inertia forces of slider and those of dampers; give it with "
        "rate:, or write rate: 0 where the rows are meant at rest"
    )


def _two(first: dict[str, Any], second: dict[str, Any]) -> mk.Analysis:
    """A chain of two driven pins."""
    file = FILE | {
        "links": {"crank": {}, "rod": {}},
        "joints": {name: FILE["joints"][name] for name in "OA"},
        "motion": {"inputs": {"O.theta": first, "A.theta": second}},
    }
    return mk.load(file).analyze(["rod.omega"], tables=[])


SWEPT = {"from": 0, "to": 90, "count": 3}


def test_an_input_that_is_held_or_follows_needs_no_rate() -> None:
    rated = SWEPT | {"rate": "1 rad/s"}
    assert not _noted(_two(rated, {"at": 10}))
    assert not _noted(_two(rated, {"with": "2*O.theta"}))
    assert _noted(_two(rated, SWEPT))
    assert _noted(_two(SWEPT, {"with": "2*O.theta"}))
    assert _noted(_two({"at": 0}, {"at": 10}))
    assert not _noted(_two({"at": 0}, {"at": 10, "rate": "2 rad/s"}))
    assert not _noted(_two(SWEPT | {"acceleration": "1 rad/s^2"}, {"at": 10}))


def test_laws_of_time_have_their_rates() -> None:
    law = {"law": "harmonic", "from": 0, "to": 90}
    motion = {"time": {"from": 0, "to": 1, "count": 3}, "inputs": {"O.theta": law}}
    assert not _noted(mk.load(FILE | {"motion": motion}).analyze(["rod.omega"], tables=[]))
