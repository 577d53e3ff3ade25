"""Cells of reactions that redundant constraints leave arbitrary."""

from __future__ import annotations

import numpy as np

from mechkin_cli.tables.uniqueness import unique_cells


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
