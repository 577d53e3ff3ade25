"""Unusual sweeps of one mechanism: long, downwards, held, repeated, back and forth."""

from __future__ import annotations

import numpy as np
import pytest
from oracle.document import to_text
from rcsr.columns import KINEMATICS, LOADS, exact_values, labels
from stress.cases import row_of, with_motion

import mechkin_cli as mk

LIMITS = dict.fromkeys(KINEMATICS, 2e-14) | dict.fromkeys(LOADS, 1e-13)


def analyze(law: dict, first: int) -> mk.Analysis:
    return mk.loads(to_text(with_motion(law, first))).analyze()


def agrees(analysis: mk.Analysis, rows: slice, degrees: list[int]) -> None:
    """Every column at some rows against the exact table."""
    cells = {(t.name, c.label): c.values for t in analysis.tables for c in t.columns}
    for table, label in labels(KINEMATICS + LOADS):
        exact = exact_values(f"ne_{label}" if table in LOADS else label)
        wanted = exact[[row_of(d) for d in degrees]]
        error = np.abs(cells[table, label][rows] - wanted).max()
        assert error <= LIMITS[table] * np.abs(exact).max(), label


def all_solved(analysis: mk.Analysis) -> None:
    assert not analysis.result.status.any()
    assert analysis.diagnostics == tuple(analysis.model.diagnostics)
    assert np.all(analysis["row.residual"] <= 1e-14)
    assert np.all(analysis["row.power_error"] <= 1e-12)


def test_a_hundred_thousand_rows():
    analysis = analyze({"from": "150", "to": "202", "count": "104001"}, 150)
    all_solved(analysis)
    agrees(analysis, slice(None, None, 4000), list(range(150, 203, 2)))
    # neighbours 0.0005 degrees apart: a row of another branch or a bad one would stand out
    step = np.diff(analysis["O4.theta"])
    assert np.all(np.abs(np.diff(step)) <= 1e-6)


def test_downwards():
    analysis = analyze({"from": "202", "to": "150", "step": "2"}, 202)
    all_solved(analysis)
    assert analysis["O1.theta"].tolist() == list(range(202, 149, -2))
    agrees(analysis, slice(None), list(range(202, 149, -2)))


@pytest.mark.parametrize("degrees", [150, 180, 202])
def test_held(degrees):
    analysis = analyze({"at": str(degrees)}, degrees)
    assert analysis.rows == 1
    all_solved(analysis)
    agrees(analysis, slice(None), [degrees])


@pytest.mark.parametrize(
    "degrees",
    [
        [160, 160, 160],
        [150, 150, 176, 176, 176, 202, 202],
        [150, 202, 150, 202],
        [180, 150, 202, 176, 178, 174, 200, 152],
        [202, 200, 150, 150, 198],
    ],
)
def test_listed(degrees):
    analysis = analyze({"values": [str(d) for d in degrees]}, degrees[0])
    all_solved(analysis)
    assert analysis["O1.theta"].tolist() == degrees
    agrees(analysis, slice(None), degrees)


def test_repeated_values_repeat_their_rows():
    analysis = analyze({"values": ["150", "170", "170", "170"]}, 150)
    for table in analysis.tables:
        for column in table.columns:
            assert column.values[1] == column.values[2] == column.values[3]
