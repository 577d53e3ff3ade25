"""The reaction solver against print (Tables XV-XVIII): the source's couples give its reactions."""

from __future__ import annotations

import numpy as np
import pytest
from rcsr.author_couples import cells
from rcsr.columns import LOADS, exact_values, labels, printed_units

UNIT = 1.0 + 1e-9  # printed decimals and their differences are not exact in binary


@pytest.fixture(scope="module")
def reactions():
    return cells()


@pytest.mark.parametrize(("table", "label"), labels(LOADS))
def test_to_one_unit_of_the_printed_digit(reactions, table, label):
    assert np.abs(printed_units(table, label, reactions[table, label])).max() <= UNIT


@pytest.mark.parametrize(("table", "label"), labels(LOADS))
def test_to_full_precision(reactions, table, label):
    expected = exact_values(f"author_{label}")
    error = np.abs(reactions[table, label] - expected).max()
    assert error <= 1e-13 * np.abs(expected).max()


def test_number_of_cells(reactions):
    """Two columns are zero in every row."""
    columns = [reactions[key] for key in labels(LOADS)]
    zero = [not column.any() for column in columns]
    assert (sum(c.size for c in columns), sum(zero)) == (594 + 2 * 27, 2)
