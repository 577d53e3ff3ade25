"""Every cell of the tables against values that another program computed at 40 digits."""

from __future__ import annotations

import numpy as np
import pytest
from rcsr.columns import KINEMATICS, LOADS, exact_values, labels

SMALL = 1e-3  # of the column's largest: cells below it are differences of larger numbers


def agrees(values: np.ndarray, expected: np.ndarray, of_largest: float) -> None:
    errors, largest = np.abs(values - expected), np.abs(expected).max()
    assert errors.max() <= of_largest * largest
    counting = np.abs(expected) > SMALL * largest
    assert np.all(errors[counting] <= 1e-11 * np.abs(expected[counting]))


@pytest.mark.parametrize(("table", "label"), labels(KINEMATICS))
def test_kinematics(tables, table, label):
    agrees(tables[table][label], exact_values(label), 2e-14)


@pytest.mark.parametrize(("table", "label"), labels(LOADS))
def test_loads(tables, table, label):
    agrees(tables[table][label], exact_values(f"ne_{label}"), 1e-13)


@pytest.mark.parametrize("table", KINEMATICS + LOADS)
def test_the_input_is_printed_as_it_is_written(tables, table):
    assert tables[table]["theta1"].tolist() == list(range(150, 203, 2))
