"""Arrays of double-double numbers, about 32 digits each: code written for arrays of doubles runs
on them unchanged; and such numbers with bounds of their rounding.

They are `Recorded` numbers that differ from row to row, so expressions take them as they take those
of a tape; and they support the functions of numpy that such code calls (`_UFUNCS`, `_FUNCTIONS`).
All others raise TypeError, never a rounded answer.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.exact import Exact
from mechkin_cli.tape.recorder import Recorder
from mechkin_cli.tape.scalars import (
    Recorded,
    fast_two_sum,
    product_of,
    quotient_of,
    root_of,
    sum_of,
)
from mechkin_cli.tape.tape import ARITY, Operation, compiled, replay_precise
from mechkin_cli.tolerances import WIDE_ROUNDING, WIDE_UNDERFLOW

if TYPE_CHECKING:
    from mechkin_cli.kernel import _kernel
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.tape.scalars import Pair


class Truths(np.ndarray[Any, Any]):
    """The truth of a comparison, row by row."""

    def choose(self, chosen: Any, other: Any) -> Any:  # type: ignore[override]
        """`chosen` where it holds, else `other`."""
        return np.where(self.view(np.ndarray), chosen, other)


class DoubleDoubles(Recorded):
    """Unevaluated sums high + low, |low| <= ulp(high)/2; both of one shape, float64."""

    __slots__ = ("high", "low")
    is_row = True

    def __init__(self, high: Any, low: Any = 0.0) -> None:
        self.high: Floats = np.asarray(high, dtype=np.float64)
        lows = np.broadcast_to(np.asarray(low, dtype=np.float64), self.high.shape)
        # beside an infinity or nan a low part has no meaning
        self.low: Floats = np.where(np.isfinite(self.high), lows, 0.0)

    @classmethod
    def view(cls, high: Floats, low: Floats) -> DoubleDoubles:
        """Of two arrays of one shape as they are, not copied."""
        array = cls.__new__(cls)
        array.high, array.low = high, low
        return array

    @classmethod
    def of_fraction(cls, value: Fraction) -> DoubleDoubles:
        """The nearest pair of doubles, of shape ()."""
        high = float(value)
        return cls(high, float(value - Fraction(high)))

    @property
    def shape(self) -> tuple[int, ...]:
        """As of an array."""
        return self.high.shape

    @property
    def size(self) -> int:
        """As of an array."""
        return self.high.size

    @property
    def ndim(self) -> int:
        """As of an array."""
        return self.high.ndim

    @property
    def T(self) -> DoubleDoubles:  # noqa: N802
        """As of an array."""
        return DoubleDoubles.view(self.high.T, self.low.T)

    def __len__(self) -> int:
        return len(self.high)

    def __iter__(self) -> Any:
        return (self[k] for k in range(len(self)))

    def __getitem__(self, index: Any) -> DoubleDoubles:
        return DoubleDoubles.view(self.high[index], self.low[index])

    def __setitem__(self, index: Any, value: Any) -> None:
        exact = exactly(value)
        self.high[index], self.low[index] = exact.high, exact.low

    def __repr__(self) -> str:
        return f"DoubleDoubles({self.high!r}, {self.low!r})"

    def copy(self) -> DoubleDoubles:
        """Of its own."""
        return DoubleDoubles(self.high.copy(), self.low.copy())

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        own = _UFUNCS.get(ufunc)
        if own is None or method != "__call__" or options:
            raise TypeError(f"{ufunc.__name__} of double-double numbers")
        with np.errstate(all="ignore"):
            return own(*map(exactly, inputs))

    def __array_function__(self, function: Any, types: Any, arguments: Any, options: Any) -> Any:
        own = _FUNCTIONS.get(function)
        if own is None:
            raise TypeError(f"{function.__name__} of double-double numbers")
        with np.errstate(all="ignore"):
            return own(*arguments, **options)

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TypeError("double-double numbers would lose their low parts")

    def apply(self, operation: str, *others: Any) -> Any:
        """An operation of a tape (`Operation`) on these numbers and others."""
        own = _OPERATIONS.get(operation)
        numbers = (self, *map(exactly, others))
        with np.errstate(all="ignore"):
            return own(*numbers) if own else elementary(operation, *numbers)

    def apply_after(self, operation: str, first: Any) -> Any:
        """The operation on a float first."""
        return exactly(first).apply(operation, self)

    def compared(self, relation: Callable[[Any, Any], Any], other: Any) -> Any:
        """Whether a relation holds, row by row."""
        return _RELATIONS[relation](self, other)


def exactly(value: Any) -> DoubleDoubles:
    """A number, an array of doubles or of double-doubles as double-doubles; an `Exact` as the
    number it was rounded from."""
    if isinstance(value, Exact):
        return DoubleDoubles.of_fraction(value.fraction)
    return value if isinstance(value, DoubleDoubles) else DoubleDoubles(value)


def joined(parts: Sequence[DoubleDoubles], axis: int = 0) -> DoubleDoubles:
    """Arrays one behind the other along an axis."""
    highs, lows = [part.high for part in parts], [part.low for part in parts]
    return DoubleDoubles.view(np.concatenate(highs, axis), np.concatenate(lows, axis))


def stacked(parts: Sequence[DoubleDoubles], axis: int = 0) -> DoubleDoubles:
    """Arrays of one shape beside each other along a new axis."""
    highs, lows = [part.high for part in parts], [part.low for part in parts]
    return DoubleDoubles.view(np.stack(highs, axis), np.stack(lows, axis))


def difference(value: Floats, other: DoubleDoubles) -> Floats:
    """value - other to the last bits of a double, without cancellation."""
    return (exactly(value) - other).high


def _of_pairs(
    function: Callable[..., Pair], plain: Callable[..., Floats]
) -> Callable[..., DoubleDoubles]:
    def apply(*numbers: DoubleDoubles) -> DoubleDoubles:
        high, low = function(*((n.high, n.low) for n in numbers))
        # the rounding errors of an infinity are nan, but the infinity is a result
        rough = plain(*(n.high for n in numbers))
        is_pair = np.isfinite(high)
        return DoubleDoubles(np.where(is_pair, high, rough), np.where(is_pair, low, 0.0))

    return apply


_sum = _of_pairs(sum_of, np.add)
_product = _of_pairs(product_of, np.multiply)
_quotient = _of_pairs(quotient_of, np.divide)
_root = _of_pairs(root_of, np.sqrt)


def _negative(a: DoubleDoubles) -> DoubleDoubles:
    return DoubleDoubles(-a.high, -a.low)


def _difference(a: DoubleDoubles, b: DoubleDoubles) -> DoubleDoubles:
    return _sum(a, _negative(b))


def _magnitude(a: DoubleDoubles) -> DoubleDoubles:
    negative = a.high < 0.0
    return DoubleDoubles(np.where(negative, -a.high, a.high), np.where(negative, -a.low, a.low))


def _truths(holds: Bools) -> Any:
    return np.asarray(holds).view(Truths)


def _less(a: DoubleDoubles, b: DoubleDoubles) -> Any:
    return _truths((a.high < b.high) | ((a.high == b.high) & (a.low < b.low)))


def _not_more(a: DoubleDoubles, b: DoubleDoubles) -> Any:
    return _truths((a.high < b.high) | ((a.high == b.high) & (a.low <= b.low)))


def _equal(a: DoubleDoubles, b: DoubleDoubles) -> Any:
    return _truths((a.high == b.high) & (a.low == b.low))


def _where(condition: Any, chosen: Any, other: Any) -> DoubleDoubles:
    a, b = exactly(chosen), exactly(other)
    return DoubleDoubles(np.where(condition, a.high, b.high), np.where(condition, a.low, b.low))


def _each(function: Callable[..., Any]) -> Callable[..., DoubleDoubles]:
    """A function that moves numbers and computes nothing: of the high and of the low parts."""

    def apply(numbers: Sequence[Any], *args: Any, **options: Any) -> DoubleDoubles:
        parts = [exactly(number) for number in numbers]
        highs, lows = [p.high for p in parts], [p.low for p in parts]
        return DoubleDoubles(function(highs, *args, **options), function(lows, *args, **options))

    return apply


def _largest(a: DoubleDoubles, axis: int, initial: float) -> DoubleDoubles:
    """The largest along the first axis, at least `initial`."""
    if axis:
        raise TypeError("max of double-double numbers along an axis that is not the first")
    largest = exactly(np.full(a.shape[1:], initial))
    for part in a:
        largest = _where(_less(largest, part), part, largest)
    return largest


def _sign(a: DoubleDoubles) -> DoubleDoubles:
    return DoubleDoubles(np.where(a.high > 0.0, 1.0, np.where(a.high < 0.0, -1.0, a.high)))


def _whole(a: DoubleDoubles) -> DoubleDoubles:
    high = np.rint(a.high)
    low = np.where(high == a.high, np.rint(a.low), 0.0)
    # half way between two whole numbers the low part decides
    half = (np.abs(a.high - high) == 0.5) & ((a.high - high) * a.low > 0.0)
    high = np.where(half, high + np.sign(a.low), high)
    return DoubleDoubles(*fast_two_sum(high, low))


_RELATIONS: dict[Any, Callable[..., Any]] = {
    operator.lt: np.less,
    operator.le: np.less_equal,
    operator.gt: np.greater,
    operator.ge: np.greater_equal,
    operator.eq: np.equal,
    operator.ne: np.not_equal,
}

_UFUNCS: dict[Any, Callable[..., Any]] = {
    np.add: _sum,
    np.subtract: _difference,
    np.multiply: _product,
    np.divide: _quotient,
    np.negative: _negative,
    np.absolute: _magnitude,
    np.sqrt: _root,
    np.less: _less,
    np.less_equal: _not_more,
    np.greater: lambda a, b: _less(b, a),
    np.greater_equal: lambda a, b: _not_more(b, a),
    np.equal: _equal,
    np.not_equal: lambda a, b: _truths(~np.asarray(_equal(a, b))),
    np.isfinite: lambda a: np.isfinite(a.high),
    np.isnan: lambda a: np.isnan(a.high),
    np.maximum: lambda a, b: _where(_not_more(b, a) | np.isnan(a.high), a, b),
    np.minimum: lambda a, b: _where(_not_more(a, b) | np.isnan(a.high), a, b),
}
"""Functions of numpy, number by number."""

_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.where: _where,
    np.max: _largest,
    np.stack: _each(np.stack),
    np.concatenate: _each(np.concatenate),
    np.full_like: lambda like, value: _where(True, value, 0.0 * exactly(like).high),
    np.ones_like: lambda like: np.ones(exactly(like).shape),
    np.zeros_like: lambda like: np.zeros(exactly(like).shape),
}
"""Functions of numpy, of arrays."""

_OPERATIONS: dict[str, Callable[..., Any]] = {
    "ADD": _sum,
    "SUBTRACT": _difference,
    "MULTIPLY": _product,
    "DIVIDE": _quotient,
    "NEGATE": _negative,
    "SQUARE_ROOT": _root,
    "MAGNITUDE": _magnitude,
    "SIGN": _sign,
    "WHOLE": _whole,
    "LARGER": lambda a, b: _where(_less(a, b), b, a),
    "SMALLER": lambda a, b: _where(_less(b, a), b, a),
}
"""Operations of a tape that need no kernel."""


def elementary(operation: str, *numbers: DoubleDoubles) -> DoubleDoubles:
    """The kernel's function of a name (`SIN`), number by number."""
    parts = np.broadcast_arrays(*(part for n in numbers for part in (n.high, n.low)))
    shape = parts[0].shape
    values = np.stack([part.ravel() for part in parts]).reshape(len(numbers), 2, -1)
    result = replay_precise(_tape(operation), values)[0]
    return DoubleDoubles(result[:, 0, 0].reshape(shape), result[:, 0, 1].reshape(shape))


