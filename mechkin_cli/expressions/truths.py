"""Truth values of scalars and rows: 1 where something holds, 0 where it does not, nan where that is
not known.

A comparison is arithmetic on the sign of a difference, so that whoever looks for the place at which
it changes (an integrator, a course of inputs) finds a sign, as of `sign(x)`. The difference of two
doubles is zero only where they are equal, so nothing is lost by it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mechkin_cli.expressions.quantity import Scalar
from mechkin_cli.expressions.scalar_functions import sign


def more(left: Scalar, right: Scalar) -> Scalar:
    """Whether left > right."""
    side = sign(left - right)
    return (side * side + side) * 0.5


def less(left: Scalar, right: Scalar) -> Scalar:
    """Whether left < right."""
    return more(right, left)


def differs(left: Scalar, right: Scalar) -> Scalar:
    """Whether left and right are two numbers."""
    side = sign(left - right)
    return side * side


def opposite(truth: Scalar) -> Scalar:
    """Whether something does not hold."""
    return 1.0 - truth


def both(first: Scalar, second: Scalar) -> Scalar:
    """Whether both hold; one that does not is enough to know."""
    return _unless_false(second, chosen(first, second, 0.0), 0.0)


def either(first: Scalar, second: Scalar) -> Scalar:
    """Whether at least one holds, which is enough to know."""
    return opposite(both(opposite(first), opposite(second)))


def chosen(truth: Scalar, value: Scalar, other: Scalar) -> Scalar:
    """`value` where the truth is 1, `other` where it is 0, nan where it is not known; what is not
    chosen may have no value."""
    return _unless_false(truth, _where_known(truth, value), other)


# Truths are told apart half way between two: in intervals they come with a rounding.


def _unless_false(truth: Any, value: Scalar, other: Scalar) -> Scalar:
    if isinstance(truth, np.ndarray):
        return np.where(truth < 0.5, other, value)
    return _branch(truth < 0.5, other, value)


def _where_known(truth: Any, value: Scalar) -> Scalar:
    if isinstance(truth, np.ndarray):
        return np.where(truth < 1.5, value, truth)
    return _branch(truth < 1.5, value, truth)


def _branch(condition: Any, value: Scalar, other: Scalar) -> Scalar:
    if isinstance(condition, bool | np.bool_):
        return value if condition else other
    found: Scalar = condition.choose(value, other)
    return found
