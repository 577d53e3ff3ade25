"""Elementary functions with the same bits on every machine, for a float or for float64 rows; and
the random numbers of the searches.

Each takes a float and returns a float, or takes an array of shape (n,) and returns a new one of
that shape; functions of two arguments take two floats or two arrays of one length, else they raise
ValueError. Angles are in rad. Errors stay below 1.5 units in the last place for all finite
arguments; special values (signed zeros, infinities, nan, values outside the domain) are those of C
(ISO/IEC 9899, Annex F), without warnings.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce
from math import ldexp, pi
from operator import add
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import NDArray

from mechkin_cli import tolerances
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel import _kernel
from mechkin_cli.tolerances import MOST_THREADS

# The width of the kernel's packs, how many rows march together, and the threads that share rows.
#
# The widest that the machine has, and as many threads as pay, unless others are forced for the
# whole process. No result depends on either; the path of a sweep is followed one row at a time, in
# the narrowest packs, by one thread.

INSTRUCTIONS: Final[dict[int, str]] = _kernel.instructions
"""The widths that this machine has, with what each needs of the processor."""

_forced = 0
_forced_threads = 0


def widths() -> tuple[int, ...]:
    """The widths that this machine has."""
    return tuple(INSTRUCTIONS)


def force_width(lanes: int) -> None:
    """Makes every call of the kernel that names no width run in this one; 0 takes it back.

    Raises:
        UsageError: the machine does not have this width.
    """
    check_width(lanes)
    global _forced
    _forced = lanes


def check_width(lanes: int) -> None:
    """Raises UsageError where `lanes` is neither 0 nor a width that this machine has."""
    if lanes and lanes not in widths():
        known = ", ".join(map(str, widths()))
        raise UsageError(f"lanes {lanes}: this machine has {known}; 0 takes the widest")


def width(lanes: int = 0) -> int:
    """The width that a call asking for `lanes` (0: any) runs in."""
    return lanes or _forced or _kernel.widest


def force_threads(threads: int) -> None:
    """Makes every call of the kernel that names no number of threads run in this many; 0 takes it
    back.

    Raises:
        UsageError: not a whole number from 0 to MOST_THREADS.
    """
    check_threads(threads)
    global _forced_threads
    _forced_threads = threads


def check_threads(threads: int) -> None:
    """Raises UsageError where `threads` is not a whole number from 0 to MOST_THREADS."""
    whole = isinstance(threads, int) and not isinstance(threads, bool)
    if not whole or not 0 <= threads <= MOST_THREADS:
        raise UsageError(
            f"threads {threads}: a whole number from 1 to {MOST_THREADS}; 0 takes as many as pay"
        )


def threads_for(rows: int, threads: int = 0) -> int:
    """The threads that a call over some rows runs in when it asks for `threads` (0: any).

    Raises:
        UsageError: as `check_threads`.
    """
    if threads != 0:
        check_threads(threads)
    asked = threads or _forced_threads
    if asked:
        return asked
    most = rows // tolerances.THREAD_ROWS
    return 1 if most < 2 else min(most, _kernel.available_processors())


FloatArray = NDArray[np.float64]
Value = TypeVar("Value", float, FloatArray)


_Operation = _kernel.Operation


def total(values: Iterable[Any]) -> Any:
    """The sum of floats, or of what adds as they do, from the first to the last, each sum rounded;
    0 without any. Python's `sum` compensates for the rounding of floats from 3.12 on, so that its
    last digits are those of a version."""
    return reduce(add, values, 0)


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


def _apply(operation: _Operation, first: Value, second: Any) -> Value:
    x, y = _rows(first), _rows(second)
    if x.size != y.size and 1 in (x.size, y.size):  # rows with one number
        shape = np.broadcast_shapes(x.shape, y.shape)
        x, y = (_rows(np.broadcast_to(each, shape)) for each in (x, y))
    result: FloatArray = _kernel.elementwise(operation, x, y, width())
    if isinstance(first, np.ndarray) or isinstance(second, np.ndarray):
        return result  # type: ignore[return-value]
    return float(result[0])


def _rows(value: float | FloatArray) -> FloatArray:
    if not isinstance(value, np.ndarray):
        return np.array([value], dtype=np.float64)
    flags = value.flags
    if flags.c_contiguous and flags.writeable and value.dtype == np.float64:
        return value
    return np.require(value, dtype=np.float64, requirements=["C", "W"])


SEED = 20_240_229
"""Of the random starts of all searches: fixed, so that the same file gives the same starts."""

_STEP = 0x9E3779B97F4A7C15
_MIXERS = ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB))
_ROUNDING = ldexp(1.0, -53)


class RandomStarts:
    """A stream of random coordinates, the same on every machine and with every NumPy.

    SplitMix64 (Steele, Lea, Flood 2014): the words are a hash of a counter, so a whole array of
    them costs a few operations, and NumPy's random module need not be imported.
    """

    def __init__(self) -> None:
        self._counter = 0

    def skip(self, count: int) -> None:
        """Passes over the next words of the stream."""
        self._counter += count

    def words(self, count: int) -> NDArray[np.uint64]:
        """The next words of the stream."""
        numbers = np.arange(self._counter + 1, self._counter + count + 1, dtype=np.uint64)
        self._counter += count
        z = np.uint64(SEED) + numbers * np.uint64(_STEP)
        for shift, factor in _MIXERS:
            z = (z ^ (z >> np.uint64(shift))) * np.uint64(factor)
        return z ^ (z >> np.uint64(31))

    def fractions(self, count: int) -> FloatArray:
        """Uniform in [0, 1): the upper 53 bits of each word."""
        return (self.words(count) >> np.uint64(11)).astype(np.float64) * _ROUNDING

    def between(self, half: float, count: int) -> FloatArray:
        """Uniform in [-half, half)."""
        return half * (2.0 * self.fractions(count) - 1.0)

    def quaternions(self, count: int) -> FloatArray:
        """Rotations without preferred direction (Shoemake 1992), (4, count)."""
        share, first, second = (self.fractions(count) for _ in range(3))
        near, far = np.sqrt(1.0 - share), np.sqrt(share)
        first, second = 2.0 * pi * first, 2.0 * pi * second
        (s1, c1), (s2, c2) = ((sin(a), cos(a)) for a in (first, second))
        return np.stack([near * s1, near * c1, far * s2, far * c2])
