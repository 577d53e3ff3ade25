"""Rows of doubles with the functions that closed forms ask of their numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.float64]


class Doubles:
    """Arrays that broadcast; other operands are floats or float64 arrays."""

    __slots__ = ("high",)
    __array_ufunc__ = None

    def __init__(self, high: Rows | float) -> None:
        self.high: Rows = np.asarray(high, float)

    def __add__(self, other: Operand) -> Doubles:
        b = _rows(other)
        return NotImplemented if b is None else Doubles(self.high + b)

    __radd__ = __add__

    def __neg__(self) -> Doubles:
        return Doubles(-self.high)

    def __sub__(self, other: Operand) -> Doubles:
        b = _rows(other)
        return NotImplemented if b is None else Doubles(self.high - b)

    def __rsub__(self, other: Operand) -> Doubles:
        b = _rows(other)
        return NotImplemented if b is None else Doubles(b - self.high)

    def __mul__(self, other: Operand) -> Doubles:
        b = _rows(other)
        return NotImplemented if b is None else Doubles(self.high * b)

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> Doubles:
        b = _rows(other)
        return NotImplemented if b is None else Doubles(self.high / b)

    def __rtruediv__(self, other: Operand) -> Doubles:
        b = _rows(other)
        return NotImplemented if b is None else Doubles(b / self.high)

    def sqrt(self) -> Doubles:
        """The root."""
        return Doubles(np.sqrt(self.high))

    def sin_cos(self) -> tuple[Doubles, Doubles]:
        """Sine and cosine of rad."""
        return Doubles(np.sin(self.high)), Doubles(np.cos(self.high))


Operand = Doubles | Rows | float


def _rows(value: object) -> Any:
    """None for other kinds of numbers."""
    if isinstance(value, Doubles):
        return value.high
    return value if isinstance(value, float | int | np.ndarray | np.floating) else None
