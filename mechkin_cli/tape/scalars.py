"""Functions of scalars that may be recorded, and error-free arithmetic of doubles.

A function of a float is the ordinary one, with the same bits; one of a `Recorded` number goes on
its tape. In annotations a `float` is either.
"""

from __future__ import annotations

import math
import operator
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self, TypeGuard, TypeVar

import numpy as np

from mechkin_cli.kernel import functions

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


LARGEST_FLOAT = sys.float_info.max


class Recorded:
    """A number that is not a plain float, and whose arithmetic is that of its `apply`; `is_row`
    where it differs from row to row."""

    __slots__ = ()
    is_row = False

    @property
    def is_settled(self) -> bool:
        """Whether the number stands for one double, with which everything has been decided."""
        return False

    @property
    def recorded(self) -> float:
        """The value when it was recorded."""
        raise NotImplementedError

    def apply(self, operation: str, *others: Any) -> Self:
        """The operation of a name on this number first, then on others."""
        raise NotImplementedError

    def apply_after(self, operation: str, first: Any) -> Self:
        """The operation of a name on a float first, then on this number."""
        raise NotImplementedError

    def compared(self, relation: Callable[[Any, Any], Any], other: Any) -> Any:
        """Whether a relation to a number holds: one of `operator`, as `lt`."""
        raise NotImplementedError

    def __lt__(self, other: Any) -> Any:
        return self.compared(operator.lt, other)

    def __le__(self, other: Any) -> Any:
        return self.compared(operator.le, other)

    def __gt__(self, other: Any) -> Any:
        return self.compared(operator.gt, other)

    def __ge__(self, other: Any) -> Any:
        return self.compared(operator.ge, other)

    def __eq__(self, other: object) -> Any:
        return self.compared(operator.eq, other)

    def __ne__(self, other: object) -> Any:
        return self.compared(operator.ne, other)

    def __add__(self, other: Any) -> Self:
        return self.apply("ADD", other)

    def __radd__(self, other: Any) -> Self:
        return self.apply_after("ADD", other)

    def __sub__(self, other: Any) -> Self:
        return self.apply("SUBTRACT", other)

    def __rsub__(self, other: Any) -> Self:
        return self.apply_after("SUBTRACT", other)

    def __mul__(self, other: Any) -> Self:
        return self.apply("MULTIPLY", other)

    def __rmul__(self, other: Any) -> Self:
        return self.apply_after("MULTIPLY", other)

    def __truediv__(self, other: Any) -> Self:
        return self.apply("DIVIDE", other)

    def __rtruediv__(self, other: Any) -> Self:
        return self.apply_after("DIVIDE", other)

    def __neg__(self) -> Self:
        return self.apply("NEGATE")

    def __abs__(self) -> Self:
        return self.apply("MAGNITUDE")


class Undecided:
    """A comparison of recorded numbers before it becomes a truth value, as it does where it is
    compared with one."""

    __slots__ = ()
    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        return bool(self) == bool(other)

    def choose(self, chosen: Any, other: Any) -> Any:
        """`chosen` where the condition holds, else `other`."""
        raise NotImplementedError

    def advised(self) -> bool:
        """The truth value, where it decides on a warning only."""
        raise NotImplementedError

    def by_rounding(self) -> Undecided:
        """The condition where its two branches differ by rounding only."""
        return self


