"""Elementary functions of decimal numbers to some 60 digits, by their series.

Reductions are those of J.-M. Muller, Elementary Functions (2016), chapters 5 and 11: whole half
turns are taken off an angle, a tangent is halved until its series is short. Pi has 60 decimals, so
an angle x is reduced to |x| 1e-60.
"""

from __future__ import annotations

from decimal import Decimal, getcontext

from mechkin_cli.exact import PI

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
