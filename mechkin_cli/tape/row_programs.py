"""Numbers that differ from row to row, written down as they are computed with: programs of a plan.

Nothing is decided on them, as nothing is on the rows of an array: a quotient by zero or the root of
a negative number has no value in that row. What is constant over the rows, a float or a number that
is itself recorded elsewhere, becomes a constant of the program, each where it is met: equal
constants are not made one, so that the program of varied parameters has the same structure.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from math import nan
from typing import Any

from mechkin_cli.tape.recorder import Instruction, Recorder, Traced, TraceLost, renumbered
from mechkin_cli.tape.scalars import Recorded, Undecided, of_one, of_two
from mechkin_cli.tape.tape import Operation


class RowNumber(Traced):
    """A register of a `RowRecorder`."""

    __slots__ = ()
    is_row = True

    def __truediv__(self, other: float | Traced) -> Traced:
        return self._with(Operation.DIVIDE, other)

    def __rtruediv__(self, other: float) -> Traced:
        return self._after(Operation.DIVIDE, other)

    def _refuse_zero(self) -> None:
        """Where it is zero, a quotient by it has no value in that row."""


class RowRecorder(Recorder):
    """Records what is computed with `inputs` numbers that differ from row to row.

    Attributes:
        constants: the number of each register that is one, in order.
    """

    holds_others = True

    def __init__(self, inputs: int) -> None:
        super().__init__([f"r{k}" for k in range(inputs)], [nan] * inputs)
        self.constants: dict[int, Any] = {}

    def number(self, register: int) -> RowNumber:
        """The number in a register."""
        return RowNumber(self, register)

    def constant(self, value: Any) -> int:
        """The register of a new constant, a float or a number recorded elsewhere."""
        register = self._register(nan)
        self.constants[register] = value
        return register

    def compute(self, operation: Operation, *operands: int) -> int:
        """The register of an operation's result; it has no value of its own."""
        a, b, c = (*operands, 0, 0)[:3]
        instruction = (operation, a, b, c)
        if instruction not in self._instructions:
            number = self._instructions[instruction] = self._register(nan)
            self._written[number] = instruction
        return self._instructions[instruction]

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """Refused: rows go all ways."""
        raise TraceLost("what is computed depends on a number that differs from row to row")

    @property
    def instructions(self) -> list[Instruction]:
        """What was written down so far, in order."""
        return list(self._written.values())

    def listed(
        self, outputs: Sequence[int], marked: Sequence[Instruction]
    ) -> tuple[list[Any], list[int], list[tuple[int, int, int]], list[int], list[int]]:
        """What some registers need: constants, operations, operands, the registers' numbers, and
        which of the operations are those `marked`."""
        first = len(self.inputs)
        needed = self._needed(list(outputs))
        constants = [r for r in needed if r in self.constants]
        computed = [r for r in needed if r in self._written]
        number = {r: r for r in range(first)}
        number |= {r: first + k for k, r in enumerate((*constants, *computed))}
        written = [self._written[r] for r in computed]
        chosen = set(marked)
        return (
            [self.constants[r] for r in constants],
            [int(instruction[0]) for instruction in written],
            [renumbered(instruction, number) for instruction in written],
            [number[r] for r in outputs],
            [k for k, instruction in enumerate(written) if instruction in chosen],
        )


# Recorded numbers that move: value and first three derivatives over a parameter, each recorded.
#
# Sums, products (Leibniz), quotients and functions (Faa di Bruno) are exact, as in
# `expressions.jets`, whose formulas these are for one number at a time. An order that is the float
# 0.0 is left out of what is written down.

_LARGEST_POWER = 64
"""Whole exponents up to this one are products."""


class JetCondition(Undecided):
    """A comparison of the values of two jets."""

    __slots__ = ("condition",)

    def __init__(self, condition: Any) -> None:
        self.condition = condition

    def __bool__(self) -> bool:
        raise TraceLost("what is computed depends on a number that differs from row to row")

    def choose(self, chosen: Any, other: Any) -> JetNumber:
        """`chosen` where the condition holds, else `other`, with its derivatives."""
        pairs = zip(orders_of(chosen), orders_of(other), strict=True)
        return JetNumber([_chosen(self.condition, a, b) for a, b in pairs])


