"""Arrays of double-double numbers that know how far their rounding may have moved them.

An expression that is evaluated with them shows which of its values double-double cannot resolve: by
cancellation, or where a product falls below the smallest numbers. The bounds are those of a running
error analysis (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 3.3); those
of elementary functions follow from the ends of the argument's range, which is right where that
range is small.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.tape.double_double import DoubleDoubles, Truths, exactly
from mechkin_cli.tape.scalars import Recorded
from mechkin_cli.tolerances import WIDE_ROUNDING, WIDE_UNDERFLOW

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


class BoundedComparison:
    """A comparison of bounded numbers, row by row."""

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
        rule = _RULES.get(operation)
        numbers = (self, *map(bounded, others))
        with np.errstate(all="ignore"):
            return rule(*numbers) if rule else _elementary(operation, *numbers)

    def apply_after(self, operation: str, first: Any) -> Bounded:
        """The operation on a float first."""
        return bounded(first).apply(operation, self)

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
    """A number, rows of doubles or of double-doubles, taken as exact."""
    return value if isinstance(value, Bounded) else Bounded(exactly(value), 0.0)


def _rounded(value: DoubleDoubles, bound: Any, *, underflows: bool = False) -> Bounded:
    own = WIDE_ROUNDING * np.abs(value.high) + (WIDE_UNDERFLOW if underflows else 0.0)
    return Bounded(value, bound + own)


def _product(a: Bounded, b: Bounded) -> Bounded:
    value = a.value * b.value
    off = _of_products(a.size, b.bound) + _of_products(np.abs(b.value.high), a.bound)
    wide = _rounded(value, off, underflows=True)
    return Bounded(value, np.where(_is_zero(a) | _is_zero(b), 0.0, wide.bound))


def _is_zero(a: Bounded) -> Any:
    return (a.value.high == 0.0) & (a.bound == 0.0)


def _of_products(size: Any, bound: Any) -> Any:
    """size * bound, zero where the bound is, even if the size is infinite."""
    return np.where(bound == 0.0, 0.0, size * bound)


def _quotient(a: Bounded, b: Bounded) -> Bounded:
    value = a.value / b.value
    least = np.abs(b.value.high) - b.bound
    off = (a.bound + _of_products(np.abs(value.high), b.bound)) / least
    wide = _rounded(value, np.where(least > 0.0, off, np.inf), underflows=True)
    return Bounded(value, np.where(_is_zero(a) & (least > 0.0), 0.0, wide.bound))


def _sign(a: Bounded) -> Bounded:
    known = (np.abs(a.value.high) > a.bound) | (a.bound == 0.0)
    return Bounded(a.value.apply("SIGN"), np.where(known, 0.0, 2.0))


def _whole(a: Bounded) -> Bounded:
    value = a.value.apply("WHOLE")
    to_step = 0.5 - np.abs((a.value - value).high)
    known = (to_step > a.bound) | (a.bound == 0.0)
    return Bounded(value, np.where(known, 0.0, 1.0 + a.bound))


def _extreme(operation: str) -> Callable[[Bounded, Bounded], Bounded]:
    return lambda a, b: Bounded(a.value.apply(operation, b.value), np.maximum(a.bound, b.bound))


def _elementary(operation: str, *numbers: Bounded) -> Bounded:
    """Bounded by the values at the ends of the ranges, as far as they lie in the domain, and by the
    rounding of the function itself; never by more than the function varies."""
    value = numbers[0].value.apply(operation, *(n.value for n in numbers[1:]))
    least, most = _DOMAINS.get(operation, (-np.inf, np.inf))
    off: Any = np.zeros(value.shape)
    for signs in product((-1.0, 1.0), repeat=len(numbers)):
        ends = [n.value + sign * n.bound for n, sign in zip(numbers, signs, strict=True)]
        ends[0] = ends[0].apply("LARGER", least).apply("SMALLER", most)
        apart = np.abs((ends[0].apply(operation, *ends[1:]) - value).high)
        off = np.maximum(off, np.where(np.isnan(apart), np.inf, apart))
    if operation in _STEEPEST_ONE:
        off = np.minimum(numbers[0].bound, 2.0)
    if operation == "TAN":
        # a pole may lie between
        off = np.where(numbers[0].bound * (1.0 + value.high * value.high) < 0.5, off, np.inf)
    if operation == "ATAN2":
        at_origin = [np.abs(n.value.high) <= n.bound for n in numbers]
        off = np.where(at_origin[0] & at_origin[1] & (off > 0.0), 2.0 * np.pi, off)
    exact = np.where(np.isfinite(value.high), off, 0.0)
    return _rounded(value, exact, underflows=True)


_DOMAINS = {"SQUARE_ROOT": (0.0, np.inf), "ASIN": (-1.0, 1.0), "ACOS": (-1.0, 1.0)}
"""Closed domains of functions: arguments beyond them are due to rounding alone."""

_STEEPEST_ONE = {"SIN", "COS"}
"""Functions that change by no more than their argument, and by no more than 2."""


_RULES: dict[str, Callable[..., Bounded]] = {
    "ADD": lambda a, b: _rounded(a.value + b.value, a.bound + b.bound),
    "SUBTRACT": lambda a, b: _rounded(a.value - b.value, a.bound + b.bound),
    "MULTIPLY": _product,
    "DIVIDE": _quotient,
    "NEGATE": lambda a: Bounded(-a.value, a.bound),
    "MAGNITUDE": lambda a: Bounded(abs(a.value), a.bound),
    "SIGN": _sign,
    "WHOLE": _whole,
    "LARGER": _extreme("LARGER"),
    "SMALLER": _extreme("SMALLER"),
}
