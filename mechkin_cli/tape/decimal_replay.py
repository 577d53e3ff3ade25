"""A tape of exact numbers replayed in decimals of 60 digits, with a bound of the rounding.

Every register has a value and a bound of its distance from the true one, which is carried on to
first order with a margin (running error analysis: N. J. Higham, Accuracy and Stability of Numerical
Algorithms, 3.3): far tighter than intervals of doubles, and enough to round a constant once.
"""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, localcontext
from fractions import Fraction
from math import inf, nextafter, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.tape import decimal_functions as functions
from mechkin_cli.tape.operations import ARITY, Operation

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.tape.exact_recorder import ExactTape

DIGITS = 60
"""Of every operation; pi has as many decimals."""

_UNIT = float(Decimal(1).scaleb(3 - DIGITS))
"""A relative error above that of one operation, the longest series included."""

_MARGIN = 1.0 + 1.0 / (1 << 20)
"""Above the rounding of a bound that is computed in doubles."""


class Near(NamedTuple):
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
    return np.array([_parts(one)[:2] for one in replay(tape)], dtype=np.float64).reshape(-1, 2)


def enclosures(tape: ExactTape) -> Floats:
    """The outputs enclosed (outputs, 2): the nearest double, and a radius that holds the true
    number.

    Raises:
        NotEnclosed: an output is not defined.
    """
    found = [(high, radius) for high, _, radius in map(_parts, replay(tape))]
    return np.array(found, dtype=np.float64).reshape(-1, 2)


def replay(tape: ExactTape) -> list[Near]:
    """The outputs with their bounds.

    Raises:
        NotEnclosed: an output is not defined.
    """
    with localcontext() as context:
        context.prec = DIGITS
        registers = [_of_fraction(number) for number in tape.numbers]
        registers += [Near(Decimal(value), 0.0) for value in tape.tape.constants.tolist()]
        lines = zip(tape.tape.operations.tolist(), tape.tape.operands.tolist(), strict=True)
        for code, operands in lines:
            operation = Operation(code)
            arguments = [registers[r] for r in operands[: ARITY[operation]]]
            found = _RULES[operation](*arguments)
            if not found.off < inf or not found.value.is_finite():
                raise NotEnclosed(f"{operation.name.lower()} of {', '.join(map(str, arguments))}")
            registers.append(found)
        return [registers[r] for r in tape.tape.outputs.tolist()]


def _of_fraction(number: Fraction) -> Near:
    value = Decimal(number.numerator) / Decimal(number.denominator)
    return Near(value, abs(float(value)) * _UNIT)


def _parts(near: Near) -> tuple[float, float, float]:
    """High, low and the radius about high."""
    with localcontext() as context:
        context.prec = DIGITS
        high = float(near.value)
        rest = near.value - Decimal(high)
        low = float(rest)
    radius = abs(low) + near.off
    exact = not rest and not near.off
    return high, low, 0.0 if exact else nextafter(radius * _MARGIN, inf)


def _near(value: Decimal, off: float) -> Near:
    """A result, with its own rounding."""
    return Near(value, (off + abs(float(value)) * _UNIT) * _MARGIN)


def _size(near: Near) -> float:
    return abs(float(near.value))


def _exact(a: Near, b: Near, value: Decimal) -> bool:
    """Whether nothing was rounded: few digits."""
    return not a.off and not b.off and len(value.as_tuple().digits) < DIGITS


def _sum(a: Near, b: Near) -> Near:
    value = a.value + b.value
    return Near(value, 0.0) if _exact(a, b, value) else _near(value, a.off + b.off)


def _difference(a: Near, b: Near) -> Near:
    return _sum(a, _negative(b))


def _negative(a: Near) -> Near:
    return Near(a.value.copy_negate(), a.off)


def _product(a: Near, b: Near) -> Near:
    value = a.value * b.value
    if _exact(a, b, value):
        return Near(value, 0.0)
    return _near(value, _size(a) * b.off + _size(b) * a.off + a.off * b.off)


