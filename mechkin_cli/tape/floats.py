"""The meaning of the operations for floats, one by one: what the kernel computes in lanes."""

from __future__ import annotations

import math
from collections.abc import Callable

from mechkin_cli.tape.operations import Operation
from mechkin_cli.tape.scalars import next_power_of_two, sign

_ROUNDER = float(3 * 2**51)
"""1.5 * 2^52: adding it rounds to the nearest whole number."""

_LARGEST_HALF = math.ldexp(0.7, 1024)
"""The power of two next to a larger number is beyond the range of floats."""


def _divide(a: float, b: float) -> float:
    """a / b as IEEE has it; a guard against zero stands before every division."""
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a) or math.isnan(b):
        return math.nan
    return math.copysign(math.inf, math.copysign(1.0, a) * math.copysign(1.0, b))


def _square_root(a: float) -> float:
    return math.sqrt(a) if a >= 0.0 else math.nan


def _whole(a: float) -> float:
    return (a + _ROUNDER) - _ROUNDER


def _power_of_two_or_nan(a: float) -> float:
    if not 0.0 < a < math.inf:
        return math.nan
    return next_power_of_two(a) if a <= _LARGEST_HALF else math.inf


MEANING: dict[Operation, Callable[..., float]] = {
    Operation.ADD: lambda a, b: a + b,
    Operation.SUBTRACT: lambda a, b: a - b,
    Operation.MULTIPLY: lambda a, b: a * b,
    Operation.DIVIDE: _divide,
    Operation.NEGATE: lambda a: -a,
    Operation.MAGNITUDE: abs,
    Operation.SQUARE_ROOT: _square_root,
    Operation.LARGER: lambda a, b: b if b > a else a,
    Operation.SMALLER: lambda a, b: b if b < a else a,
    Operation.CHOOSE: lambda a, b, c: b if a != 0.0 else c,
    Operation.LESS: lambda a, b: float(a < b),
    Operation.NOT_MORE: lambda a, b: float(a <= b),
    Operation.EQUAL: lambda a, b: float(a == b),
    Operation.POWER_OF_TWO: _power_of_two_or_nan,
    Operation.WHOLE: _whole,
    Operation.SIGN: sign,
}
"""The operations that are not elementary functions."""


def meaning(operation: Operation) -> Callable[..., float]:
    """The function of one, two or three floats."""
    known = MEANING.get(operation)
    if known is None:
        from mechkin_cli.kernel import functions

        known = MEANING[operation] = getattr(functions, operation.name.lower())
    return known
