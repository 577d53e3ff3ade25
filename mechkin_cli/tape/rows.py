"""Rows of numbers of which some may be recorded: those stand in arrays of objects."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.tape.scalars import Recorded

_OBJECTS = np.dtype(object)


def is_traced(values: Any) -> bool:
    """Whether some of the numbers are recorded."""
    return isinstance(values, Recorded) or getattr(values, "dtype", None) is _OBJECTS


def of_numbers(values: Iterable[Any]) -> Floats:
    """A row of numbers."""
    return np.array(list(values))


def with_rates(values: Floats, rates: Iterable[Any]) -> Floats:
    """Values in a first row, constants in the rows below (1 + rates, values)."""
    return np.stack([values, *(np.full(values.size, rate) for rate in rates)])


def within(values: Floats, limit: float) -> bool:
    """Whether no number is larger than a limit, or nan."""
    if is_traced(values):
        return all(bool(abs(value) <= limit) for value in values.flat)
    return bool(np.abs(values).max() <= limit)


def differ(values: Floats) -> bool:
    """Whether the numbers are not all the same."""
    if is_traced(values):
        return any(bool(value != values[0]) for value in values.flat)
    return bool((values != values[0]).any())
