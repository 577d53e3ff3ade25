"""What code does with scalars that may be recorded: the same bits for a float as ever.

For a float every function is what its name says; for a `Traced` number it goes on the tape. In
annotations a `float` is either.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any, TypeGuard, TypeVar

from mechkin_cli.tape.floats import meaning, power_of_two
from mechkin_cli.tape.operations import Operation
from mechkin_cli.tape.traced import Condition, Traced, TraceLost

LARGEST_FLOAT = sys.float_info.max
Result = TypeVar("Result", bound=tuple[Any, ...])


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value is one number, not rows or a vector."""
    return isinstance(value, float | Traced)


def plain(value: Any) -> Any:
    """The value as a float, or as the recorded number it is."""
    return value if isinstance(value, Traced) else float(value)


def is_finite(value: float) -> bool:
    """Whether a number is neither infinite nor nan."""
    if isinstance(value, Traced):
        return bool(abs(value) <= LARGEST_FLOAT)
    return math.isfinite(value)


def square_root(value: float) -> float:
    """The square root of a number that is not negative."""
    if isinstance(value, Traced):
        return value.apply(Operation.SQUARE_ROOT)
    return math.sqrt(value)


def largest(first: float, *others: float) -> float:
    """The largest; of equal ones the first."""
    for other in others:
        if isinstance(first, Traced) or isinstance(other, Traced):
            first = of_two(Operation.LARGER, first, other)
        elif other > first:
            first = other
    return first


def smallest(first: float, *others: float) -> float:
    """The smallest; of equal ones the first."""
    for other in others:
        if isinstance(first, Traced) or isinstance(other, Traced):
            first = of_two(Operation.SMALLER, first, other)
        elif other < first:
            first = other
    return first


def nonzero(value: float) -> float:
    """The value, or 1 where it is zero."""
    if isinstance(value, Traced):
        return (value == 0.0).choose(1.0, value)
    return value or 1.0


def either(
    condition: bool, chosen: Callable[[], Result], other: Callable[[], Result]
) -> Result | tuple[Any, ...]:
    """One of two tuples of numbers; on a tape both are kept and no guard is needed.

    `other` must be computable where the condition holds, too.
    """
    if isinstance(condition, Condition):
        pairs = zip(chosen(), other(), strict=True)
        return tuple(condition.choose(one, two) for one, two in pairs)
    return chosen() if condition else other()


def advice(condition: bool) -> bool:
    """The truth of a condition on which no more than a warning hangs."""
    if isinstance(condition, Condition):
        found = condition.recorder.guard(
            condition.operation, condition.left, condition.right, advice=True
        )
        return found is not condition.negated
    return condition


def next_power_of_two(value: float) -> float:
    """The power of two next to a positive number, as `floats.power_of_two`."""
    if isinstance(value, Traced):
        return value.apply(Operation.POWER_OF_TWO)
    return power_of_two(value)


def of_one(operation: Operation, value: Any) -> Any:
    """An elementary function of a float, of rows or of a recorded number."""
    if isinstance(value, Traced):
        return value.apply(operation)
    return meaning(operation)(value)


def of_two(operation: Operation, first: Any, second: Any) -> Any:
    """An operation on two floats of which one may be a recorded number."""
    if isinstance(first, Traced):
        return first.apply(operation, second)
    if isinstance(second, Traced):
        one = Traced(second.recorder, second.recorder.constant(float(first)))
        return one.apply(operation, second)
    return meaning(operation)(first, second)


def sin(angle: Any) -> Any:
    """The sine."""
    return of_one(Operation.SIN, angle)


def cos(angle: Any) -> Any:
    """The cosine."""
    return of_one(Operation.COS, angle)


def whole(value: Traced) -> Traced:
    """The nearest whole number of a recorded one that is smaller than 2^51."""
    if not abs(value) < float(2**51):
        raise TraceLost("a varied number is too large to be rounded")
    return value.apply(Operation.WHOLE)
