"""The arithmetic of expressions: functions of scalars, truth values, operations with dimensions.

Each function takes a float or rows, with the same bits for both. Transcendental functions come from
the kernel. Selections are written with comparisons, because the zero and nan rules of numpy's own
minimum and maximum depend on the processor.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import accumulate, repeat
from math import nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechkin_cli import tolerances
from mechkin_cli.exact import PI, TURN, Exact, nearest as exact_nearest
from mechkin_cli.expressions.quantity import (
    MAX_EXPONENT,
    NumberNode,
    Operand,
    Quantity,
    Scalar,
    Site,
    Value,
    Vector,
    components,
)
from mechkin_cli.tape import Recorded, Undecided, as_recorded, is_number, of_one, scalars
from mechkin_cli.units import POWER, Dimension

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
    return _extreme("SMALLER", scalars.smallest, np.less, left, right)


def larger(left: Scalar, right: Scalar) -> Scalar:
    """The larger of two; nan if one is nan."""
    return _extreme("LARGER", scalars.largest, np.greater, left, right)


def _extreme(operation: str, of_numbers: Any, precedes: Any, left: Any, right: Any) -> Scalar:
    if scalars.is_row(left) or scalars.is_row(right):
        result = scalars.of_two(operation, left, right)
        found: Scalar = (right == right).choose(result, right) if scalars.is_row(right) else result
        return found
    if not isinstance(left, np.ndarray) and not isinstance(right, np.ndarray):
        return of_numbers(left, right)  # type: ignore[no-any-return]
    return _select(precedes(right, left) | np.isnan(right), right, left)


def wrap(angle: Scalar) -> Scalar:
    """The angle in (-pi, pi] that differs by whole turns; an angle already there is unchanged."""
    if isinstance(angle, Recorded):
        return _wrap_recorded(angle)  # type: ignore[no-any-return]
    turns = np.rint(np.divide(angle, math.tau))
    turned = (angle - turns * _TURN_HIGH) - turns * _TURN_LOW
    turned = np.where(turned > math.pi, turned - math.tau, turned)
    turned = np.where(turned <= -math.pi, turned + math.tau, turned)
    inside = np.greater(angle, -math.pi) & np.less_equal(angle, math.pi)
    return _select(inside, angle, turned)


def _wrap_recorded(angle: Any) -> Any:
    turns = scalars.whole(angle / TURN)
    turned = (angle - turns * _TURN_HIGH) - turns * _TURN_LOW
    # Only rounding is taken back: where a motion looks beyond half a turn with the turns it has,
    # the angle goes on.
    most = math.pi + tolerances.WRAP_ROUNDING * (1.0 + turns * turns)
    above = (turned <= most).choose(turned - TURN, turned)
    turned = (turned > math.pi).choose(above, turned)
    below = (turned >= -most).choose(turned + TURN, turned)
    return (turned <= -math.pi).choose(below, turned)


def branch(condition: Any, value: Scalar, other: Scalar) -> Scalar:
    """`value` where a comparison holds, else `other`: two formulas of one function, so that nobody
    needs to find where they meet."""
    if isinstance(condition, Undecided):
        return condition.choose(value, other)  # type: ignore[no-any-return]
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


# Truth values of scalars and rows: 1 where something holds, 0 where it does not, nan where that is
# not known. A comparison is arithmetic on the sign of a difference, so that an integrator or a path
# of inputs finds the place at which it changes as that of `sign(x)`. The difference of two doubles
# is zero only where they are equal, so nothing is lost.


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


# limits half way between two truths, which in intervals come with a rounding


def _unless_false(truth: Any, value: Scalar, other: Scalar) -> Scalar:
    return _where(truth < 0.5, other, value)


def _where_known(truth: Any, value: Scalar) -> Scalar:
    return _where(truth < 1.5, value, truth)


def _where(condition: Any, value: Scalar, other: Scalar) -> Scalar:
    if isinstance(condition, np.ndarray):
        return np.where(condition, value, other)
    if isinstance(condition, bool | np.bool_):
        return value if condition else other
    return condition.choose(value, other)  # type: ignore[no-any-return]


# Whole numbers next to a scalar: a staircase whose steps are those of `rint` and of signs, so that
# they are located as these are.

LARGEST = float(2**51)
"""From here on a double has no room for quarters, and its nearest whole number is not computed."""


def nearest(value: Scalar) -> Scalar:
    """The nearest whole number, of two the even one; nan from 2^51 on."""
    is_small = value * value < LARGEST * LARGEST
    if not isinstance(value, Recorded):
        return branch(is_small, np.rint(value), nan)
    whole = value.apply("WHOLE")
    # a recorded nan is a quotient of zeros
    return whole + (whole - whole) / branch(is_small, 1.0, 0.0)


def below(value: Scalar) -> Scalar:
    """The largest whole number that is not more than the value."""
    whole = nearest(value)
    return whole - less(value, whole)


def above(value: Scalar) -> Scalar:
    """The smallest whole number that is not less than the value."""
    whole = nearest(value)
    return whole + more(value, whole)


def remainder(value: Scalar, period: Scalar) -> Scalar:
    """The excess of the value over a whole number of periods: from 0 up to the period."""
    return value - period * below(value / period)


# Arithmetic on operands: sums need one dimension, products multiply dimensions. Every formula is
# elementwise IEEE arithmetic in a fixed order, for scalars, rows and vectors alike.

_SUM_WORDS = {
    "+": ("add {left} and {right}", operator.add),
    "-": ("subtract {right} from {left}", operator.sub),
}


def common_dimension(site: Site, action: str, left: Operand, right: Operand) -> Dimension:
    """The dimension of two operands that must be of one kind.

    Raises:
        ExpressionError: one is a vector and the other is not, or the dimensions differ.
    """
    if left.dimension == right.dimension:
        dimension = left.dimension
    elif left.dimension.compatible(right.dimension):
        dimension = left.dimension.reduced()
    else:
        bare, other = (left, right) if left.dimension.dimensionless else (right, left)
        hint = "both must be of one kind"
        if bare.dimension.dimensionless:
            hint = site.unit_hint(bare, other.dimension)
        words = action.format(left=left.phrase, right=right.phrase)
        raise site.error(f"cannot {words}", hint, bare)
    if isinstance(left.value, Vector) is not isinstance(right.value, Vector):
        words = action.format(left=left.phrase, right=right.phrase)
        raise site.error(f"cannot {words}", "take a component with .x, .y or .z, or norm(...)")
    require_alike(site, left, right)
    return dimension


def require_alike(site: Site, left: Operand, right: Operand) -> None:
    """Check that two vectors have as many components.

    Raises:
        ExpressionError: one is of a plane and the other of space.
    """
    counts = len(components(left.value)), len(components(right.value))
    if 1 not in counts and counts[0] != counts[1]:
        words = f"a vector of {counts[0]} components and one of {counts[1]}"
        hint = "with plane: xy all vectors have two, in space three"
        raise site.error(f"{site.symbol} does not take {words}", hint, right)


def add_or_subtract(site: Site, left: Operand, right: Operand) -> Quantity:
    """Sum or difference of scalars or of vectors."""
    action, function = _SUM_WORDS[site.symbol]
    dimension = common_dimension(site, action, left, right)
    return Quantity(elementwise(function, left.value, right.value), dimension)


def multiply(site: Site, left: Operand, right: Operand) -> Quantity:
    """Product of scalars, or of a scalar and a vector."""
    if isinstance(left.value, Vector) and isinstance(right.value, Vector):
        raise site.error("* does not multiply two vectors", "write dot(a, b) or cross(a, b)")
    product = elementwise(operator.mul, left.value, right.value)
    return Quantity(product, left.dimension * right.dimension)


def divide(site: Site, left: Operand, right: Operand) -> Quantity:
    """Quotient of a scalar or vector and a scalar."""
    divisor = site.scalar(right)
    constant = any(is_number(item) for item in components(left.value))
    if constant and is_number(divisor) and divisor == 0.0:
        raise site.error("division by zero", "check the values of the parameters", right)
    quotient = elementwise(operator.truediv, left.value, divisor)
    # a torque times an angular rate is a power, and so divided by a power a number; a length times
    # an angle, divided by a length, is an angle again
    if left.dimension.reduced() == right.dimension.reduced() == POWER:
        return Quantity(quotient)
    return Quantity(quotient, left.dimension / right.dimension)


def negate(site: Site, operand: Operand) -> Quantity:
    """The opposite scalar or vector."""
    negative = [-item for item in components(operand.value)]
    value = Vector(*negative) if isinstance(operand.value, Vector) else negative[0]
    return Quantity(value, operand.dimension)


def raise_to_power(site: Site, base: Operand, exponent: Operand) -> Quantity:
    """A power; a base with a dimension takes only a whole number written as such."""
    if isinstance(base.value, Vector):
        raise site.error("a vector has no power", "write dot(a, a) or norm(a)^2", base)
    if not exponent.dimension.dimensionless or isinstance(exponent.value, Vector):
        raise site.error(
            f"an exponent is a dimensionless number, not {exponent.phrase}", None, exponent
        )
    if base.dimension.dimensionless:
        if exponent.number is not None and exponent.value == 2.0:
            return Quantity(base.value * base.value)
        return Quantity(power(base.value, exponent.value))
    count = _whole_number(site, base, exponent)
    value = base.value * base.value if count == 2 else power(base.value, float(count))
    return Quantity(value, base.dimension**count)


def _whole_number(site: Site, base: Operand, exponent: Operand) -> int:
    number: NumberNode | None = exponent.number
    written = 0.5 if number is None else as_recorded(number.value)
    if number is None or written % 1.0 != 0.0:
        raise site.error(
            f"{base.phrase} can only be raised to a whole number that is written as such",
            "write a root as sqrt(...)",
            exponent,
        )
    if abs(written) > MAX_EXPONENT:
        raise site.error(f"the exponent is {number.text} (limit {MAX_EXPONENT})", None, exponent)
    return int(written)


def component(site: Site, operand: Operand) -> Quantity:
    """The component `.x`, `.y` or `.z` of a vector."""
    if not isinstance(operand.value, Vector):
        raise site.error(
            f"{site.symbol} takes a component of a vector, not of {operand.phrase}",
            f"leave out {site.symbol}",
        )
    value = getattr(operand.value, site.symbol[1])
    if value is None:
        raise site.error(
            f"a vector of a plane file has no {site.symbol}",
            "it has .x and .y; what the plane holds, forces along z and moments about x and y, is "
            "not computed",
        )
    return Quantity(value, operand.dimension)


def vector(site: Site, x: Operand, *others: Operand) -> Quantity:
    """A vector of two or three scalars of one dimension."""
    operands = (x, *others)
    value = Vector(*(site.scalar(operand) for operand in operands))
    return Quantity(value, dimension_of_all(site, "make a vector of {left} and {right}", operands))


def dimension_of_all(site: Site, action: str, operands: Sequence[Operand]) -> Dimension:
    """The dimension of operands that must be of one kind.

    Raises:
        ExpressionError: as `common_dimension`.
    """
    first, dimension = operands[0], operands[0].dimension
    for operand in operands[1:]:
        so_far = Operand(Quantity(first.value, dimension), first.offset, first.number)
        dimension = common_dimension(site, action, so_far, operand)
    return dimension


def elementwise(function: Callable[[Scalar, Scalar], Scalar], left: Value, right: Value) -> Value:
    """The function on two scalars, or on components; a scalar goes with every component."""
    if not isinstance(left, Vector) and not isinstance(right, Vector):
        return function(left, right)
    pair = (v.components if isinstance(v, Vector) else repeat(v) for v in (left, right))
    return Vector(*map(function, *pair))


# Comparisons of operands, conditions joined, and the choice between two values.

COMPARED: dict[str, Callable[[Scalar, Scalar], Scalar]] = {
    "<": less,
    "<=": lambda a, b: opposite(more(a, b)),
    ">": more,
    ">=": lambda a, b: opposite(less(a, b)),
    "==": lambda a, b: opposite(differs(a, b)),
    "!=": differs,
}
"""The truth of each comparison, by its sign."""


def compare(site: Site, left: Operand, right: Operand) -> Quantity:
    """Whether a comparison of two scalars of one dimension holds."""
    values = site.scalar(left), site.scalar(right)
    common_dimension(site, "compare {left} with {right}", left, right)
    return Quantity(COMPARED[site.symbol](*values), truth=True)


def join(site: Site, left: Operand, right: Operand) -> Quantity:
    """Whether both conditions hold, or at least one."""
    joined = both if site.symbol == "and" else either
    return Quantity(joined(_condition(site, left), _condition(site, right)), truth=True)


def deny(site: Site, operand: Operand) -> Quantity:
    """Whether a condition does not hold."""
    return Quantity(opposite(_condition(site, operand)), truth=True)


def choose(site: Site, condition: Operand, value: Operand, other: Operand) -> Quantity:
    """One of two values of one dimension, scalars or vectors; both are computed."""
    truth = _condition(site, condition)
    dimension = common_dimension(site, "choose between {left} and {right}", value, other)
    result = elementwise(lambda a, b: chosen(truth, a, b), value.value, other.value)
    return Quantity(result, dimension, truth=value.quantity.truth and other.quantity.truth)


def _condition(site: Site, operand: Operand) -> Scalar:
    """The truth of an operand that must be a condition.

    Raises:
        ExpressionError: it is a number or a vector.
    """
    if not operand.quantity.truth:
        raise site.error(
            f"{site.symbol} takes a condition, not {operand.phrase}",
            "write a comparison such as a > b",
            operand,
        )
    return site.scalar(operand)


# Hyperbolic functions and their inverses, of exponentials and logarithms; near zero, where these
# cancel, by their series, as long as double-double numbers need them, with exact coefficients.
# Source: M. Abramowitz and I. Stegun, Handbook of Mathematical Functions, 4.5 and 4.6.

_NEAR_ZERO = 0.5
"""Up to here sinh goes by its series; the 13 terms leave 0.5^26/27! = 1e-36 of it."""

_SINH = list(
    map(
        exact_nearest,
        accumulate(range(1, 13), lambda c, k: c / (2 * k * (2 * k + 1)), initial=Fraction(1)),
    )
)

_NEAR_ZERO_INVERSE = 0.125
"""Up to here artanh goes by its series; the 19 terms leave 0.125^38/39 = 1e-36 of it."""

_ATANH = [exact_nearest(Fraction(1, 2 * k + 1)) for k in range(19)]


def sinh(x: Scalar) -> Scalar:
    """(e^x - e^-x)/2."""
    far = (of_one("EXP", x) - of_one("EXP", -x)) * 0.5
    return _near_zero(x, _NEAR_ZERO, _SINH, far)


def cosh(x: Scalar) -> Scalar:
    """(e^x + e^-x)/2."""
    cosine: Scalar = (of_one("EXP", x) + of_one("EXP", -x)) * 0.5
    return cosine


def tanh(x: Scalar) -> Scalar:
    """sinh(x)/cosh(x), by 1 - 2/(e^2x + 1) where that does not cancel."""
    far = 1.0 - 2.0 / (of_one("EXP", 2.0 * x) + 1.0)
    return branch(x * x < _NEAR_ZERO * _NEAR_ZERO, sinh(x) / cosh(x), far)


def asinh(x: Scalar) -> Scalar:
    """artanh(x/sqrt(x^2 + 1)), by a logarithm where that does not cancel."""
    is_negative = x < 0.0
    root = square_root(x * x + 1.0)
    far = of_one("LOG", branch(is_negative, -x, x) + root)
    near = _NEAR_ZERO_INVERSE * _NEAR_ZERO_INVERSE
    return branch(x * x < near, atanh(x / root), branch(is_negative, -far, far))


def acosh(x: Scalar) -> Scalar:
    """2 arsinh(sqrt((x - 1)/2)), which is zero at 1; nan below."""
    return 2.0 * asinh(square_root((x - 1.0) * 0.5))


def atanh(x: Scalar) -> Scalar:
    """log((1 + x)/(1 - x))/2; infinite at 1 and -1, nan beyond."""
    far = of_one("LOG", (1.0 + x) / (1.0 - x)) * 0.5
    return _near_zero(x, _NEAR_ZERO_INVERSE, _ATANH, far)


def _near_zero(x: Scalar, limit: float, coefficients: Sequence[float], far: Scalar) -> Scalar:
    """An odd function by its series up to a limit, else `far`."""
    square = x * x
    series: Scalar = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        series = series * square + coefficient
    return branch(square < limit * limit, x * series, far)