class JetNumber(Recorded):
    """Value, rate, second and third rate; each a float or a recorded number."""

    __slots__ = ("orders",)
    __hash__ = None  # type: ignore[assignment]
    is_row = True

    def __init__(self, orders: Sequence[Any]) -> None:
        self.orders = tuple(orders)

    def __add__(self, other: Any) -> JetNumber:
        return JetNumber(map(_sum, self.orders, orders_of(other)))  # type: ignore[arg-type]

    def __radd__(self, other: Any) -> JetNumber:
        return JetNumber(orders_of(other)) + self

    def __sub__(self, other: Any) -> JetNumber:
        return self + -JetNumber(orders_of(other))

    def __rsub__(self, other: Any) -> JetNumber:
        return JetNumber(orders_of(other)) - self

    def __mul__(self, other: Any) -> JetNumber:
        a, b = self.orders, orders_of(other)
        return JetNumber(
            [
                _product(a[0], b[0]),
                _total([(1, a[1], b[0]), (1, a[0], b[1])]),
                _total([(1, a[2], b[0]), (2, a[1], b[1]), (1, a[0], b[2])]),
                _total([(1, a[3], b[0]), (3, a[2], b[1]), (3, a[1], b[2]), (1, a[0], b[3])]),
            ]
        )

    def __rmul__(self, other: Any) -> JetNumber:
        return JetNumber(orders_of(other)) * self

    def __truediv__(self, other: Any) -> JetNumber:
        """From a = (a/b) b order by order."""
        a, b = self.orders, orders_of(other)
        found: list[Any] = []
        for order, terms in enumerate(_LEIBNIZ):
            rest = a[order]
            for count, k in terms:
                rest = _sum(rest, _opposite(_total([(count, found[k], b[order - k])])))
            found.append(0.0 if _is_zero(rest) else rest / b[0])
        return JetNumber(found)

    def __rtruediv__(self, other: Any) -> JetNumber:
        return JetNumber(orders_of(other)) / self

    def __neg__(self) -> JetNumber:
        return JetNumber([_opposite(order) for order in self.orders])

    def __abs__(self) -> JetNumber:
        return (self < 0.0).choose(-self, self)

    def __lt__(self, other: Any) -> JetCondition:
        return JetCondition(self.orders[0] < orders_of(other)[0])

    def __le__(self, other: Any) -> JetCondition:
        return JetCondition(self.orders[0] <= orders_of(other)[0])

    def __gt__(self, other: Any) -> JetCondition:
        return JetCondition(self.orders[0] > orders_of(other)[0])

    def __ge__(self, other: Any) -> JetCondition:
        return JetCondition(self.orders[0] >= orders_of(other)[0])

    def __eq__(self, other: object) -> Any:
        return JetCondition(self.orders[0] == orders_of(other)[0])

    @staticmethod
    def chosen_by(condition: Any, chosen: Any, other: Any) -> JetNumber:
        """One of two, of which one is such a number, by a condition of numbers that are none."""
        return JetCondition(condition).choose(chosen, other)

    def apply(self, operation: str, *others: Any) -> Any:
        """The operation of a name on this number first, then on others."""
        return (
            _TWO[operation](self, JetNumber(orders_of(others[0])))
            if others
            else (_ONE[operation](self))
        )

    def apply_after(self, operation: str, first: Any) -> Any:
        """The operation of a name on a number that does not move first."""
        return _TWO[operation](JetNumber(orders_of(first)), self)


def orders_of(value: Any) -> tuple[Any, Any, Any, Any]:
    """The orders of a jet, or of a number that does not move."""
    return value.orders if isinstance(value, JetNumber) else (value, 0.0, 0.0, 0.0)


_LEIBNIZ = ((), ((1, 0),), ((1, 0), (2, 1)), ((1, 0), (3, 1), (3, 2)))
"""Of each order of a product q b: the terms (count, k) of q_k b_(order - k) below the highest."""


def _is_zero(value: Any) -> bool:
    return isinstance(value, float) and value == 0.0


def _sum(a: Any, b: Any) -> Any:
    if _is_zero(a):
        return b
    return a if _is_zero(b) else a + b


def _product(a: Any, b: Any) -> Any:
    return 0.0 if _is_zero(a) or _is_zero(b) else a * b


def _opposite(a: Any) -> Any:
    return a if _is_zero(a) else -a


def _total(terms: Sequence[tuple[int, Any, Any]]) -> Any:
    """The sum of count a b."""
    total: Any = 0.0
    for count, a, b in terms:
        product = _product(a, b)
        total = _sum(total, product if count == 1 else _product(float(count), product))
    return total


def _chosen(condition: Any, a: Any, b: Any) -> Any:
    if isinstance(condition, Undecided):
        return a if _is_zero(a) and _is_zero(b) else condition.choose(a, b)
    return a if condition else b


def _through(slopes: Callable[[Any], Sequence[Any]]) -> Callable[[JetNumber], JetNumber]:
    """A function by its value and derivatives; what does not move needs none."""

    def apply(inner: JetNumber) -> JetNumber:
        value, first, second, third = slopes(inner.orders[0])
        _, g, h, j = inner.orders
        squared = _product(g, g)
        return JetNumber(
            [
                value,
                _product(first, g),
                _total([(1, second, squared), (1, first, h)]),
                _total(
                    [(1, third, _product(squared, g)), (3, second, _product(g, h)), (1, first, j)]
                ),
            ]
        )

    return apply


