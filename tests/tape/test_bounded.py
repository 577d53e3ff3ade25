"""Bounds of what double-double knows: the true number lies inside, and they are not idle."""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Any

import mpmath
import numpy as np
import pytest

from mechkin_cli.tape.double_double import Bounded, DoubleDoubles, bounded

OPERATIONS = ["+", "-", "*", "/", "abs", "sqrt", "sin", "cos", "exp", "atan", "max", "min"]
DIGITS = 700
"""Beyond the exponents of doubles, so that neither cancellation nor underflow is lost."""


def distance(found: Bounded, true: mpmath.mpf) -> mpmath.mpf:
    return abs(mpmath.mpf(float(found.value.high)) + mpmath.mpf(float(found.value.low)) - true)


def grown(draw: Random, depth: int) -> tuple[Any, mpmath.mpf]:
    """A random expression of doubles: bounded, and at many digits."""
    if depth == 0:
        number = draw.uniform(-2.0, 2.0) * 10.0 ** draw.choice([0, 0, 0, 3, -3, 40, -40, 150, -170])
        return bounded(np.array(number)), mpmath.mpf(number)
    operation = draw.choice(OPERATIONS)
    one, first = grown(draw, depth - 1)
    if operation == "abs":
        return abs(one), abs(first)
    if operation == "sqrt":
        return abs(one).apply("SQUARE_ROOT"), mpmath.sqrt(abs(first))
    if operation in ("sin", "cos", "atan"):
        return one.apply(operation.upper()), getattr(mpmath, operation)(first)
    if operation == "exp":
        kept = one.apply("SMALLER", 5.0)
        return kept.apply("EXP"), mpmath.exp(min(first, mpmath.mpf(5)))
    other, second = grown(draw, draw.randrange(depth))
    if operation in ("max", "min"):
        name, chosen = ("LARGER", max) if operation == "max" else ("SMALLER", min)
        return one.apply(name, other), chosen(first, second)
    if operation == "/" and second == 0:
        return one, first
    return {
        "+": lambda: (one + other, first + second),
        "-": lambda: (one - other, first - second),
        "*": lambda: (one * other, first * second),
        "/": lambda: (one / other, first / second),
    }[operation]()


def test_random_expressions_lie_within_their_bounds() -> None:
    draw, tight = Random(20), 0
    with mpmath.workdps(DIGITS), np.errstate(all="ignore"):
        for number in range(3000):
            found, true = grown(draw, draw.randint(1, 5))
            if not np.isfinite(found.value.high) or not np.isfinite(found.bound):
                continue
            assert distance(found, true) <= mpmath.mpf(float(found.bound)), number
            tight += float(found.bound) <= 1e-20 * abs(float(true))
    assert tight > 1500


@pytest.mark.parametrize("large", [1e33, 1e36, 1e60])
def test_what_a_sum_swallows_is_in_its_bound(large: float) -> None:
    small = bounded(np.array(0.7))
    left = (small + large) - large
    assert left.bound >= abs(0.7 - float(left.value.high))
    assert (small + 1e3 - 1e3).bound < 1e-26


def test_what_is_below_the_smallest_number_is_in_its_bound() -> None:
    number = bounded(np.array(0.7))
    back = number * 1e-300 * 1e-20 * 1e300 * 1e20
    assert back.bound >= abs(0.7 - float(back.value.high)) > 1e-5
    root = (number * 1e-200 * (number * 1e-200)).apply("SQUARE_ROOT") * 1e200
    assert root.bound >= 0.7


def test_numbers_that_cancel_exactly_are_known_exactly() -> None:
    third = bounded(DoubleDoubles.of_fraction(Fraction(1, 3)))
    for zero in (third - third, third * 0.0, 0.0 / third):
        assert (zero.value.high, zero.bound) == (0.0, 0.0)


def test_whole_numbers_and_signs_are_known_away_from_their_steps() -> None:
    third = bounded(np.array(1.0)) / 3.0
    assert (third.apply("SIGN").bound, third.apply("WHOLE").bound) == (0.0, 0.0)
    almost_zero = third * 3.0 - 1.0
    assert almost_zero.apply("SIGN").bound == 2.0
    assert (third * 1.5).apply("WHOLE").bound >= 1.0