@cache
def _tape(operation: str) -> _kernel.Tape:
    code = Operation[operation]
    recorder = Recorder("xyz"[: ARITY[code]], [1.0] * ARITY[code])
    return compiled(recorder.tape([recorder.compute(code, *range(ARITY[code]))]))


def eliminate(matrix: Any, right: Any) -> Any:
    """Solutions (rows, n) of systems (rows, n, n) in any numbers that numpy can hold, by Gaussian
    elimination with partial pivoting."""
    a = np.concatenate([matrix, right[:, :, None]], axis=2)
    rows, n = right.shape
    all_rows = np.arange(rows)
    for k in range(n):
        pivot = k + np.argmax(np.abs(a[:, k:, k]), axis=1)
        a[all_rows, pivot], a[:, k] = a[:, k].copy(), a[all_rows, pivot]
        a[:, k] /= a[:, k, k][:, None]
        factors = a[:, :, k].copy()
        factors[:, k] = 0
        a -= factors[:, :, None] * a[:, k][:, None, :]
    return a[:, :, n]


# Arrays of double-double numbers that know how far their rounding may have moved them. An
# expression that is evaluated with them shows which of its values double-double cannot resolve: by
# cancellation, or where a product falls below the smallest numbers. The bounds are those of a
# running error analysis (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., section
# 3.3); those of elementary functions follow from the ends of the argument's range, which is right
# where that range is small.


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
            return rule(*numbers) if rule else _bounded_elementary(operation, *numbers)

    def apply_after(self, operation: str, first: Any) -> Bounded:
        """The operation on a float first."""
        return bounded(first).apply(operation, self)

    def compared(self, relation: Callable[[Any, Any], Any], other: Any) -> BoundedComparison:
        """Whether a relation holds of the values, row by row."""
        return BoundedComparison(relation(self.value, bounded(other).value))


