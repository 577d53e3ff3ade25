"""Random expressions with choices, comparisons and steps: rows of doubles, recorded programs and
double-double numbers against Python's eval in mpmath."""

from __future__ import annotations

import os
import random

import numpy as np
import pytest
from expressions.random_expressions import NAMES, number, value, written
from mpmath import mp

from mechkin_cli.expressions.expression import exact_literal, parse
from mechkin_cli.expressions.quantity import ExpressionError, Quantity, lookup
from mechkin_cli.tape.double_double import DoubleDoubles, exactly
from mechkin_cli.tape.recorder import register
from mechkin_cli.tape.row_programs import RowRecorder
from mechkin_cli.tape.tape import Operation, Tape, evaluate

COUNT = 40 * int(os.environ.get("MECHKIN_RANDOM", "5"))
ROWS = {name: Quantity(np.array(rows)) for name, rows in NAMES.items()}
WIDE = {name: Quantity(DoubleDoubles(np.array(rows))) for name, rows in NAMES.items()}  # type: ignore[arg-type]


def replayed(text: str) -> list[float]:
    """The values of a recorded program in its rows."""
    recorder = RowRecorder(len(NAMES))
    numbers = {name: Quantity(recorder.number(k)) for k, name in enumerate(NAMES)}  # type: ignore[arg-type]
    found = register(recorder, parse(written(text)).evaluate(lookup(numbers)).value)
    constants, operations, operands, outputs, _ = recorder.listed([found], [])
    none = np.zeros(0, dtype=np.bool_)
    tape = Tape(
        tuple(NAMES),
        np.array(constants),
        np.array(operations, dtype=np.uint8),
        np.array(operands, dtype=np.int32).reshape(-1, 3),
        np.array(outputs, dtype=np.int32),
        np.zeros((0, 3), dtype=np.int32),
        none,
        none,
    )
    return [evaluate(tape, row)[0][0] for row in zip(*NAMES.values(), strict=True)]


def texts(count: int, seed: int) -> list[str]:
    draw = random.Random(seed)
    found = [number(draw, draw.randint(1, 4)) for _ in range(count)]
    return [text for text in found if any(name in text for name in NAMES)]


def test_all_arithmetics_agree_with_python() -> None:
    followed = 0
    with mp.workdps(45):
        for text in texts(COUNT, 20261):
            expected = [value(text, row) for row in range(3)]
            if any(one is None for one in expected):
                continue
            try:
                found = parse(written(text)).evaluate(lookup(ROWS)).value
            except ExpressionError:
                continue  # a constant that no row needs has no value
            wide = parse(written(text)).evaluate(lookup(WIDE), literal=exact_literal).value
            followed += 1
            rows = np.broadcast_to(np.asarray(found, dtype=np.float64), (3,))
            np.testing.assert_array_equal(replayed(text), rows, err_msg=text)
            both = exactly(wide)
            high, low = (np.broadcast_to(part, (3,)) for part in (both.high, both.low))
            for k, one in enumerate(expected):
                assert abs(mp.mpf(high[k]) + mp.mpf(low[k]) - one) < mp.mpf("1e-18"), text
    assert followed > COUNT // 8


def test_a_step_is_told_where_it_is_taken() -> None:
    """Choices by the sign of a difference leave exactly one place to find for each comparison."""
    recorder = RowRecorder(1)
    x = Quantity(recorder.number(0))  # type: ignore[arg-type]
    parse("if(x > 1, sinh(x), tanh(x) + asinh(x))").evaluate({"x": x}.__getitem__)
    written_down = [instruction[0] for instruction in recorder.instructions]
    assert written_down.count(Operation.SIGN) == 1
    assert Operation.MAGNITUDE not in written_down


WITHOUT_VALUE = [
    "1/(n - 1)",
    "log(n - 1)",
    "(n - 1)^(-2)",
    "pow(n - 1, -0.5)",
    "exp(1e5*n)",
    "mod(y, n - 1)",
]
WRAPPINGS = [
    *("{}", "atan({})/(1 rad)", "exp(-abs({}))", "min({}, 3)", "max(3, {})", "clip({}, 1, 2)"),
    *("1/({})", "tanh({})", "sign({})", "atan2(1, {})/(1 rad)", "if({} > 2, 1, 0)", "abs({})"),
    *("angle_between([{}, 0], [1, x])/(1 rad)",),
    *("hypot({}, 1)", "norm([1, {}, 0])", "1/cosh({})", "({})^(-1)", "x/({})", "[{}, x, y].x"),
]


@pytest.mark.parametrize("inner", WITHOUT_VALUE)
def test_nothing_makes_a_number_of_what_has_no_value(inner: str) -> None:
    """Rows in which a part of an expression has no value have none of it, as mpmath has it."""
    for text in (wrapping.format(inner) for wrapping in WRAPPINGS):
        for whole in (text, f"2 - {text}", f"atan({text})/(1 rad) + x"):
            found = np.broadcast_to(parse(whole).evaluate(lookup(ROWS)).value, (3,))
            bare = np.broadcast_to(parse(inner).evaluate(lookup(ROWS)).value, (3,))
            assert np.isnan(bare).any()
            assert np.isnan(found[np.isnan(bare)]).all(), whole
            for row in np.flatnonzero(np.isfinite(bare)):
                alone = {name: Quantity(np.array(v[row : row + 1])) for name, v in NAMES.items()}
                one = np.asarray(parse(whole).evaluate(lookup(alone)).value)
                np.testing.assert_array_equal(np.ravel(one)[0], found[row], err_msg=whole)


def test_where_mpmath_has_no_value_rows_have_none() -> None:
    """A division by zero anywhere in what is computed leaves the row empty."""
    draw, seen = random.Random(8), 0
    names = {name: [mp.mpf(v) for v in rows] for name, rows in NAMES.items()}
    for _ in range(20 * COUNT):
        divisor = draw.choice(["n - 1", "n - 2", "x - 2", "y + 3", "n*y - 0.25", "x*y"])
        text = f"{draw.choice(['1', 'x', '-n'])}/({divisor})"
        for _ in range(draw.randint(0, 3)):
            text = draw.choice(WRAPPINGS[1:12]).format(text)
        found = np.broadcast_to(parse(text).evaluate(lookup(ROWS)).value, (3,))
        for row in range(3):
            at = {name: rows[row] for name, rows in names.items()}
            if eval(divisor, {"__builtins__": {}}, at) == 0:
                seen += 1
                assert np.isnan(found[row]), text
    assert seen > COUNT


def test_a_zero_vector_has_no_direction() -> None:
    rows = {
        "a": Quantity(np.array([0.0, 3.0, 0.0, 1.0])),
        "b": Quantity(np.array([2.0, 0.0, 0, 1])),
    }
    for text in ("angle_between([a, 0], [b, b])", "angle_between([b, b, b], [0, 0, a])"):
        found = np.asarray(parse(text).evaluate(lookup(rows)).value)
        assert np.isnan(found).tolist() == [True, True, True, False]
    assert found[3] == pytest.approx(float(mp.acos(1 / mp.sqrt(3))), rel=1e-15)
    for text in ("angle_between([0, 0], [a, b])", "angle_between([a, b], [0, 0])"):
        with pytest.raises(ExpressionError, match="zero vector, which has no direction"):
            parse(text).evaluate(lookup(rows))
