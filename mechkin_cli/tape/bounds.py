"""Arrays of double-double numbers that know how far their rounding may have moved them.

An expression that is evaluated with them tells which of its values double-double cannot know: where
a sum swallows what is later all that is left of it, or a product falls below the smallest numbers.
The bounds are those of a running error analysis (Higham, Accuracy and Stability of Numerical
Algorithms, 2nd ed., section 3.3); of elementary functions they are what the ends of the argument's
range give, which is right where that range is small.
"""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.tape.double_double import DoubleDoubles, Truths, exactly
from mechkin_cli.tape.scalars import Recorded
from mechkin_cli.tolerances import WIDE_ROUNDING, WIDE_UNDERFLOW

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class BoundedComparison:
    """What a comparison of bounded numbers finds, row by row."""

    __slots__ = ("holds",)

    def __init__(self, holds: Truths) -> None:
        self.holds = holds

    def choose(self, chosen: Any, other: Any) -> Bounded:
        """`chosen` where it holds, else `other`."""
        a, b = bounded(chosen), bounded(other)
        value = self.holds.choose(a.value, b.value)
        return Bounded(value, np.where(np.asarray(self.holds), a.bound, b.bound))


class Bounded(Recorded):
    """A double-double number `value` and a `bound` of its distance from the true one, in double;
    both of one shape or of shapes that broadcast."""

    __slots__ = ("bound", "value")
    __hash__ = None  # type: ignore[assignment]
    __array_ufunc__ = None
    is_row = True

    def __init__(self, value: DoubleDoubles, bound: Any) -> None:
        self.value = value
        self.bound: Floats = np.asarray(bound, dtype=np.float64)

    @property
    def size(self) -> Floats:
        """Its magnitude at most."""
        return np.abs(self.value.high) + self.bound

    def apply(self, operation: str, *others: Any) -> Bounded:
        """An operation of a tape on this number and others."""
        with np.errstate(all="ignore"):
            return _applied(operation, self, *map(bounded, others))

    def apply_after(self, operation: str, first: Any) -> Bounded:
        """The operation on a float first."""
        return bounded(first).apply(operation, self)

    def __add__(self, other: Any) -> Bounded:
        return _sum(self, bounded(other))

    __radd__ = __add__

    def __sub__(self, other: Any) -> Bounded:
        return _sum(self, -bounded(other))

    def __rsub__(self, other: Any) -> Bounded:
        return _sum(bounded(other), -self)

    def __mul__(self, other: Any) -> Bounded:
        return _product(self, bounded(other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Bounded:
        return _quotient(self, bounded(other))

    def __rtruediv__(self, other: Any) -> Bounded:
        return _quotient(bounded(other), self)

    def __neg__(self) -> Bounded:
        return Bounded(-self.value, self.bound)

    def __abs__(self) -> Bounded:
        return Bounded(abs(self.value), self.bound)

    def __lt__(self, other: Any) -> Any:
        return BoundedComparison(self.value < bounded(other).value)

    def __le__(self, other: Any) -> Any:
        return BoundedComparison(self.value <= bounded(other).value)

    def __gt__(self, other: Any) -> Any:
        return BoundedComparison(self.value > bounded(other).value)

    def __ge__(self, other: Any) -> Any:
        return BoundedComparison(self.value >= bounded(other).value)

    def __eq__(self, other: Any) -> Any:
        return BoundedComparison(self.value == bounded(other).value)

    def __ne__(self, other: Any) -> Any:
        return BoundedComparison(self.value != bounded(other).value)


def bounded(value: Any) -> Bounded:
    """A number, rows of doubles or of double-doubles, taken as they are: bounds are of what is
    computed from them."""
    return value if isinstance(value, Bounded) else Bounded(exactly(value), 0.0)


def _rounded(value: DoubleDoubles, bound: Any, *, underflows: bool = False) -> Bounded:
    own = WIDE_ROUNDING * np.abs(value.high) + (WIDE_UNDERFLOW if underflows else 0.0)
    return Bounded(value, bound + own)


def _sum(a: Bounded, b: Bounded) -> Bounded:
    with np.errstate(all="ignore"):
        return _rounded(a.value + b.value, a.bound + b.bound)


def _product(a: Bounded, b: Bounded) -> Bounded:
    with np.errstate(all="ignore"):
        found = a.value * b.value
        nothing = ((a.value.high == 0.0) & (a.bound == 0.0)) | (
            (b.value.high == 0.0) & (b.bound == 0.0)
        )
        off = _of_products(a.size, b.bound) + _of_products(np.abs(b.value.high), a.bound)
        wide = _rounded(found, off, underflows=True)
        return Bounded(found, np.where(nothing, 0.0, wide.bound))


def _of_products(size: Any, bound: Any) -> Any:
    """size bound, nothing where the bound is none, however large the other is."""
    return np.where(bound == 0.0, 0.0, size * bound)


def _quotient(a: Bounded, b: Bounded) -> Bounded:
    with np.errstate(all="ignore"):
        found = a.value / b.value
        least = np.abs(b.value.high) - b.bound
        off = (a.bound + _of_products(np.abs(found.high), b.bound)) / least
        wide = _rounded(found, np.where(least > 0.0, off, np.inf), underflows=True)
        nothing = (a.value.high == 0.0) & (a.bound == 0.0) & (least > 0.0)
        return Bounded(found, np.where(nothing, 0.0, wide.bound))


def _sign(a: Bounded) -> Bounded:
    known = (np.abs(a.value.high) > a.bound) | (a.bound == 0.0)
    return Bounded(a.value.apply("SIGN"), np.where(known, 0.0, 2.0))


def _whole(a: Bounded) -> Bounded:
    found = a.value.apply("WHOLE")
    to_step = 0.5 - np.abs((a.value - found).high)
    known = (to_step > a.bound) | (a.bound == 0.0)
    return Bounded(found, np.where(known, 0.0, 1.0 + a.bound))


def _extreme(operation: str, a: Bounded, b: Bounded) -> Bounded:
    return Bounded(a.value.apply(operation, b.value), np.maximum(a.bound, b.bound))


def _elementary(operation: str, *numbers: Bounded) -> Bounded:
    """What the ends of the ranges give, as far as they lie in the domain, beside the rounding of
    the function itself; no more than the function varies by."""
    found = numbers[0].value.apply(operation, *(n.value for n in numbers[1:]))
    least, most = _DOMAINS.get(operation, (-np.inf, np.inf))
    off: Any = np.zeros(found.shape)
    for signs in product((-1.0, 1.0), repeat=len(numbers)):
        ends = [n.value + sign * n.bound for n, sign in zip(numbers, signs, strict=True)]
        ends[0] = ends[0].apply("LARGER", least).apply("SMALLER", most)
        apart = np.abs((ends[0].apply(operation, *ends[1:]) - found).high)
        off = np.maximum(off, np.where(np.isnan(apart), np.inf, apart))
    if operation in _STEEPEST_ONE:
        off = np.minimum(numbers[0].bound, 2.0)
    if operation == "TAN":
        # a pole may lie between
        off = np.where(numbers[0].bound * (1.0 + found.high * found.high) < 0.5, off, np.inf)
    if operation == "ATAN2":
        at_origin = [np.abs(n.value.high) <= n.bound for n in numbers]
        off = np.where(at_origin[0] & at_origin[1] & (off > 0.0), 2.0 * np.pi, off)
    exact = np.where(np.isfinite(found.high), off, 0.0)
    return _rounded(found, exact, underflows=True)


_DOMAINS = {"SQUARE_ROOT": (0.0, np.inf), "ASIN": (-1.0, 1.0), "ACOS": (-1.0, 1.0)}
"""Where a function ends with a value: beyond it lies rounding alone."""

_STEEPEST_ONE = {"SIN", "COS"}
"""Functions that change by no more than their argument, and by no more than 2."""


def _applied(operation: str, *numbers: Bounded) -> Bounded:
    if operation == "SIGN":
        return _sign(*numbers)
    if operation == "WHOLE":
        return _whole(*numbers)
    if operation == "MAGNITUDE":
        return abs(numbers[0])
    if operation in ("LARGER", "SMALLER"):
        return _extreme(operation, *numbers)
    return _elementary(operation, *numbers)
