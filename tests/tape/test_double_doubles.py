"""Double-double numbers against exact fractions."""

from __future__ import annotations

import operator
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from mpmath import MPContext

from mechkin_cli.tape.double_double import DoubleDoubles, difference, exactly

mp = MPContext()
mp.dps = 60
ROUNDING = 2.0**-106
COUNT = 300


def some(seed: int) -> DoubleDoubles:
    rng = np.random.default_rng(seed)
    high = rng.normal(size=COUNT) * 10.0 ** rng.integers(-8, 8, COUNT)
    return DoubleDoubles(high, high * rng.uniform(-1, 1, COUNT) * 2.0**-54)


def numbers(values: Any) -> list[Fraction]:
    given = exactly(values)
    pairs = zip(given.high.tolist(), given.low.tolist(), strict=True)
    return [Fraction(high) + Fraction(low) for high, low in pairs]


OPERATIONS = {
    operator.add: 4,
    operator.sub: 4,
    operator.mul: 6,
    operator.truediv: 16,
}
"""With the largest errors, in roundings of 106 bits."""


@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda f: f.__name__)
def test_arithmetic(operation: Callable[[Any, Any], Any]) -> None:
    a, b = some(1), some(2)
    for found, x, y in zip(numbers(operation(a, b)), numbers(a), numbers(b), strict=True):
        exact = operation(x, y)
        assert abs(found - exact) <= OPERATIONS[operation] * ROUNDING * abs(exact)


def test_sums_that_cancel_are_as_good() -> None:
    """What is bounded only where signs agree loses everything here."""
    a = some(3)
    b = DoubleDoubles(-a.high, some(4).low * 1e-8)
    for found, x, y in zip(numbers(a + b), numbers(a), numbers(b), strict=True):
        assert abs(found - (x + y)) <= 4 * ROUNDING * abs(x + y)


def test_roots() -> None:
    a = abs(some(5))
    for found, x in zip(numbers(np.sqrt(a)), numbers(a), strict=True):
        exact = mp.sqrt(mp.mpf(x.numerator) / x.denominator)
        own = mp.mpf(found.numerator) / found.denominator
        assert abs(own - exact) <= 6 * ROUNDING * exact


def test_floats_and_arrays_take_part_exactly() -> None:
    a = some(6)
    rows = np.linspace(-1.0, 1.0, COUNT)
    for found in (0.1 * a, a * 0.1, exactly(0.1) * a):
        assert numbers(found) == numbers(a * np.full(COUNT, 0.1))
    assert isinstance(rows + a, DoubleDoubles)
    assert numbers(rows - a) == numbers(-(a - rows))
    assert numbers(2.0 * a) == [2 * x for x in numbers(a)]


def test_infinities_and_nan_stay_what_they_are() -> None:
    a = DoubleDoubles([np.inf, np.nan, 1.0, 0.0])
    assert np.array_equal((a + 1.0).high, [np.inf, np.nan, 2.0, 1.0], equal_nan=True)
    assert np.array_equal((1.0 / a).high, [0.0, np.nan, 1.0, np.inf], equal_nan=True)
    assert (a + 1.0).low.tolist() == [0.0] * 4


def test_comparisons_see_the_low_part() -> None:
    a, b = DoubleDoubles([1.0], [1e-20]), DoubleDoubles([1.0])
    assert bool(a > b)
    assert bool(b < a)
    assert not bool(a == b)
    assert numbers((a > b).choose(a, b)) == numbers(a)
    assert numbers(np.where(a > b, b, a)) == numbers(b)


def test_code_for_arrays_runs_on_them() -> None:
    """Stacked, read and written in parts."""
    a, b = some(7), some(8)
    both = np.stack([a, b])
    assert numbers(both[1]) == numbers(b)
    both[0][:5] = np.nan
    assert np.isnan(both.high[0, :5]).all()
    assert not np.isnan(both.high[0, 5:]).any()


@pytest.mark.parametrize(
    "code", [np.sin, np.cumsum, np.asarray, lambda a: np.hypot(a, a), float, np.mean]
)
def test_what_would_round_is_refused(code: Callable[[Any], Any]) -> None:
    with pytest.raises(TypeError):
        code(some(9))


def test_fractions() -> None:
    third = DoubleDoubles.of_fraction(Fraction(1, 3))
    assert abs(Fraction(float(third.high)) + Fraction(float(third.low)) - Fraction(1, 3)) < 1e-32


def test_differences_of_equal_numbers_keep_their_digits() -> None:
    true = DoubleDoubles([1.0], [1e-17])
    assert difference(np.array([1.0]), true).tolist() == [-1e-17]


def test_whole_numbers() -> None:
    a = DoubleDoubles([2.5, 2.5, 3.0, -0.5, 4.2], [1e-17, -1e-17, 0.0, 1e-18, 0.0])
    assert a.apply("WHOLE").high.tolist() == [3.0, 2.0, 3.0, 0.0, 4.0]


FUNCTIONS = {
    "SIN": mp.sin,
    "COS": mp.cos,
    "TAN": mp.tan,
    "ATAN": mp.atan,
    "ASIN": mp.asin,
    "ACOS": mp.acos,
    "EXP": mp.exp,
    "LOG": mp.log,
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_those_of_the_kernel(name: str) -> None:
    rng = np.random.default_rng(11)
    a = DoubleDoubles(rng.uniform(0.05, 0.95, COUNT), rng.uniform(-1, 1, COUNT) * 1e-18)
    for found, x in zip(numbers(a.apply(name)), numbers(a), strict=True):
        exact = FUNCTIONS[name](mp.mpf(x.numerator) / x.denominator)
        assert abs(mp.mpf(found.numerator) / found.denominator - exact) <= 1e-29 * abs(exact)


def test_angles_of_points() -> None:
    y, x = some(12), some(13)
    found = np.where(y > 0.0, y, -y).apply("ATAN2", x)
    for angle, b, a in zip(numbers(found), numbers(y), numbers(x), strict=True):
        exact = mp.atan2(
            abs(mp.mpf(b.numerator) / b.denominator), mp.mpf(a.numerator) / a.denominator
        )
        assert abs(mp.mpf(angle.numerator) / angle.denominator - exact) <= 1e-29 * exact
