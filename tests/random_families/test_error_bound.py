"""Bounds of errors over a few mechanisms of each family; the command takes many."""

from __future__ import annotations

import os

import numpy as np
from random_families.error_bound.__main__ import together
from random_families.error_bound.case import FAMILIES, rows_of

MECHANISMS = 5 * len(FAMILIES) * int(os.environ.get("MECHKIN_RANDOM", "1"))


def test_bounds_are_true_and_close():
    rows = together([rows_of(number) for number in range(MECHANISMS)])
    assert rows.error.size > 500
    known = np.isfinite(rows.bound)
    assert known.mean() > 0.99
    error, bound = rows.error[known], rows.bound[known]
    assert np.count_nonzero(error > bound) <= 1e-3 * error.size
    assert np.median(bound / np.maximum(error, 1e-18)) < 100.0
