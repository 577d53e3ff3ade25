"""Random expressions with choices, comparisons and steps: rows of doubles, recorded programs and
double-double numbers against Python's eval in mpmath."""

from __future__ import annotations

import os
import random

import numpy as np
from expressions.random_expressions import NAMES, number, value, written
from mpmath import mp

from mechkin_cli.expressions import ExpressionError, Quantity, lookup, parse
from mechkin_cli.expressions.exact_literal import exact_literal
from mechkin_cli.tape.double_doubles import DoubleDoubles, exactly
from mechkin_cli.tape.evaluate import evaluate
from mechkin_cli.tape.operations import Operation
from mechkin_cli.tape.row_numbers import RowRecorder
from mechkin_cli.tape.tape import Tape
from mechkin_cli.tape.traced import register

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
    return [evaluate(tape, row).outputs[0] for row in zip(*NAMES.values(), strict=True)]


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
