"""Elementary functions with the same bits on every machine, for a float or for float64 rows.

Each takes a float and returns a float, or takes an array of shape (n,) and returns a new one of
that shape; functions of two arguments take two floats or two arrays of one length, else they raise
ValueError. Angles are in rad. Errors stay below 1.5 units in the last place for all finite
arguments; special values (signed zeros, infinities, nan, values outside the domain) are those of C
(ISO/IEC 9899, Annex F), without warnings.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.width import width

FloatArray = NDArray[np.float64]
Value = TypeVar("Value", float, FloatArray)


_Operation = _kernel.Operation


def sin(x: Value) -> Value:
    """Sine of an angle."""
    return _apply(_Operation.SIN, x, x)


def cos(x: Value) -> Value:
    """Cosine of an angle."""
    return _apply(_Operation.COS, x, x)


def tan(x: Value) -> Value:
    """Tangent of an angle."""
    return _apply(_Operation.TAN, x, x)


def asin(x: Value) -> Value:
    """Angle in [-pi/2, pi/2] with this sine; nan beyond [-1, 1]."""
    return _apply(_Operation.ASIN, x, x)


def acos(x: Value) -> Value:
    """Angle in [0, pi] with this cosine; nan beyond [-1, 1]."""
    return _apply(_Operation.ACOS, x, x)


def atan(x: Value) -> Value:
    """Angle in [-pi/2, pi/2] with this tangent."""
    return _apply(_Operation.ATAN, x, x)


def atan2(y: Value, x: Value) -> Value:
    """Angle of the point (x, y) from the x axis, in [-pi, pi]; 0 or +-pi at the origin."""
    return _apply(_Operation.ATAN2, y, x)


def exp(x: Value) -> Value:
    """Exponential function; infinite from 709.79 on."""
    return _apply(_Operation.EXP, x, x)


def log(x: Value) -> Value:
    """Natural logarithm; -infinity at 0, nan below."""
    return _apply(_Operation.LOG, x, x)


def power(base: Value, exponent: Value) -> Value:
    """Base to the exponent; nan for a negative base unless the exponent is an integer."""
    return _apply(_Operation.POWER, base, exponent)


def _apply(operation: _Operation, first: Value, second: Value) -> Value:
    x, y = _rows(first), _rows(second)
    result: FloatArray = _kernel.elementwise(operation, x, y, width())
    return result if isinstance(first, np.ndarray) else float(result[0])


def _rows(value: float | FloatArray) -> FloatArray:
    if not isinstance(value, np.ndarray):
        return np.array([value], dtype=np.float64)
    flags = value.flags
    if flags.c_contiguous and flags.writeable and value.dtype == np.float64:
        return value
    return np.require(value, dtype=np.float64, requirements=["C", "W"])