def _sine(x: Any) -> Sequence[Any]:
    s, c = of_one("SIN", x), of_one("COS", x)
    return s, c, -s, -c


def _cosine(x: Any) -> Sequence[Any]:
    s, c = of_one("SIN", x), of_one("COS", x)
    return c, -s, -c, s


def _tangent(x: Any) -> Sequence[Any]:
    t = of_one("TAN", x)
    square = t * t
    first = 1.0 + square
    return t, first, 2.0 * t * first, first * (2.0 + 6.0 * square)


def _arcsine(x: Any) -> Sequence[Any]:
    slope = 1.0 / of_one("SQUARE_ROOT", (1.0 - x) * (1.0 + x))
    cube = slope * slope * slope
    return of_one("ASIN", x), slope, x * cube, cube * (1.0 + 3.0 * (x * slope) * (x * slope))


def _arccosine(x: Any) -> Sequence[Any]:
    _, first, second, third = _arcsine(x)
    return of_one("ACOS", x), -first, -second, -third


def _arctangent(x: Any) -> Sequence[Any]:
    slope = 1.0 / (1.0 + x * x)
    square = slope * slope
    return of_one("ATAN", x), slope, -2.0 * x * square, (6.0 * x * x - 2.0) * (square * slope)


def _root(x: Any) -> Sequence[Any]:
    root = of_one("SQUARE_ROOT", x)
    first = 0.5 / root
    second = -0.5 * first / x
    return root, first, second, -1.5 * second / x


def _exponential(x: Any) -> Sequence[Any]:
    return (of_one("EXP", x),) * 4


def _logarithm(x: Any) -> Sequence[Any]:
    slope = 1.0 / x
    return of_one("LOG", x), slope, -(slope * slope), 2.0 * (slope * slope * slope)


def _angle(y: JetNumber, x: JetNumber) -> JetNumber:
    """atan2(y, x): its rate is (x y' - y x') / (x^2 + y^2), whose jet has one order less."""
    turning = x * _rate(y) - y * _rate(x)
    rate = turning / (x * x + y * y)
    return JetNumber([of_two("ATAN2", y.orders[0], x.orders[0]), *rate.orders[:3]])


def _rate(jet: JetNumber) -> JetNumber:
    return JetNumber([*jet.orders[1:], 0.0])


def _power(base: JetNumber, exponent: JetNumber) -> JetNumber:
    n = exponent.orders[0]
    if any(not _is_zero(order) for order in exponent.orders[1:]) or getattr(n, "is_row", False):
        return _ONE["EXP"](exponent * _ONE["LOG"](base))
    known = n.recorded if isinstance(n, Recorded) else n
    if known == int(known) and abs(known) <= _LARGEST_POWER:
        return _whole_power(base, int(known))

    def slopes(x: Any) -> Sequence[Any]:
        value = of_two("POWER", x, n)
        first = n * value / x
        second = (n - 1.0) * first / x
        return value, first, second, (n - 2.0) * second / x

    return _through(slopes)(base)


def _whole_power(base: JetNumber, count: int) -> JetNumber:
    if count == 0:
        return JetNumber([1.0, 0.0, 0.0, 0.0])
    found = base
    for _ in range(abs(count) - 1):
        found = found * base
    return found if count > 0 else 1.0 / found


def _sign(a: JetNumber) -> JetNumber:
    return JetNumber([of_one("SIGN", a.orders[0]), 0.0, 0.0, 0.0])


def _whole(a: JetNumber) -> JetNumber:
    return JetNumber([of_one("WHOLE", a.orders[0]), 0.0, 0.0, 0.0])


_ONE: dict[str, Callable[[JetNumber], JetNumber]] = {
    "SIN": _through(_sine),
    "COS": _through(_cosine),
    "TAN": _through(_tangent),
    "ASIN": _through(_arcsine),
    "ACOS": _through(_arccosine),
    "ATAN": _through(_arctangent),
    "SQUARE_ROOT": _through(_root),
    "EXP": _through(_exponential),
    "LOG": _through(_logarithm),
    "MAGNITUDE": abs,
    "SIGN": _sign,
    "WHOLE": _whole,
}
_TWO: dict[str, Callable[[JetNumber, JetNumber], JetNumber]] = {
    "ADD": operator.add,
    "SUBTRACT": operator.sub,
    "MULTIPLY": operator.mul,
    "DIVIDE": operator.truediv,
    "ATAN2": _angle,
    "POWER": _power,
    "LARGER": lambda a, b: (b > a).choose(b, a),
    "SMALLER": lambda a, b: (b < a).choose(b, a),
}
