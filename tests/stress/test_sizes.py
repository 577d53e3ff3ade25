"""Mechanisms from micrometres to a thousand kilometres: the same digits, scaled."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from rcsr.columns import KINEMATICS, LOADS, exact_values, labels
from stress.cases import scaled

import mechkin_cli as mk

COLUMNS = labels(KINEMATICS + LOADS)
LENGTHS = ("s2", "pm", "o2", "o3", "v_", "a_", "F")
MOMENTS = ("M",)


def power(label: str) -> int:
    """The power of length in a column; forces are mass * length / time^2."""
    if label.startswith(MOMENTS):
        return 2
    return 1 if label.startswith(LENGTHS) else 0


@cache
def cells(factor: float) -> dict[tuple[str, str], np.ndarray]:
    analysis = mk.loads(scaled(factor)).analyze()
    assert not analysis.result.status.any()
    assert np.all(analysis["row.residual"] <= 1e-14)
    assert np.all(analysis["row.power_error"] <= 1e-12)
    return {(t.name, c.label): c.values for t in analysis.tables for c in t.columns}


@pytest.mark.parametrize("decade", range(-6, 7))
def test_errors_do_not_depend_on_the_size(decade):
    """Against 40 digits, with the limits of the mechanism in its own inches."""
    factor = 10.0**decade
    found = cells(factor)
    for table, label in COLUMNS:
        load = table in LOADS
        expected = exact_values(f"ne_{label}" if load else label) * factor ** power(label)
        error = np.abs(found[table, label] - expected).max()
        assert error <= (1e-13 if load else 2e-14) * np.abs(expected).max(), label


@pytest.mark.parametrize("binary", [-20, -7, -1, 1, 10, 20])
def test_powers_of_two_change_no_digit(binary):
    """Scaling by a power of two is exact, and so is everything that follows."""
    factor = 2.0**binary
    found, one = cells(factor), cells(1.0)
    for table, label in COLUMNS:
        wanted = one[table, label] * factor ** power(label)
        assert np.array_equal(found[table, label], wanted), label
