"""What becomes of rows in which something is infinite.

A quantity may be: what grows without bound towards a row at a dead centre. What is made of it is
infinite, too, or has no value. An operation that has no finite value by itself, as 1/x at zero,
gives none, so that no function makes a number of it again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.expressions.operand import Operand
from mechkin_cli.expressions.quantity import Quantity, Scalar, Vector
from mechkin_cli.tolerances import KNOWN_AT_DEAD_CENTRE
from mechkin_cli.units import ANGLE, DIMENSIONLESS

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools, Floats

_KEEPS_INFINITE = frozenset({"+", "-", "negate", "max", "min", "abs"})
"""Operations that are infinite where one operand is, whatever the others are."""

_TAKES_PARTS = frozenset({"[]", ".x", ".y", ".z"})


def is_infinite(quantity: Quantity) -> bool:
    """Whether a quantity is infinite in some row."""
    return any(map(_somewhere, _parts(quantity)))


def without_new(operand: Operand) -> Operand:
    """Rows with nan for what is infinite, of operations on what is finite."""
    if not is_infinite(operand.quantity):
        return operand
    return _each(operand, lambda part: np.where(np.isinf(part), np.nan, part))


def of_infinite(symbol: str, operand: Operand, operands: Sequence[Operand]) -> Operand:
    """The same where operands may be infinite: what is finite in such a row is none of it."""
    if symbol in _TAKES_PARTS:
        return operand
    rows: Bools | np.bool_ = np.False_
    for given in operands:
        for part in _parts(given.quantity):
            if isinstance(part, np.ndarray):
                rows = rows | np.isinf(part)
    told = _each(operand, lambda part: np.where(np.isinf(part) == rows, part, np.nan))
    if symbol in _KEEPS_INFINITE:
        return told
    lost: Bools | np.bool_ = np.False_
    for given in operands:
        lost = lost | _may_vanish(given.quantity)
    return _each(told, lambda part: np.where(rows & lost, np.nan, part))


def _may_vanish(quantity: Quantity) -> Bools | np.bool_:
    """Rows in which a quantity is zero as far as positions are known at a dead centre, so that its
    product with what is infinite may have any limit."""
    rows: Bools | np.bool_ = np.True_
    plain = 1.0 if quantity.dimension in (ANGLE, DIMENSIONLESS) else 0.0
    for part in _parts(quantity):
        size = np.abs(np.asarray(part, dtype=np.float64))
        scale = max(plain, float(size.max(where=np.isfinite(size), initial=0.0)))
        rows = rows & (size <= KNOWN_AT_DEAD_CENTRE * scale)
    return rows


def _somewhere(part: Scalar) -> bool:
    # both of these go without a wrapper of Python's, and every operation on rows comes by here
    if not isinstance(part, np.ndarray) or part.dtype.kind != "f":
        return False
    return bool(np.logical_or.reduce(np.isinf(part)))


def _parts(quantity: Quantity) -> Sequence[Scalar]:
    value = quantity.value
    return value.components if isinstance(value, Vector) else (value,)


def _each(operand: Operand, change: Callable[[Floats], Floats]) -> Operand:
    value = operand.quantity.value
    kept = [change(p) if isinstance(p, np.ndarray) else p for p in _parts(operand.quantity)]
    found = Vector(*kept) if isinstance(value, Vector) else kept[0]
    return replace(operand, quantity=replace(operand.quantity, value=found))
