"""Inputs of all families as series in time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.stress.linkages.writing import ACCELERATION, RATE
from benchmarks.stress.numbers.double_double import DoubleDouble, radians
from benchmarks.stress.numbers.series import Number, Series
from benchmarks.stress.numbers.vectors import Vector
from benchmarks.stress.quantity import Rows

Field = Callable[[Rows], Number]
"""Makes numbers of exact doubles: `DoubleDouble`, or a test's numbers of 40 digits."""


def turning(degrees: Rows | DoubleDouble) -> Series:
    """Angles (mechanisms, rows) in degrees, in rad with the rates that the files write."""
    return constant_rates(radians(degrees))


def constant_rates(value: DoubleDouble) -> Series:
    """A coordinate with the rates that the files write."""
    ones = np.ones_like(value.high)
    return Series(value, DoubleDouble(RATE * ones), DoubleDouble(ACCELERATION * ones))


def vector(field: Field, components: Rows) -> Vector:
    """Of (mechanisms, 3), numbers of shape (mechanisms, 1) each."""
    x, y, z = (field(components[:, k : k + 1]) for k in range(3))
    return x, y, z
