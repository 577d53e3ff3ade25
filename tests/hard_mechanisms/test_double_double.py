"""Double-double rows against mpmath at 50 digits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from mpmath import mp, mpf

from benchmarks.stress.numbers.double_double import DoubleDouble

ROWS = 100
RELATIVE, ABSOLUTE = 1e-30, 1e-30


def drawn(seed: int, low: float, high: float, powers: int = 0) -> DoubleDouble:
    rng = np.random.default_rng(seed)
    values = rng.uniform(low, high, ROWS) * 10.0 ** rng.integers(-powers, powers + 1, ROWS)
    return DoubleDouble(values) + values * rng.uniform(-1e-17, 1e-17, ROWS)


def exact(rows: DoubleDouble) -> list[mpf]:
    return [mpf(float(h)) + mpf(float(low)) for h, low in zip(rows.high, rows.low, strict=True)]


X, Y = drawn(1, -9, 9, 8), drawn(2, -9, 9, 8)
POSITIVE, SMALL = drawn(3, 0.1, 9, 8), drawn(4, -40, 1)


@pytest.mark.parametrize(
    ("found", "wanted", "limit"),
    [
        (X + Y, lambda x, y: x + y, RELATIVE),
        (X - Y, lambda x, y: x - y, RELATIVE),
        (X * Y, lambda x, y: x * y, RELATIVE),
        (X / Y, lambda x, y: x / y, RELATIVE),
        (X.arctan2(Y), mp.atan2, RELATIVE),
        (X.sin_cos()[0], lambda x, _: mp.sin(x), ABSOLUTE),
        (X.sin_cos()[1], lambda x, _: mp.cos(x), ABSOLUTE),
    ],
)
def test_operations(found: DoubleDouble, wanted: Callable[[mpf, mpf], mpf], limit: float) -> None:
    with mp.workdps(60):
        for z, x, y in zip(exact(found), exact(X), exact(Y), strict=True):
            right = wanted(x, y)
            assert abs(z - right) <= limit * (abs(right) if limit is RELATIVE else 1)


def test_roots_and_exponentials() -> None:
    with mp.workdps(60):
        for z, x in zip(exact(POSITIVE.sqrt()), exact(POSITIVE), strict=True):
            assert abs(z - mp.sqrt(x)) <= RELATIVE * z
        for z, x in zip(exact(SMALL.exp()), exact(SMALL), strict=True):
            assert abs(z - mp.exp(x)) <= 1e-29 * z


def test_sums_that_cancel_keep_their_digits() -> None:
    one = DoubleDouble(np.array([1.0]))
    tiny = one + 1e-25 - one
    assert abs(tiny.high[0] - 1e-25) <= 1e-32


def test_the_root_of_nothing_and_the_angle_of_nothing_are_zero() -> None:
    none = DoubleDouble(np.array([0.0, -1.0]))
    assert none.sqrt().high.tolist() == [0.0, 0.0]
    assert (none * 0.0).arctan2(none * 0.0).high.tolist() == [0.0, 0.0]
