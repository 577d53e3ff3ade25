"""Equally spaced values of a sweep, each the double nearest to the decimal number meant.

x_i = from + i*step in decimals: 0, 0.1, 0.2, 0.3 and not 0.30000000000000004. The numbers written
are fractions over one power of ten, so x_i is a quotient of two whole numbers that doubles hold
exactly, and a single division rounds it. Numbers with too many digits for that (results of
expressions) are added as doubles.
"""

from __future__ import annotations

from decimal import Decimal

import numpy as np

from mechkin_cli.arrays import Floats

EXACT = 2**53
"""Whole numbers up to this one are doubles."""


def by_step(first: float, step: float, count: int) -> Floats:
    """The values first + i*step, shape (count,)."""
    (start, stride), power = _whole_numbers(first, step)
    numerators = _exact(start, stride, count)
    if numerators is None or power > EXACT:
        return np.asarray(first + np.arange(count) * step, dtype=np.float64)
    return numerators / float(power)


def by_count(first: float, last: float, count: int) -> Floats:
    """`count` values from `first` to `last`, both included; one value is `first`."""
    if count == 1:
        return np.array([first])
    (start, end), power = _whole_numbers(first, last)
    gaps = count - 1
    numerators = _exact(start * gaps, end - start, count)
    if numerators is None or power * gaps > EXACT:
        values = np.asarray(first + np.arange(count) * (last / gaps - first / gaps), dtype=float)
        values[-1] = last
        return values
    return numerators / float(power * gaps)


def _whole_numbers(*values: float) -> tuple[tuple[int, ...], int]:
    """Whole numbers and the power of ten over which they are the values' shortest decimals."""
    decimals = [Decimal(repr(float(value))) for value in values]
    exponents = [int(number.as_tuple().exponent) for number in decimals]
    power = 10 ** max(0, *(-exponent for exponent in exponents))
    return tuple(int(number * power) for number in decimals), power


def _exact(start: int, stride: int, count: int) -> Floats | None:
    """start + i*stride as doubles; None where one of them is no exact double."""
    if max(abs(start), abs(stride), abs(start + (count - 1) * stride)) > EXACT:
        return None
    return np.asarray(start + np.arange(count, dtype=np.int64) * stride, dtype=np.float64)
