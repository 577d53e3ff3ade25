"""Double-double against mpmath; larger sets by `python -P tests/kernel/double_double.py`."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest
from kernel.double_double import DIGITS, TRUE, Arguments, compute, exact, pair, worst

from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.functions import widths
from mechkin_cli.tape.tape import Operation, replay_precise


@pytest.mark.parametrize("operation", TRUE)
def test_errors_are_those_that_are_promised(operation: Operation) -> None:
    arguments = Arguments(1)
    with mp.workdps(DIGITS):
        assert worst(operation, [arguments.of(operation) for _ in range(150)]) <= 1


@pytest.mark.parametrize("operation", TRUE)
def test_a_lost_low_part_is_seen(operation: Operation) -> None:
    # arguments for which the result depends on their last digits
    with mp.workdps(DIGITS):
        x, y = pair(mp.mpf(2) / 3), pair(mp.mpf(5) / 7)
        known = TRUE[operation](exact(x), exact(y))
        found = compute(operation, [(x[0], 0.0)], [y])[0]
        assert abs(exact(found) / known - 1) > 1e-18


@pytest.mark.parametrize("operation", TRUE)
def test_every_width_has_the_same_bits(operation: Operation) -> None:
    # an odd count, so that a pack is not full; units with and without a fused multiply-add
    arguments = Arguments(2)
    with mp.workdps(DIGITS):
        cases = [arguments.of(operation) for _ in range(397)]
    first, second = [x for x, _ in cases], [y for _, y in cases]
    bits = {compute(operation, first, second, lanes).tobytes() for lanes in widths()}
    split = [compute(operation, first[a:b], second[a:b]) for a, b in ((0, 5), (5, 397))]
    assert bits == {np.concatenate(split).tobytes()}


def test_products_are_the_same_up_to_the_limits_that_are_stated() -> None:
    arguments = Arguments(3)
    sizes = [(x, y) for x in (-290, -145, 0, 145, 298) for y in (-290, -145, 0, 145, 298)]
    cases = [
        (arguments.pair(x, x + 1), arguments.pair(y, y + 1))
        for x, y in sizes
        if -290 <= x + y <= 298
    ]
    first, second = [x for x, _ in cases], [y for _, y in cases]
    found = {lanes: compute(Operation.MULTIPLY, first, second, lanes) for lanes in widths()}
    assert len({bits.tobytes() for bits in found.values()}) == 1
    for x, y, product in zip(first, second, found[2], strict=True):
        assert abs(exact(product) / (exact(x) * exact(y)) - 1) < 1e-31


def test_special_values() -> None:
    infinity, one, zero = (math.inf, 0.0), (1.0, 0.0), (0.0, 0.0)

    def value(operation: Operation, x: tuple[float, float], y: tuple[float, float] = zero) -> float:
        high, low = compute(operation, [x], [y])[0]
        assert abs(low) <= abs(high) * 2.0**-53 or not math.isfinite(high)
        return float(high)

    assert value(Operation.DIVIDE, one, zero) == math.inf
    assert value(Operation.DIVIDE, one, infinity) == 0.0
    assert math.isnan(value(Operation.DIVIDE, zero, zero))
    assert value(Operation.SQUARE_ROOT, zero) == 0.0
    assert value(Operation.SQUARE_ROOT, infinity) == math.inf
    assert math.isnan(value(Operation.SQUARE_ROOT, (-1.0, 0.0)))
    assert value(Operation.EXP, (1000.0, 0.0)) == math.inf
    assert value(Operation.EXP, (-1000.0, 0.0)) == 0.0
    assert value(Operation.EXP, zero) == 1.0
    assert value(Operation.LOG, zero) == -math.inf
    assert value(Operation.LOG, one) == 0.0
    assert math.isnan(value(Operation.LOG, (-1.0, 0.0)))
    assert math.isnan(value(Operation.ASIN, (1.0, 1e-20)))
    assert value(Operation.ACOS, one) == 0.0
    assert value(Operation.POWER, (-2.0, 0.0), (3.0, 0.0)) == -8.0
    assert math.isnan(value(Operation.POWER, (-2.0, 0.0), (3.0, 1e-20)))
    assert value(Operation.POWER, zero, zero) == 1.0
    assert value(Operation.ATAN2, zero, one) == 0.0


def test_constants_of_an_angle_have_full_length() -> None:
    zero, one = (0.0, 0.0), (1.0, 0.0)
    with mp.workdps(60):
        half_turn = compute(Operation.ATAN2, [zero], [(-1.0, 0.0)])[0]
        assert abs(exact(half_turn) / mp.pi - 1) < 1e-31
        assert abs(exact(compute(Operation.ACOS, [zero], [zero])[0]) / (mp.pi / 2) - 1) < 1e-31
        assert abs(exact(compute(Operation.EXP, [one], [zero])[0]) / mp.e - 1) < 1e-31


@pytest.mark.parametrize(
    ("given", "whole"),
    [
        ((2.5, 0.0), 2.0),
        ((2.5, 1e-17), 3.0),
        ((3.5, -1e-17), 3.0),
        ((-2.5, -1e-17), -3.0),
        ((0.4999, 0.0), 0.0),
        ((1e10 + 0.5, 1e-8), 1e10 + 1),
    ],
)
def test_whole_numbers_see_both_parts(given: tuple[float, float], whole: float) -> None:
    assert compute(Operation.WHOLE, [given], [(0.0, 0.0)])[0].tolist() == [whole, 0.0]


def test_comparisons_see_both_parts() -> None:
    larger, smaller = (1.0, 1e-20), (1.0, -1e-20)
    assert compute(Operation.LARGER, [smaller], [larger])[0].tolist() == list(larger)
    assert compute(Operation.SMALLER, [smaller], [larger])[0].tolist() == list(smaller)
    assert compute(Operation.LESS, [smaller], [larger])[0, 0] == 1.0
    assert compute(Operation.EQUAL, [smaller], [larger])[0, 0] == 0.0
    assert compute(Operation.SIGN, [(0.0, 0.0)], [larger])[0, 0] == 0.0
    assert compute(Operation.MAGNITUDE, [(-1.0, 1e-20)], [larger])[0].tolist() == [1.0, -1e-20]


def test_constants_of_a_tape_have_a_second_part() -> None:
    nothing = np.empty(0, np.uint8)
    tape = _kernel.Tape(
        1,
        np.array([0.1]),
        np.array([Operation.MULTIPLY], np.uint8),
        np.array([[0, 1, 1]], np.int32),
        np.array([2], np.int32),
        np.empty((0, 3), np.int32),
        nothing,
        nothing,
    )
    given = np.array([[[3.0], [0.0]]])
    with mp.workdps(60):
        tenth = pair(mp.mpf(1) / 10)
        found = exact(replay_precise(tape, given, np.array([tenth[1]]))[0][0, 0])
        assert abs(found / (mp.mpf(3) / 10) - 1) < 1e-31
        assert abs(exact(replay_precise(tape, given)[0][0, 0]) / (mp.mpf(3) / 10) - 1) > 1e-18
    with pytest.raises(ValueError, match="one low part for each constant"):
        replay_precise(tape, given, np.zeros(2))
    with pytest.raises(ValueError, match="two rows of numbers"):
        replay_precise(tape, np.zeros((1, 1, 1)))