def _quotient(a: Near, b: Near) -> Near:
    least = _size(b) - b.off
    if not least > 0.0:
        raise NotEnclosed("a quotient by what may be zero")
    value = a.value / b.value
    if _exact(a, b, value):
        return Near(value, 0.0)
    return _near(value, (a.off + abs(float(value)) * b.off) / least)


def _root(a: Near) -> Near:
    if a.value <= 0:
        if abs(float(a.value)) > a.off:
            raise NotEnclosed("the root of a negative number")
        return Near(Decimal(0), sqrt(2.0 * a.off) * _MARGIN)
    value = a.value.sqrt()
    if not a.off and value * value == a.value:
        return Near(value, 0.0)
    return _near(value, min(a.off / float(value), sqrt(a.off)))


def _smooth(
    function: Callable[[Decimal], Decimal], slope: Callable[[float], float]
) -> Callable[[Near], Near]:
    """A function of a bounded slope near its argument; of exactly 0 and 1 nothing is special."""

    def apply(a: Near) -> Near:
        value = function(a.value)
        reduction = _size(a) * _UNIT
        off = 2.0 * slope(float(a.value)) * (a.off + reduction)
        return _near(value, off)

    return apply


def _arc(function: Callable[[Decimal], Decimal]) -> Callable[[Near], Near]:
    """Arcsine or arccosine: |f(a) - f(b)| <= 2.3 sqrt|a - b| up to the ends."""

    def apply(a: Near) -> Near:
        x = a.value
        if abs(x) > 1:
            if abs(float(x)) - 1.0 > a.off:
                raise NotEnclosed("the arc of a number beyond 1")
            x = Decimal(1).copy_sign(x)
        room = 1.0 - abs(float(x)) - a.off
        steep = a.off / sqrt(room) if room > a.off else 2.3 * sqrt(2.0 * a.off)
        return _near(function(x), steep + _UNIT)

    return apply


def _angle(y: Near, x: Near) -> Near:
    far = max(_size(y) - y.off, _size(x) - x.off)
    if not far > 0.0:
        if not (y.value or x.value or y.off or x.off):
            return _near(functions.atan2(y.value, x.value), _UNIT)
        raise NotEnclosed("the angle of what may be no point")
    # the off of y alone next to the negative x axis: half a turn either way is one angle
    return _near(functions.atan2(y.value, x.value), 2.0 * (y.off + x.off) / far + _UNIT)


def _exponential(a: Near) -> Near:
    value = a.value.exp()
    return _near(value, 2.0 * abs(float(value)) * a.off)


def _logarithm(a: Near) -> Near:
    least = float(a.value) - a.off
    if not least > 0.0:
        raise NotEnclosed("the logarithm of what may be zero")
    return _near(a.value.ln(), a.off / least + _UNIT)


def _power(a: Near, b: Near) -> Near:
    return _exponential(_product(b, _logarithm(a)))


_RULES: dict[Operation, Callable[..., Near]] = {
    Operation.ADD: _sum,
    Operation.SUBTRACT: _difference,
    Operation.MULTIPLY: _product,
    Operation.DIVIDE: _quotient,
    Operation.NEGATE: _negative,
    Operation.MAGNITUDE: lambda a: Near(abs(a.value), a.off),
    Operation.SQUARE_ROOT: _root,
    Operation.SIN: _smooth(functions.sin, lambda x: 1.0),
    Operation.COS: _smooth(functions.cos, lambda x: 1.0),
    Operation.TAN: lambda a: _quotient(_RULES[Operation.SIN](a), _RULES[Operation.COS](a)),
    Operation.ASIN: _arc(functions.asin),
    Operation.ACOS: _arc(functions.acos),
    Operation.ATAN: _smooth(functions.atan, lambda x: 1.0),
    Operation.ATAN2: _angle,
    Operation.EXP: _exponential,
    Operation.LOG: _logarithm,
    Operation.POWER: _power,
}
"""What a tape of exact numbers may hold."""