def bounded(value: Any) -> Bounded:
    """A number, rows of doubles or of double-doubles, taken as exact."""
    return value if isinstance(value, Bounded) else Bounded(exactly(value), 0.0)


def _rounded(value: DoubleDoubles, bound: Any, *, underflows: bool = False) -> Bounded:
    own = WIDE_ROUNDING * np.abs(value.high) + (WIDE_UNDERFLOW if underflows else 0.0)
    return Bounded(value, bound + own)


def _bounded_product(a: Bounded, b: Bounded) -> Bounded:
    value = a.value * b.value
    off = _of_products(a.size, b.bound) + _of_products(np.abs(b.value.high), a.bound)
    wide = _rounded(value, off, underflows=True)
    return Bounded(value, np.where(_is_zero(a) | _is_zero(b), 0.0, wide.bound))


def _is_zero(a: Bounded) -> Any:
    return (a.value.high == 0.0) & (a.bound == 0.0)


def _of_products(size: Any, bound: Any) -> Any:
    """size * bound, zero where the bound is, even if the size is infinite."""
    return np.where(bound == 0.0, 0.0, size * bound)


def _bounded_quotient(a: Bounded, b: Bounded) -> Bounded:
    value = a.value / b.value
    least = np.abs(b.value.high) - b.bound
    off = (a.bound + _of_products(np.abs(value.high), b.bound)) / least
    wide = _rounded(value, np.where(least > 0.0, off, np.inf), underflows=True)
    return Bounded(value, np.where(_is_zero(a) & (least > 0.0), 0.0, wide.bound))


def _bounded_sign(a: Bounded) -> Bounded:
    known = (np.abs(a.value.high) > a.bound) | (a.bound == 0.0)
    return Bounded(a.value.apply("SIGN"), np.where(known, 0.0, 2.0))


def _bounded_whole(a: Bounded) -> Bounded:
    value = a.value.apply("WHOLE")
    to_step = 0.5 - np.abs((a.value - value).high)
    known = (to_step > a.bound) | (a.bound == 0.0)
    return Bounded(value, np.where(known, 0.0, 1.0 + a.bound))


def _extreme(operation: str) -> Callable[[Bounded, Bounded], Bounded]:
    return lambda a, b: Bounded(a.value.apply(operation, b.value), np.maximum(a.bound, b.bound))


def _bounded_elementary(operation: str, *numbers: Bounded) -> Bounded:
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
    "MULTIPLY": _bounded_product,
    "DIVIDE": _bounded_quotient,
    "NEGATE": lambda a: Bounded(-a.value, a.bound),
    "MAGNITUDE": lambda a: Bounded(abs(a.value), a.bound),
    "SIGN": _bounded_sign,
    "WHOLE": _bounded_whole,
    "LARGER": _extreme("LARGER"),
    "SMALLER": _extreme("SMALLER"),
}