Result = TypeVar("Result", bound=tuple[Any, ...])


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value is one number, not rows or a vector."""
    return isinstance(value, float) or (isinstance(value, Recorded) and not value.is_row)


def is_row(value: object) -> bool:
    """Whether a value is recorded and differs from row to row."""
    return isinstance(value, Recorded) and value.is_row


def plain(value: Any) -> Any:
    """The value as a float; a recorded number stays as it is."""
    return value if isinstance(value, Recorded) else float(value)


def as_recorded(value: float) -> float:
    """The number as a float, a recorded one as it was then: for use outside of results."""
    return value.recorded if isinstance(value, Recorded) else value


def is_settled(*values: float) -> bool:
    """Whether numbers are recorded exactly: no other values will replace them."""
    return all(isinstance(value, Recorded) and value.is_settled for value in values)


def is_finite(value: float) -> bool:
    """Whether a number is neither infinite nor nan."""
    if isinstance(value, Recorded):
        return bool(abs(value) <= LARGEST_FLOAT)
    return math.isfinite(value)


def square_root(value: Any) -> Any:
    """The square root of a number that is not negative, or of rows of such."""
    if isinstance(value, Recorded):
        return value.apply("SQUARE_ROOT")
    return np.sqrt(value) if isinstance(value, np.ndarray) else math.sqrt(value)


def sign(value: float) -> float:
    """1 of a positive number, -1 of a negative one, else the number itself."""
    if isinstance(value, Recorded):
        return value.apply("SIGN")
    return 1.0 if value > 0.0 else -1.0 if value < 0.0 else value


def largest(first: float, *others: float) -> float:
    """The largest; of equal ones the first."""
    for other in others:
        if isinstance(first, Recorded) or isinstance(other, Recorded):
            first = of_two("LARGER", first, other)
        elif other > first:
            first = other
    return first


def smallest(first: float, *others: float) -> float:
    """The smallest; of equal ones the first."""
    for other in others:
        if isinstance(first, Recorded) or isinstance(other, Recorded):
            first = of_two("SMALLER", first, other)
        elif other < first:
            first = other
    return first


def nonzero(value: float) -> float:
    """The value, or 1 where it is zero."""
    if isinstance(value, Recorded):
        is_zero: Any = value == 0.0
        return is_zero.choose(1.0, value)  # type: ignore[no-any-return]
    return value or 1.0


def either(
    condition: bool, chosen: Callable[[], Result], other: Callable[[], Result]
) -> Result | tuple[Any, ...]:
    """One of two tuples of numbers; a tape computes both, without a guard.

    `other` must be computable where the condition holds, too.
    """
    if isinstance(condition, Undecided):
        return tuple(condition.choose(a, b) for a, b in zip(chosen(), other(), strict=True))
    return chosen() if condition else other()


def by_rounding(condition: bool) -> bool:
    """A condition whose branches differ by rounding only: exact numbers take the branch of a
    condition that does not hold, which approximates nothing."""
    return condition.by_rounding() if isinstance(condition, Undecided) else condition


def advice(condition: bool) -> bool:
    """The truth of a condition that decides on a warning only."""
    return condition.advised() if isinstance(condition, Undecided) else condition


def next_power_of_two(value: float) -> float:
    """The power of two next to a positive number: 2^n with value / 2^n in (0.7, 1.4].

    Example:
        >>> [next_power_of_two(x) for x in (1.0, 1.4, 1.5, 0.3)]
        [1.0, 1.0, 2.0, 0.25]
    """
    if isinstance(value, Recorded):
        return value.apply("POWER_OF_TWO")
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa > 0.7 else exponent - 1)


def of_one(operation: str, value: Any) -> Any:
    """The kernel's function of a name (`SIN`) of a float, of rows or of a recorded number."""
    if isinstance(value, Recorded):
        return value.apply(operation)
    return getattr(functions, operation.lower())(value)


def of_two(operation: str, first: Any, second: Any) -> Any:
    """As `of_one`, of two: floats, rows, or recorded numbers with floats."""
    if isinstance(first, Recorded):
        return first.apply(operation, second)
    if isinstance(second, Recorded):
        return second.apply_after(operation, first)
    return getattr(functions, operation.lower())(first, second)


def sin(angle: Any) -> Any:
    """The sine."""
    return of_one("SIN", angle)


def cos(angle: Any) -> Any:
    """The cosine."""
    return of_one("COS", angle)


def whole(value: Any) -> Any:
    """The nearest whole number of a recorded one that is smaller than 2^51."""
    if not value.is_row and not abs(value) < float(2**51):
        raise TypeError("a varied number is too large to be rounded")
    return value.apply("WHOLE")


# Sums, products and roots of doubles with their rounding errors, over arrays. Sources: T. J. Dekker
# (Numerische Mathematik 18, 1971), D. E. Knuth (The Art of Computer Programming, vol. 2, 4.2.2),
# and for pairs M. Joldes, J.-M. Muller and V. Popescu (ACM Trans. Math. Software 44, 2017),
# algorithms 6, 12 and 17. Valid while nothing overflows or underflows; factors stay below 2^995.

if TYPE_CHECKING:
    Pair = tuple[Floats, Floats]

_HALVES = float(2**27 + 1)
"""2^27 + 1, which cuts a double into two of 26 bits."""


def fast_two_sum(a: Floats, b: Floats) -> Pair:
    """a + b exactly, where |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


def two_sum(a: Floats, b: Floats) -> Pair:
    """a + b exactly."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def two_product(a: Floats, b: Floats) -> Pair:
    """a b exactly."""
    product = a * b
    (p, q), (r, s) = _halves(a), _halves(b)
    return product, (((p * r - product) + p * s) + q * r) + q * s


def _halves(a: Floats) -> Pair:
    scaled = _HALVES * a
    high = scaled - (scaled - a)
    return high, a - high


def sum_of(a: Pair, b: Pair) -> Pair:
    """a + b to 3 u^2 of the result, u = 2^-53, whatever the signs are."""
    (high, low), (t, e) = two_sum(a[0], b[0]), two_sum(a[1], b[1])
    high, low = fast_two_sum(high, low + t)
    return fast_two_sum(high, low + e)


def product_of(a: Pair, b: Pair) -> Pair:
    """a b to 5 u^2."""
    high, low = two_product(a[0], b[0])
    return fast_two_sum(high, low + (a[0] * b[1] + (a[1] * b[0] + a[1] * b[1])))


def quotient_of(a: Pair, b: Pair) -> Pair:
    """a / b to 10 u^2."""
    quotient = a[0] / b[0]
    back = product_of(b, (quotient, np.zeros_like(quotient)))
    rest = (a[0] - back[0]) + (a[1] - back[1])
    return fast_two_sum(quotient, rest / b[0])


def root_of(a: Pair) -> Pair:
    """The square root to 4 u^2; that of zero is zero."""
    root = np.sqrt(a[0])
    square, missing = two_product(root, root)
    rest = ((a[0] - square) - missing) + a[1]
    return fast_two_sum(root, np.where(root > 0.0, rest / (2.0 * root), 0.0))
