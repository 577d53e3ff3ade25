"""A tape of exact numbers replayed in decimals of 60 digits, with a bound of the rounding.

Every register has a value and a bound of its distance from the true one, which is propagated to
first order with a margin (running error analysis: N. J. Higham, Accuracy and Stability of Numerical
Algorithms, 3.3): far tighter than intervals of doubles, and enough to round a constant once.

Elementary functions are summed by their series. Reductions are those of J.-M. Muller, Elementary
Functions (2016), chapters 5 and 11: whole half turns are taken off an angle, a tangent is halved
until its series is short. Pi has 60 decimals, so an angle x is reduced to |x| 1e-60.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Sequence
from decimal import ROUND_HALF_EVEN, Decimal, Inexact, getcontext, localcontext
from fractions import Fraction
from math import inf, sqrt
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.exact import PI
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape.tape import ARITY, Operation

if TYPE_CHECKING:
    from mechkin_cli.show import Floats
    from mechkin_cli.tape.tape import ExactTape, Tape


_HALVINGS = 4


def _pi() -> Decimal:
    return Decimal(PI.numerator) / Decimal(PI.denominator)


def _smallest_term() -> Decimal:
    """The size of terms that no longer change a sum."""
    return Decimal(1).scaleb(-getcontext().prec - 2)


def _alternating(first: Decimal, square: Decimal, number: int) -> Decimal:
    """first - first square/((n+1)(n+2)) + ...: the series of the sine (n = 1) and cosine (0)."""
    total, term, least = first, first, _smallest_term()
    while abs(term) > least:
        term = -term * square / ((number + 1) * (number + 2))
        total += term
        number += 2
    return total


def sin(angle: Decimal, quarters: int = 0) -> Decimal:
    """The sine of an angle and some more quarters of a turn."""
    quarter = _pi() / 2
    count = int((angle / quarter).to_integral_value())
    rest = angle - count * quarter
    is_cosine = (count + quarters) % 2
    sine = _alternating(Decimal(1) if is_cosine else rest, rest * rest, 0 if is_cosine else 1)
    return -sine if (count + quarters) % 4 >= 2 else sine


def cos(angle: Decimal) -> Decimal:
    """The cosine."""
    return sin(angle, 1)


def tan(angle: Decimal) -> Decimal:
    """The tangent."""
    return sin(angle) / cos(angle)


def atan(x: Decimal) -> Decimal:
    """The arctangent."""
    if abs(x) > 1:
        quarter = (_pi() / 2).copy_sign(x)
        return quarter - atan(1 / x)
    for _ in range(_HALVINGS):
        x = x / (1 + (1 + x * x).sqrt())
    total, power, number, least = x, x, 1, _smallest_term()
    while abs(power) > least:
        power = -power * x * x
        number += 2
        total += power / number
    return total * (1 << _HALVINGS)


def atan2(y: Decimal, x: Decimal) -> Decimal:
    """The angle of the point (x, y) from the x axis, in [-pi, pi]."""
    if abs(y) > abs(x):
        return (_pi() / 2).copy_sign(y) - atan(x / y)
    if x > 0 or (not y and not x.is_signed()):
        return atan(y / x) if x else y
    turned = atan(y / x) if x else Decimal(0)
    return turned + _pi().copy_sign(y)


def asin(x: Decimal) -> Decimal:
    """The arcsine of a number in [-1, 1]."""
    return atan2(x, ((1 - x) * (1 + x)).sqrt())


def acos(x: Decimal) -> Decimal:
    """The arccosine of a number in [-1, 1]."""
    return atan2(((1 - x) * (1 + x)).sqrt(), x)


DIGITS = 60
"""Of every operation; pi has as many decimals."""

_UNIT = float(Decimal(1).scaleb(3 - DIGITS))
"""A relative error above that of one operation, the longest series included."""

_MARGIN = 1.0 + 1.0 / (1 << 20)
"""Above the rounding of a bound that is computed in doubles."""


_LEAST_OFF = 1.0 / (1 << 900)
"""Of a number that is not exact: its bound, a double, never comes out zero."""

_LEAST_RADIUS = 1.0 / (1 << 200)
"""Of a number that is not a sum of two doubles: products of a few such radii, with which intervals
of doubles go on, are not zero either. So far below all lengths and directions it widens nothing."""


class Approximation(NamedTuple):
    """A number, and a bound of its distance from the true one."""

    value: Decimal
    off: float


class NotEnclosed(ValueError):
    """A tape divides by what may be zero, or takes a function outside its domain."""


def double_doubles(tape: ExactTape) -> Floats:
    """The outputs in double-double (outputs, 2): high the nearest double, low the nearest double to
    the rest.

    Raises:
        NotEnclosed: an output is not defined.
    """
    return enclosures(tape)[:, :2].copy()


def enclosures(tape: ExactTape) -> Floats:
    """The outputs enclosed (outputs, 3): high and low as in double-double, and a bound of the
    distance of their sum from the true number.

    Raises:
        NotEnclosed: an output is not defined.
    """
    return np.array([parts(near) for near in replay(tape)], dtype=np.float64).reshape(-1, 3)


def replay(tape: ExactTape) -> list[Approximation]:
    """The outputs with their bounds.

    Raises:
        NotEnclosed: an output is not defined.
    """
    numbers = [of_fraction(number) for number in tape.numbers]
    numbers += [of_fraction(Fraction(value)) for value in tape.tape.constants.tolist()]
    return run(tape.tape, [numbers])[0]


def run(tape: Tape, rows: Iterable[Sequence[Approximation]]) -> list[list[Approximation]]:
    """The outputs of a tape for each of some rows of its inputs and constants.

    Raises:
        NotEnclosed: an output is not defined.
    """
    instructions = []
    for code, operands in zip(tape.operations.tolist(), tape.operands.tolist(), strict=True):
        operation = Operation(code)
        instructions.append((operation, _RULES[operation], operands[: ARITY[operation]]))
    results = []
    with localcontext() as context:
        context.prec = DIGITS
        for row in rows:
            registers = list(row)
            for operation, rule, operands in instructions:
                arguments = [registers[operand] for operand in operands]
                result = rule(*arguments)
                if not result.off < inf or not result.value.is_finite():
                    name = operation.name.lower()
                    raise NotEnclosed(f"{name} of {', '.join(map(str, arguments))}")
                registers.append(result)
            results.append([registers[output] for output in tape.outputs.tolist()])
    return results


def of_fraction(number: Fraction) -> Approximation:
    """A number, exact where it has few digits."""
    with localcontext() as context:
        context.prec = DIGITS
        value = Decimal(number.numerator) / Decimal(number.denominator)
    exact = Fraction(value) == number
    return Approximation(value, 0.0 if exact else max(abs(float(value)) * _UNIT, _LEAST_OFF))


def parts(near: Approximation) -> tuple[float, float, float]:
    """High, low and the radius about their sum."""
    with localcontext() as context:
        context.prec = DIGITS
        high = float(near.value)
        rest = near.value - Decimal(high)
        low = float(rest)
        rest -= Decimal(low)
    if not rest and not near.off:
        return high, low, 0.0
    return high, low, max((abs(float(rest)) + near.off) * _MARGIN, _LEAST_RADIUS)


def _near(value: Decimal, off: float) -> Approximation:
    """A result, with its own rounding."""
    return Approximation(value, max((off + abs(float(value)) * _UNIT) * _MARGIN, _LEAST_OFF))


def _size(near: Approximation) -> float:
    return abs(float(near.value))


def _rounding(off: float, function: Callable[..., Decimal], *arguments: Decimal) -> Approximation:
    """The result of one operation of IEEE 854, whose flag shows whether it was rounded."""
    context = getcontext()
    context.clear_flags()
    value = function(*arguments)
    is_exact = not off and not context.flags[Inexact]
    return Approximation(value, off) if is_exact else _near(value, off)


def _carried(off: float, a: Approximation, b: Approximation) -> float:
    """The bound of a result, not zero where an operand has one."""
    return max(off, _LEAST_OFF) if a.off or b.off else off


def _sum(a: Approximation, b: Approximation) -> Approximation:
    return _rounding(a.off + b.off, operator.add, a.value, b.value)


def _negative(a: Approximation) -> Approximation:
    return Approximation(a.value.copy_negate(), a.off)


def _product(a: Approximation, b: Approximation) -> Approximation:
    off = _size(a) * b.off + _size(b) * a.off + a.off * b.off
    return _rounding(_carried(off, a, b), operator.mul, a.value, b.value)


def _quotient(a: Approximation, b: Approximation) -> Approximation:
    least = _size(b) - b.off
    if not least > 0.0:
        raise NotEnclosed("a quotient by what may be zero")
    off = (a.off + _size(a) / _size(b) * b.off) / least
    return _rounding(_carried(off * _MARGIN, a, b), operator.truediv, a.value, b.value)


def _root(a: Approximation) -> Approximation:
    if a.value <= 0:
        if abs(float(a.value)) > a.off:
            raise NotEnclosed("the root of a negative number")
        return Approximation(Decimal(0), sqrt(2.0 * a.off) * _MARGIN)
    size = _size(a)
    return _rounding(min(a.off / sqrt(size) * _MARGIN, sqrt(a.off)), Decimal.sqrt, a.value)


def _smooth(
    function: Callable[[Decimal], Decimal], slope: Callable[[float], float]
) -> Callable[[Approximation], Approximation]:
    """A function of a bounded slope near its argument; 0 and 1 are not treated as exact."""

    def apply(a: Approximation) -> Approximation:
        reduction = _size(a) * _UNIT
        return _near(function(a.value), 2.0 * slope(float(a.value)) * (a.off + reduction))

    return apply


def _arc(function: Callable[[Decimal], Decimal]) -> Callable[[Approximation], Approximation]:
    """Arcsine or arccosine: |f(a) - f(b)| <= 2.3 sqrt|a - b| up to the ends."""

    def apply(a: Approximation) -> Approximation:
        x = a.value
        if abs(x) > 1:
            if abs(float(x)) - 1.0 > a.off:
                raise NotEnclosed("the arc of a number beyond 1")
            x = Decimal(1).copy_sign(x)
        room = 1.0 - abs(float(x)) - a.off
        steep = a.off / sqrt(room) if room > a.off else 2.3 * sqrt(2.0 * a.off)
        return _near(function(x), steep + _UNIT)

    return apply


def _angle(y: Approximation, x: Approximation) -> Approximation:
    far = max(_size(y) - y.off, _size(x) - x.off)
    if not far > 0.0:
        if not (y.value or x.value or y.off or x.off):
            return _near(atan2(y.value, x.value), _UNIT)
        raise NotEnclosed("the angle of a point that may be the origin")
    if y.off and x.value - Decimal(x.off) < 0 and abs(y.value) <= Decimal(y.off):
        raise NotEnclosed("the angle of a point that may lie on either side of half a turn")
    return _near(atan2(y.value, x.value), 2.0 * (y.off + x.off) / far + _UNIT)


def _exponential(a: Approximation) -> Approximation:
    value = a.value.exp()
    return _near(value, 2.0 * abs(float(value)) * a.off)


def _logarithm(a: Approximation) -> Approximation:
    least = float(a.value) - a.off
    if not least > 0.0:
        raise NotEnclosed("the logarithm of what may be zero")
    return _near(a.value.ln(), a.off / least + _UNIT)


def _truth(holds: bool) -> Approximation:
    return Approximation(Decimal(int(holds)), 0.0)


_RULES: dict[Operation, Callable[..., Approximation]] = {
    Operation.ADD: _sum,
    Operation.SUBTRACT: lambda a, b: _sum(a, _negative(b)),
    Operation.MULTIPLY: _product,
    Operation.DIVIDE: _quotient,
    Operation.NEGATE: _negative,
    Operation.MAGNITUDE: lambda a: Approximation(abs(a.value), a.off),
    Operation.SQUARE_ROOT: _root,
    Operation.SIN: _smooth(sin, lambda x: 1.0),
    Operation.COS: _smooth(cos, lambda x: 1.0),
    Operation.TAN: lambda a: _quotient(_RULES[Operation.SIN](a), _RULES[Operation.COS](a)),
    Operation.ASIN: _arc(asin),
    Operation.ACOS: _arc(acos),
    Operation.ATAN: _smooth(atan, lambda x: 1.0),
    Operation.ATAN2: _angle,
    Operation.EXP: _exponential,
    Operation.LOG: _logarithm,
    Operation.POWER: lambda a, b: _exponential(_product(b, _logarithm(a))),
    Operation.LESS: lambda a, b: _truth(a.value < b.value),
    Operation.NOT_MORE: lambda a, b: _truth(a.value <= b.value),
    Operation.EQUAL: lambda a, b: _truth(a.value == b.value),
    Operation.CHOOSE: lambda a, b, c: b if a.value else c,
    Operation.LARGER: lambda a, b: b if b.value > a.value else a,
    Operation.SMALLER: lambda a, b: b if b.value < a.value else a,
    Operation.SIGN: lambda a: Approximation(Decimal((a.value > 0) - (a.value < 0)), 0.0),
    Operation.WHOLE: lambda a: Approximation(a.value.to_integral_value(ROUND_HALF_EVEN), 0.0),
}
"""The operations of a tape of exact numbers. Over rows it chooses, too, by the values: their bounds
do not cover the other branch."""
