"""Elementary functions in decimals, and the bound that goes with them, against mpmath."""

from __future__ import annotations

from decimal import Decimal, localcontext
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from session.tapes import mp, true_outputs

import mechkin_cli as mk
from mechkin_cli.tape import decimals as functions
from mechkin_cli.tape.decimals import DIGITS, NotEnclosed, double_doubles, replay
from mechkin_cli.tape.exact import ExactRecorder
from mechkin_cli.tape.tape import ARITY, CONDITIONS, Operation

RANGES: dict[str, tuple[float, float]] = {
    "sin": (-300.0, 300.0),
    "cos": (-300.0, 300.0),
    "tan": (-1.5, 1.5),
    "atan": (-50.0, 50.0),
    "asin": (-1.0, 1.0),
    "acos": (-1.0, 1.0),
}


def text_of(value: Any) -> Any:
    return mp.mpf(str(value))


@pytest.mark.parametrize("name", RANGES)
def test_functions(name: str) -> None:
    low, high = RANGES[name]
    with localcontext() as context:
        context.prec = DIGITS
        for x in [0.0, low, high, *np.random.default_rng(1).uniform(low, high, 60).tolist()]:
            found = text_of(getattr(functions, name)(Decimal(x)))
            true = getattr(mp, name)(mp.mpf(x))
            assert abs(found - true) <= mp.mpf(10) ** (2 - DIGITS) * max(1, abs(x), abs(true))


@pytest.mark.parametrize("x", [-2.5, -1e-9, 0.0, 1e-9, 1.0, 3.0])
@pytest.mark.parametrize("y", [-2.5, -1e-9, 0.0, 1e-9, 1.0, 3.0])
def test_angles(y: float, x: float) -> None:
    with localcontext() as context:
        context.prec = DIGITS
        found = text_of(functions.atan2(Decimal(y), Decimal(x)))
    assert abs(found - mp.atan2(mp.mpf(y), mp.mpf(x))) <= mp.mpf(10) ** (2 - DIGITS)


DECIDED = {
    *CONDITIONS,
    Operation.CHOOSE,
    Operation.LARGER,
    Operation.SMALLER,
    Operation.POWER_OF_TWO,
    Operation.WHOLE,
    Operation.SIGN,
}


def random_tape(seed: int) -> Any:
    """Random instructions on decimals; every register an output."""
    generator = np.random.default_rng(seed)
    recorder = ExactRecorder()
    registers = []
    for _ in range(4):
        digits = f"{generator.uniform(-2.0, 2.0):.7f}"
        registers.append(recorder.written(float(digits), Fraction(digits)).register)
    known = [o for o in Operation if o not in DECIDED]
    while len(registers) < 30:
        operation = known[generator.integers(len(known))]
        operands = generator.choice(registers, ARITY[operation]).tolist()
        try:
            made = recorder.compute(operation, *operands)
        except OverflowError:
            continue
        if np.isfinite(recorder.values[made]) and abs(recorder.values[made]) < 1e6:
            registers.append(made)
    return recorder.exact_tape(registers)


def test_bounds_hold_the_truth() -> None:
    """On random tapes, cancellations included: errors are below their bounds, and these small."""
    sharp = 0
    for seed in range(200):
        tape = random_tape(seed)
        try:
            found = replay(tape)
        except NotEnclosed:
            continue
        for near, true in zip(found, true_outputs(tape), strict=True):
            own = abs(true) * mp.mpf(10) ** -75  # of these digits
            assert abs(text_of(near.value) - true) <= mp.mpf(near.off) + own
            sharp += near.off < 1e-50
    assert sharp > 2000


PENDULUM = """
format: 1
units: {length: m, angle: deg}
parameters: {a: "atan2(3 - sqrt(3)^2, -1)", b: "atan2(0, -1)", c: "atan2(3 - sqrt(3)^2, 1)"}
links: {bob: {}}
joints: {A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
motion: {inputs: {A.theta: {values: [0]}}}
"""


def test_an_angle_that_may_lie_on_either_side_of_half_a_turn_is_not_told() -> None:
    """What rounding leaves of zero has a sign; zero itself has one angle."""
    one = mk.loads(PENDULUM).session.precise
    tapes = {name: one.tape([one.problem.parameters[name].value]) for name in "abc"}
    with pytest.raises(NotEnclosed, match="either side of half a turn"):
        double_doubles(tapes["a"])
    ((high, low),) = double_doubles(tapes["b"])
    assert abs(mp.mpf(high) + mp.mpf(low) - mp.pi) < mp.mpf(10) ** -30
    assert abs(double_doubles(tapes["c"])).max() < 1e-40
