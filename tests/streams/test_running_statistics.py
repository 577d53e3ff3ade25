"""Sums of a column that comes block by block are those of the whole column, bit for bit."""

from __future__ import annotations

import os

import numpy as np
import pytest

from mechkin_cli.tables import REDUCTIONS, RunningStatistics, statistics
from mechkin_cli.units import DIMENSIONLESS, UnitSystem

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))


class Source:
    """As much of a run as `statistics` reads."""

    units = UnitSystem()

    def __init__(self, places: np.ndarray) -> None:
        self.rows = places.size
        self.inputs = {"A.theta": places}

    def quantity(self, name: str) -> object:
        class Quantity:
            dimension = DIMENSIONLESS

        return Quantity


@pytest.mark.parametrize("seed", range(400 * TIMES))
def test_blocks_add_up_to_the_whole(seed: int) -> None:
    random = np.random.default_rng(seed)
    rows = int(random.integers(1, 60))
    values = random.normal(size=rows) * 10.0 ** random.integers(-9, 9, rows)
    if seed % 10 == 0:
        values *= 10.0 ** float(random.choice([-160, 140]))
    if seed % 3 == 0:
        values[random.random(rows) < 0.3] = np.nan
    if seed % 5 == 0:
        values[random.random(rows) < 0.1] = random.choice([-np.inf, np.inf])
    if seed % 7 == 0:
        values = np.sign(values)
    moves = seed % 4 != 0
    places = np.cumsum(random.random(rows) * (random.random(rows) < 0.8))
    source = Source(places if moves else np.zeros(rows))
    moves = bool((source.inputs["A.theta"] != source.inputs["A.theta"][0]).any())
    with np.errstate(all="ignore"):
        expected = statistics(values, source)  # type: ignore[arg-type]
        sums = RunningStatistics(REDUCTIONS, moves=moves)
        at = places if moves else np.arange(1.0, rows + 1)
        first = 0
        while first < rows:
            last = first + int(random.integers(1, 12))
            sums.add(values[first:last], at[first:last])
            first = last
        found = sums.found()
    assert repr(found) == repr(expected)


def test_only_what_is_asked_for_is_found() -> None:
    sums = RunningStatistics(["max"], moves=True)
    sums.add(np.array([1.0, 3.0, np.nan]), np.array([0.0, 1.0, 2.0]))
    found = sums.found()
    assert (found.max.value, found.max.place, found.rows) == (3.0, 1.0, 2)
    assert np.isnan([found.min.value, found.mean, found.rms, found.range]).all()
