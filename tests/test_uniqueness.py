"""Cells of reactions that redundant constraints leave arbitrary."""

from __future__ import annotations

import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.tables.columns import unique_cells


def test_a_cell_that_any_other_reaction_changes_is_emptied():
    values = np.array([1.0, 2.0, 3.0, np.nan])
    others = [np.array([1.0, 2.5, 3.0, np.nan]), np.array([1.0, 2.0, 3.0 + 1e-13, np.nan])]
    found = unique_cells(values, others)
    assert found[0] == 1.0
    assert found[2] == 3.0
    assert np.isnan(found[[1, 3]]).all()
    assert values[1] == 2.0


def test_rounding_is_judged_by_the_columns_largest_value():
    values = np.array([1e6, 1e-5])
    assert np.isfinite(unique_cells(values, [np.array([1e6, 2e-5])])).all()


def test_without_alternatives_nothing_changes():
    values = np.array([1.0, np.nan])
    assert unique_cells(values, []) is values


def test_a_row_without_load_says_nothing_of_the_size_of_others():
    values = np.array([0.0, 1e-9, 2e-9])
    assert np.isnan(unique_cells(values, [np.array([1.0, 1.5e-9, 3e-9])])).all()


FOUR_BAR = """
format: 1
links: {a: {}, b: {}, c: {}}
joints:
  A: {type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: R, links: [a, b], point: [0, 1, 0], axis: [0, 0, 1]}
  C: {type: R, links: [b, c], point: [2, 2, 0], axis: [0, 0, 1]}
  D: {type: R, links: [ground, c], point: [3, 0, 0], axis: [0, 0, 1]}
motion:
  time: {from: 0, to: 3, step: 1}
  inputs: {A.theta: {law: constant-rate, at: 0, rate: 0.1 rad/s}}
loads: [{type: force, link: c, point: [3, 1, 0.3], force: ["LOAD*time", 0, "LOAD*time"]}]
"""


@pytest.mark.parametrize("load", ["1e-12 N/s", "1e-9 N/s", "1 N/s", "1e3 N/s"])
def test_what_is_arbitrary_does_not_hang_on_the_size_of_loads(load: str) -> None:
    """Forces along the axes of a plane loop are, those in its plane are not; no load in row 1."""
    found = mk.loads(FOUR_BAR.replace("LOAD", load)).analyze(["C.force", "D.force"])
    for name in ("C.force", "D.force"):
        assert np.isnan(found[name][:, 2]).all()
        assert np.isfinite(found[name][:, :2]).all()
