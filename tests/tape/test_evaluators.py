"""All evaluators have the same bits: floats in Python, and the kernel in every width of lanes."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings, strategies as st

from mechkin_cli.kernel.functions import widths
from mechkin_cli.tape import scalars
from mechkin_cli.tape.recorder import Recorder, Traced
from mechkin_cli.tape.tape import (
    ARITY,
    CONDITIONS,
    Operation,
    Tape,
    Verdict,
    compiled,
    evaluate,
    replay,
)

INPUTS = 3
NUMBERS = st.floats(allow_nan=False) | st.floats(-10.0, 10.0)


@st.composite
def programs(draw: st.DrawFn) -> Tape:
    """Random instructions on three inputs, every register an output, some guards."""
    recorder = Recorder(["a", "b", "c"], [draw(NUMBERS) for _ in range(INPUTS)])
    registers = [*range(INPUTS), recorder.constant(draw(NUMBERS))]
    for _ in range(draw(st.integers(1, 25))):
        operation = draw(st.sampled_from(list(Operation)))
        operands = [draw(st.sampled_from(registers)) for _ in range(ARITY[operation])]
        if operation is Operation.WHOLE and not abs(recorder.values[operands[0]]) < 2.0**51:
            continue
        registers.append(recorder.compute(operation, *operands))
        if draw(st.booleans()):
            condition = draw(st.sampled_from(CONDITIONS))
            one, other = draw(st.sampled_from(registers)), draw(st.sampled_from(registers))
            recorder.guard(condition, one, other, advice=draw(st.booleans()))
    return recorder.tape(registers)


def bits(values: object) -> bytes:
    """Bytes; all that is not a number is alike."""
    array = np.array(values, dtype=float)
    array[np.isnan(array)] = np.nan
    return array.tobytes()


@settings(deadline=None, max_examples=300)
@given(programs(), st.lists(st.tuples(NUMBERS, NUMBERS, NUMBERS), min_size=1, max_size=9))
def test_every_width_is_the_reference(tape: Tape, sets: list[tuple[float, float, float]]) -> None:
    native = compiled(tape)
    expected = [evaluate(tape, values) for values in sets]
    for lanes in widths():
        outputs, verdicts = replay(native, np.array(sets).T, lanes)
        for k, (reference, verdict) in enumerate(expected):
            assert bits(outputs[k]) == bits(reference)
            assert verdicts[k] == verdict


@settings(deadline=None, max_examples=300)
@given(st.floats(min_value=0.0, exclude_min=True, allow_infinity=False))
@example(5e-324)
@example(2.2250738585072014e-308)
@example(0.7)
@example(math.nextafter(0.7, 1.0))
@example(1.4)
@example(1.7976931348623157e308)
def test_power_of_two(size: float) -> None:
    """Exactly: size / 2^n lies in (0.7, 1.4], with 0.7 the double."""
    recorder = Recorder(["x"], [size])
    found = scalars.next_power_of_two(Traced(recorder, 0))  # type: ignore[arg-type]
    tape = recorder.tape([found.register])  # type: ignore[attr-defined]
    power = evaluate(tape, [size])[0][0]
    for lanes in widths():
        assert bits(replay(compiled(tape), np.array([[size]]), lanes)[0]) == bits([[power]])
    if 0.0 < power < math.inf:
        assert math.frexp(power)[0] == 0.5
        limit = Fraction(0.7)
        if power > 5e-324:
            assert limit < Fraction(size) / Fraction(power) <= 2 * limit


def test_a_guard_that_fails_is_noticed() -> None:
    recorder = Recorder(["x"], [1.0])
    x = Traced(recorder, 0)
    assert x < 2.0
    scalars.advice(x < 3.0)
    assert x != 1.5
    tape = recorder.tape([0])
    sets = np.array([[1.0, 1.5, 2.5, 2.0, 0.5, math.nan]])
    expected = [Verdict.SAME, *[Verdict.OTHER_WAY] * 3, Verdict.SAME, Verdict.OTHER_WAY]
    assert replay(compiled(tape), sets)[1].tolist() == expected
    assert [evaluate(tape, [x])[1] for x in sets[0]] == expected
    only_advice = Recorder(["x"], [1.0])
    scalars.advice(Traced(only_advice, 0) < 3.0)
    assert evaluate(only_advice.tape([0]), [4.0])[1] == Verdict.OTHER_ADVICE


@pytest.mark.parametrize("field", ["operations", "operands", "outputs", "guards"])
def test_bad_tapes_are_refused(field: str) -> None:
    recorder = Recorder(["x"], [1.0])
    x = Traced(recorder, 0)
    assert x < 2.0
    tape = recorder.tape([(x + 1.0).register])
    parts = dict(tape.__dict__)
    parts.pop("fixed", None)
    parts[field] = np.full_like(parts[field], 99)
    with pytest.raises(ValueError, match=r"unknown|lies before|comparison"):
        compiled(Tape(**parts))
