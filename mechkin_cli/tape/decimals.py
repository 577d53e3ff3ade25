"""A tape of exact numbers replayed in decimals of 60 digits, with a bound of the rounding.

Every register has a value and a bound of its distance from the true one, which is carried on to
first order with a margin (running error analysis: N. J. Higham, Accuracy and Stability of Numerical
Algorithms, 3.3): far tighter than intervals of doubles, and enough to round a constant once.
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


# Elementary functions of decimal numbers to some 60 digits, by their series.
#
# Reductions are those of J.-M. Muller, Elementary Functions (2016), chapters 5 and 11: whole half
# turns are taken off an angle, a tangent is halved until its series is short. Pi has 60 decimals,
# so an angle x is reduced to |x| 1e-60.

_HALVINGS = 4


def _pi() -> Decimal:
    return Decimal(PI.numerator) / Decimal(PI.denominator)


def _smallest_term() -> Decimal:
    """Terms below this one change nothing."""
    return Decimal(1).scaleb(-getcontext().prec - 2)


def _alternating(first: Decimal, square: Decimal, number: int) -> Decimal:
    """first - first square/((n+1)(n+2)) + ...: the series of the sine (n = 1) and cosine (0)."""
    total, term, least = first, first, _smallest_term()
    while abs(term) > least:
        term = -term * square / ((number + 1) * (number + 2))
        total += term
        number += 2
    return total


def _quarter(angle: Decimal) -> tuple[Decimal, int]:
    """The angle within an eighth of a turn of a whole number of quarters, and that number."""
    half = _pi() / 2
    count = int((angle / half).to_integral_value())
    return angle - count * half, count % 4


def sin(angle: Decimal) -> Decimal:
    """The sine."""
    rest, quarter = _quarter(angle)
    if quarter % 2:
        found = _alternating(Decimal(1), rest * rest, 0)
    else:
        found = _alternating(rest, rest * rest, 1)
    return -found if quarter >= 2 else found


def cos(angle: Decimal) -> Decimal:
    """The cosine."""
    rest, quarter = _quarter(angle)
    if quarter % 2:
        found = -_alternating(rest, rest * rest, 1)
    else:
        found = _alternating(Decimal(1), rest * rest, 0)
    return -found if quarter >= 2 else found


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
"""Of a number that is no sum of two doubles: products of a few such radii, with which intervals of
doubles go on, are no zeros either. So far below all lengths and directions it widens nothing."""


class Approximation(NamedTuple):
    """A number, and how far it is from the true one at most."""

    value: Decimal
    off: float


class NotEnclosed(ValueError):
    """A tape divides by what may be zero, or takes a function beyond where it is defined."""


def double_doubles(tape: ExactTape) -> Floats:
    """The outputs in double-double (outputs, 2): high the nearest double, low the nearest double to
    the rest.

    Raises:
        NotEnclosed: an output is not defined.
    """
    return np.array([parts(one)[:2] for one in replay(tape)], dtype=np.float64).reshape(-1, 2)


def enclosures(tape: ExactTape) -> Floats:
    """The outputs enclosed (outputs, 3): high and low as in double-double, and how far their sum is
    from the true number at most.

    Raises:
        NotEnclosed: an output is not defined.
    """
    return np.array([parts(one) for one in replay(tape)], dtype=np.float64).reshape(-1, 3)


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
    codes = list(map(Operation, tape.operations.tolist()))
    operands = [o[: ARITY[code]] for code, o in zip(codes, tape.operands.tolist(), strict=True)]
    lines = [(code, _RULES[code], o) for code, o in zip(codes, operands, strict=True)]
    outputs = tape.outputs.tolist()
    found = []
    with localcontext() as context:
        context.prec = DIGITS
        for row in rows:
            registers = list(row)
            for code, rule, places in lines:
                arguments = [registers[place] for place in places]
                result = rule(*arguments)
                if not result.off < inf or not result.value.is_finite():
                    raise NotEnclosed(f"{code.name.lower()} of {', '.join(map(str, arguments))}")
                registers.append(result)
            found.append([registers[place] for place in outputs])
    return found


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
    """The result of one operation of IEEE 854, which tells whether it was rounded."""
    context = getcontext()
    context.clear_flags()
    value = function(*arguments)
    return (
        Approximation(value, off) if not off and not context.flags[Inexact] else _near(value, off)
    )


def _carried(off: float, a: Approximation, b: Approximation) -> float:
    """The bound of a result, not zero where an operand has one."""
    return max(off, _LEAST_OFF) if a.off or b.off else off


def _sum(a: Approximation, b: Approximation) -> Approximation:
    return _rounding(a.off + b.off, operator.add, a.value, b.value)


def _difference(a: Approximation, b: Approximation) -> Approximation:
    return _sum(a, _negative(b))


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
    """A function of a bounded slope near its argument; of exactly 0 and 1 nothing is special."""

    def apply(a: Approximation) -> Approximation:
        value = function(a.value)
        reduction = _size(a) * _UNIT
        off = 2.0 * slope(float(a.value)) * (a.off + reduction)
        return _near(value, off)

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
        raise NotEnclosed("the angle of what may be no point")
    if y.off and x.value - Decimal(x.off) < 0 and abs(y.value) <= Decimal(y.off):
        raise NotEnclosed("the angle of what may lie on either side of half a turn")
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


def _power(a: Approximation, b: Approximation) -> Approximation:
    return _exponential(_product(b, _logarithm(a)))


_RULES: dict[Operation, Callable[..., Approximation]] = {
    Operation.ADD: _sum,
    Operation.SUBTRACT: _difference,
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
    Operation.POWER: _power,
    Operation.LESS: lambda a, b: _truth(a.value < b.value),
    Operation.NOT_MORE: lambda a, b: _truth(a.value <= b.value),
    Operation.EQUAL: lambda a, b: _truth(a.value == b.value),
    Operation.CHOOSE: lambda a, b, c: b if a.value else c,
    Operation.LARGER: lambda a, b: b if b.value > a.value else a,
    Operation.SMALLER: lambda a, b: b if b.value < a.value else a,
    Operation.SIGN: lambda a: Approximation(Decimal((a.value > 0) - (a.value < 0)), 0.0),
    Operation.WHOLE: lambda a: Approximation(a.value.to_integral_value(ROUND_HALF_EVEN), 0.0),
}
"""What a tape of exact numbers may hold. Over rows it chooses, too: by the values, whose bounds say
nothing of the other way."""
