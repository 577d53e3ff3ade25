"""Bounds of errors over a few mechanisms of each family; the command takes many."""

from __future__ import annotations

import os

import numpy as np
import pytest
from random_families.error_bound import closed
from random_families.error_bound.__main__ import together
from random_families.error_bound.case import FAMILIES, rows_of

from mechkin_cli.verdict import Status

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
MECHANISMS = 3 * len(FAMILIES) * TIMES


def test_bounds_are_true_and_close():
    rows = together([rows_of(number) for number in range(MECHANISMS)])
    assert rows.error.size > 500
    known = np.isfinite(rows.bound)
    assert known.mean() > 0.99
    error, bound = rows.error[known], rows.bound[known]
    assert (error <= bound).all()
    assert np.median(bound / np.maximum(error, 1e-18)) < 30.0


@pytest.mark.parametrize("family", range(len(closed.FAMILIES)), ids=closed.FAMILIES)
def test_bounds_hold_against_roots_at_60_digits(family: int):
    numbers = range(family, 12 * len(closed.FAMILIES) * TIMES, len(closed.FAMILIES))
    rows = [
        row
        for number in numbers
        for row in closed.rows_of(closed.drawn(number), closed.turn_of(number, 12))
    ]
    assert len(rows) > 30
    assert all(row.error <= row.bound for row in rows)


def test_bounds_hold_down_to_a_dead_centre():
    """Or there is none: where doubles do not tell which of two positions is meant, and where
    rounding is as large as their distance."""
    rows = []
    for number in range(60 * TIMES):
        loop = closed.drawn(number)
        places = closed.toward_dead_centre(loop)
        rows += closed.rows_of(loop, places) if places else []
    known = [row for row in rows if np.isfinite(row.bound)]
    assert all(row.error <= row.bound for row in known)
    assert all(np.isfinite(row.bound) for row in rows if row.condition < 1e6)
    assert any(row.condition > 1e6 for row in known)
    assert any(row.status == Status.dead_centre for row in rows)
