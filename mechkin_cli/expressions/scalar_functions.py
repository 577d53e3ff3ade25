"""Functions of scalars, each for a float or for rows, with the same bits for both.

Transcendental functions come from the kernel. Selections are written with comparisons, because the
zero and nan rules of numpy's own minimum and maximum depend on the processor.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.exact import PI, TURN, Exact
from mechkin_cli.expressions.quantity import Scalar
from mechkin_cli.tape import scalars
from mechkin_cli.tape.scalars import Recorded, Undecided

Condition = NDArray[np.bool_] | np.bool_

# 2 pi in two parts. The first has 22 significant bits, so its product with a whole number of turns
# below 2^31 is exact; the second is what is left, to 4e-23.
_TURN_HIGH = 6.283184051513672
_TURN_LOW = Exact(1.2556659146019252e-06, 2 * PI - Fraction(_TURN_HIGH))


def square_root(value: Scalar) -> Scalar:
    """The square root; nan in rows where the value is negative."""
    return np.sqrt(value) if isinstance(value, np.ndarray) else scalars.square_root(value)


def infinite_with(parts: Sequence[Scalar], length: Scalar) -> Scalar:
    """The length of a vector, infinite in rows where one of its parts is."""
    for part in parts:
        if isinstance(part, np.ndarray) and part.dtype == np.float64 and np.isinf(part).any():
            length = np.where(np.isinf(part), np.inf, length)
    return length


def magnitude(value: Scalar) -> Scalar:
    """The value without its sign."""
    return np.abs(value) if isinstance(value, np.ndarray) else abs(value)


def sign(value: Scalar) -> Scalar:
    """1 of a positive number, -1 of a negative one, else the number itself: zero or nan."""
    if not isinstance(value, np.ndarray):
        return scalars.sign(value)
    return np.where(np.greater(value, 0.0), 1.0, np.where(np.less(value, 0.0), -1.0, value))


def power(base: Scalar, exponent: Scalar) -> Scalar:
    """The base to the exponent."""
    return _paired("POWER", base, exponent)


def angle_of(y: Scalar, x: Scalar) -> Scalar:
    """The angle of the point (x, y) from the x axis, in [-pi, pi]."""
    return _paired("ATAN2", y, x)


def smaller(left: Scalar, right: Scalar) -> Scalar:
    """The smaller of two; nan if one is nan."""
    if scalars.is_row(left) or scalars.is_row(right):
        return _unless_nan(right, scalars.of_two("SMALLER", left, right))
    if not isinstance(left, np.ndarray) and not isinstance(right, np.ndarray):
        return scalars.smallest(left, right)
    return _select(np.less(right, left) | np.isnan(right), right, left)


def larger(left: Scalar, right: Scalar) -> Scalar:
    """The larger of two; nan if one is nan."""
    if scalars.is_row(left) or scalars.is_row(right):
        return _unless_nan(right, scalars.of_two("LARGER", left, right))
    if not isinstance(left, np.ndarray) and not isinstance(right, np.ndarray):
        return scalars.largest(left, right)
    return _select(np.greater(right, left) | np.isnan(right), right, left)


def _unless_nan(right: Any, chosen: Any) -> Scalar:
    """What was chosen of two recorded rows, or the second where that one is nan."""
    if not scalars.is_row(right):
        return chosen  # type: ignore[no-any-return]
    found: Scalar = (right == right).choose(chosen, right)
    return found


def wrap(angle: Scalar) -> Scalar:
    """The angle in (-pi, pi] that differs by whole turns; an angle already there is unchanged."""
    if isinstance(angle, Recorded):
        wrapped: Scalar = _wrapped(angle)
        return wrapped
    turns = np.rint(np.divide(angle, math.tau))
    turned = (angle - turns * _TURN_HIGH) - turns * _TURN_LOW
    turned = np.where(turned > math.pi, turned - math.tau, turned)
    turned = np.where(turned <= -math.pi, turned + math.tau, turned)
    inside = np.greater(angle, -math.pi) & np.less_equal(angle, math.pi)
    return _select(inside, angle, turned)


def _wrapped(angle: Any) -> Any:
    """As `wrap`, for a recorded number."""
    turns = scalars.whole(angle / TURN)
    turned = (angle - turns * _TURN_HIGH) - turns * _TURN_LOW
    turned = (turned > math.pi).choose(turned - TURN, turned)
    turned = (turned <= -math.pi).choose(turned + TURN, turned)
    return (angle > -math.pi).choose((angle <= math.pi).choose(angle, turned), turned)


def branch(condition: Any, value: Scalar, other: Scalar) -> Scalar:
    """`value` where a comparison holds, else `other`: two ways to compute one thing, so that nobody
    needs to find where they meet."""
    if isinstance(condition, Undecided):
        found: Scalar = condition.choose(value, other)
        return found
    if scalars.is_row(value) or scalars.is_row(other):
        return np.where(condition, value, other)
    return _select(condition, value, other)


def _select(condition: Condition, chosen: Scalar, other: Scalar) -> Scalar:
    selected = np.where(condition, chosen, other)
    return selected if selected.ndim else float(selected)


def _paired(operation: str, left: Scalar, right: Scalar) -> Scalar:
    """A kernel function of two arguments, which takes two floats or two arrays of one length."""
    if isinstance(left, np.ndarray) and not isinstance(right, np.ndarray):
        right = np.full(left.shape, right)
    elif isinstance(right, np.ndarray) and not isinstance(left, np.ndarray):
        left = np.full(right.shape, left)
    return scalars.of_two(operation, left, right)  # type: ignore[no-any-return]
