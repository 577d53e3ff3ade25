"""The operations of a tape, by the numbers that stand in it (`kernel/src/tape.hpp`)."""

from __future__ import annotations

from enum import IntEnum


class Operation(IntEnum):
    """What an instruction computes of its operands a, b, c; for floats, the IEEE operation.

    LARGER is b where b > a, else a; SMALLER is b where b < a, else a: of equal operands the first.
    CHOOSE is b where a is not zero, else c. LESS, NOT_MORE and EQUAL are 1 where a < b, a <= b,
    a = b, else 0. POWER_OF_TWO is 2^n next to a > 0: for a = m 2^e with 1/2 <= m < 1, n is e where
    m > 0.7, else e - 1. WHOLE is the nearest whole number, ties to even, for |a| < 2^51.
    SIGN is 1 where a > 0, -1 where a < 0, else a.
    """

    ADD = 0
    SUBTRACT = 1
    MULTIPLY = 2
    DIVIDE = 3
    NEGATE = 4
    MAGNITUDE = 5
    SQUARE_ROOT = 6
    LARGER = 7
    SMALLER = 8
    CHOOSE = 9
    LESS = 10
    NOT_MORE = 11
    EQUAL = 12
    POWER_OF_TWO = 13
    WHOLE = 14
    SIN = 15
    COS = 16
    TAN = 17
    ASIN = 18
    ACOS = 19
    ATAN = 20
    ATAN2 = 21
    EXP = 22
    LOG = 23
    POWER = 24
    SIGN = 25


CONDITIONS: tuple[Operation, ...] = (Operation.LESS, Operation.NOT_MORE, Operation.EQUAL)
"""What a guard may ask."""

_ONE = {
    Operation.NEGATE,
    Operation.MAGNITUDE,
    Operation.SQUARE_ROOT,
    Operation.POWER_OF_TWO,
    Operation.WHOLE,
    Operation.SIN,
    Operation.COS,
    Operation.TAN,
    Operation.ASIN,
    Operation.ACOS,
    Operation.ATAN,
    Operation.EXP,
    Operation.LOG,
    Operation.SIGN,
}
ARITY = dict.fromkeys(Operation, 2) | dict.fromkeys(_ONE, 1) | {Operation.CHOOSE: 3}
"""How many operands an operation has."""
