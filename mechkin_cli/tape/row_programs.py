"""Recorded numbers that differ from row to row, and their derivatives: programs of a plan.

Nothing is decided on them, as nothing is on the rows of an array: a quotient by zero or the root of
a negative number has no value in that row. A number that is constant over the rows, a float or one
that is itself recorded elsewhere, becomes a new constant of the program at each use, so that the
program of varied parameters has the same structure.

`JetNumber` records a number with its first three derivatives over a parameter. Sums, products
(Leibniz), quotients and functions (Faa di Bruno) are exact, as in `derivatives`. An order that
is the float 0.0 is left out of the recording.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import nan
from typing import Any

import numpy as np

from mechkin_cli.tape.recorder import Instruction, Recorder, Traced, TraceLost
from mechkin_cli.tape.scalars import Recorded, Undecided, of_one, of_two
from mechkin_cli.tape.tape import Operation


class RowNumber(Traced):
    """A register of a `RowRecorder`."""

    __slots__ = ()
    is_row = True

    @property
    def constant(self) -> Any:
        """What the register of a constant holds; None of one that differs from row to row."""
        recorder: Any = self.recorder
        return recorder.constants.get(self.register)

    __truediv__ = Recorded.__truediv__
    __rtruediv__ = Recorded.__rtruediv__

    def _refuse_zero(self) -> None:
        """Where it is zero, a quotient by it has no value in that row."""


class RowRecorder(Recorder):
    """Records what is computed with `inputs` numbers that differ from row to row.

    Attributes:
        constants: the number of each register that is a constant, in order.
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
        """Not possible: rows take different branches."""
        raise TraceLost("what is computed depends on a number that differs from row to row")

    @property
    def instructions(self) -> list[Instruction]:
        """The instructions so far, in order."""
        return list(self._written.values())

    def listed(
        self, outputs: Sequence[int], marked: Sequence[Instruction]
    ) -> tuple[list[Any], list[int], list[tuple[int, int, int]], list[int], list[int]]:
        """The program of some registers: constants, operations, operands, the registers' numbers,
        and which of the operations are `marked`."""
        needed = self._needed(outputs)
        constants = [r for r in needed if r in self.constants]
        leaves = [*range(len(self.inputs)), *constants]
        operations, operands, number = self._renumbered(leaves, needed)
        written = [self._written[r] for r in needed if r in self._written]
        marks = set(marked)
        return (
            [self.constants[r] for r in constants],
            operations,
            operands,
            [number[r] for r in outputs],
            [k for k, instruction in enumerate(written) if instruction in marks],
        )

    def listed_in_turn(
        self, outputs: Sequence[Sequence[int]]
    ) -> tuple[list[Any], list[int], list[tuple[int, int, int]], list[int], list[int]]:
        """The program of registers, of which a part after the other is asked for, each with those
        before: constants, operations, operands, how many operations each part needs, and the
        numbers of the last part's registers."""
        found: dict[int, None] = {}
        counts = []
        for part in outputs:
            found |= dict.fromkeys(r for r in self._needed(part) if r not in found)
            counts.append(sum(r in self._written for r in found))
        needed = list(found)
        constants = [r for r in needed if r in self.constants]
        leaves = [*range(len(self.inputs)), *constants]
        operations, operands, number = self._renumbered(leaves, needed)
        numbers = [number[r] for r in outputs[-1]]
        return [self.constants[r] for r in constants], operations, operands, counts, numbers


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
    is_row = True

    def __init__(self, orders: Sequence[Any]) -> None:
        self.orders = tuple(orders)

    def beside(self, constant: Any) -> Any:
        """A number that does not move, on the recording of this one if there is one: what is
        computed with it is then recorded alike whatever it is, also zero."""
        value = self.orders[0]
        if not isinstance(value, RowNumber):
            return constant
        recorder: Any = value.recorder
        return JetNumber([recorder.number(recorder.constant(constant)), 0.0, 0.0, 0.0])

    def compared(self, relation: Callable[[Any, Any], Any], other: Any) -> JetCondition:
        """Whether a relation holds of the values."""
        return JetCondition(relation(self.orders[0], orders_of(other)[0]))

    @staticmethod
    def chosen_by(condition: Any, chosen: Any, other: Any) -> JetNumber:
        """One of two, of which one is a jet, by a condition of numbers that are not."""
        return JetCondition(condition).choose(chosen, other)

    def apply(self, operation: str, *others: Any) -> Any:
        """The operation of a name on this number first, then on others."""
        if others:
            return _TWO[operation](self, JetNumber(orders_of(others[0])))
        return _ONE[operation](self)

    def apply_after(self, operation: str, first: Any) -> Any:
        """The operation of a name on a number that does not move first."""
        return _TWO[operation](JetNumber(orders_of(first)), self)


def orders_of(value: Any) -> tuple[Any, Any, Any, Any]:
    """The orders of a jet, or of a number that does not move; a zero of the text is that of
    doubles, so that what is left out with it is left out of exact numbers, too."""
    if isinstance(value, JetNumber):
        return value.orders
    if isinstance(value, Traced):
        value = value.recorder.without_zero(value)
    return value, 0.0, 0.0, 0.0


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


def _times(one: JetNumber, other: JetNumber) -> JetNumber:
    a, b = one.orders, other.orders
    return JetNumber(
        [
            _product(a[0], b[0]),
            _total([(1, a[1], b[0]), (1, a[0], b[1])]),
            _total([(1, a[2], b[0]), (2, a[1], b[1]), (1, a[0], b[2])]),
            _total([(1, a[3], b[0]), (3, a[2], b[1]), (3, a[1], b[2]), (1, a[0], b[3])]),
        ]
    )


_LEIBNIZ = ((), ((1, 0),), ((1, 0), (2, 1)), ((1, 0), (3, 1), (3, 2)))
"""Of each order of a product q b: the terms (count, k) of q_k b_(order - k) below the highest."""


def _over(one: JetNumber, other: JetNumber) -> JetNumber:
    """The quotient q = a/b, from a = q b order by order."""
    a, b = one.orders, other.orders
    orders: list[Any] = []
    for order, terms in enumerate(_LEIBNIZ):
        rest = a[order]
        for count, k in terms:
            rest = _sum(rest, _opposite(_total([(count, orders[k], b[order - k])])))
        orders.append(0.0 if _is_zero(rest) else rest / b[0])
    return JetNumber(orders)


def _chosen(condition: Any, a: Any, b: Any) -> Any:
    if _is_zero(a) and _is_zero(b):
        return a
    if isinstance(condition, np.ndarray):
        return np.where(condition, a, b)
    if isinstance(condition, Undecided):
        return condition.choose(a, b)
    return a if condition else b


def _through(slopes: Callable[[Any], Sequence[Any]]) -> Callable[[JetNumber], JetNumber]:
    """A function by its value and derivatives; a number that does not move needs none."""

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


# Elementary functions f of a float, of rows or of a recorded number: f, f', f'', f'''.


def _square_root(x: Any) -> Any:
    return x.apply("SQUARE_ROOT") if isinstance(x, Recorded) else np.sqrt(x)


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
    slope = 1.0 / _square_root((1.0 - x) * (1.0 + x))
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
    root = _square_root(x)
    first = 0.5 / root
    second = -0.5 * first / x
    return root, first, second, -1.5 * second / x


def _exponential(x: Any) -> Sequence[Any]:
    return (of_one("EXP", x),) * 4


def _logarithm(x: Any) -> Sequence[Any]:
    slope = 1.0 / x
    return of_one("LOG", x), slope, -(slope * slope), 2.0 * (slope * slope * slope)


SLOPES: dict[str, Callable[[Any], Sequence[Any]]] = {
    "SIN": _sine,
    "COS": _cosine,
    "TAN": _tangent,
    "ASIN": _arcsine,
    "ACOS": _arccosine,
    "ATAN": _arctangent,
    "SQUARE_ROOT": _root,
    "EXP": _exponential,
    "LOG": _logarithm,
}
"""Value and first three derivatives of functions of a float, of rows or of a recorded number."""


def _angle(y: JetNumber, x: JetNumber) -> JetNumber:
    """atan2(y, x): its rate is (x y' - y x') / (x^2 + y^2), whose jet has one order less."""
    turning = x * _rate(y) - y * _rate(x)
    rate = turning / (x * x + y * y)
    return JetNumber([of_two("ATAN2", y.orders[0], x.orders[0]), *rate.orders[:3]])


def _rate(jet: JetNumber) -> JetNumber:
    return JetNumber([*jet.orders[1:], 0.0])


def _power(base: JetNumber, exponent: JetNumber) -> JetNumber:
    n = exponent.orders[0]
    # a parameter is a constant of the recording
    fixed = n.constant if isinstance(n, RowNumber) else n
    if fixed is None or any(not _is_zero(order) for order in exponent.orders[1:]):
        return _ONE["EXP"](exponent * _ONE["LOG"](base))
    count = fixed.recorded if isinstance(fixed, Recorded) else fixed
    # any other exponent is recorded in another way
    if abs(count) <= _LARGEST_POWER and count == int(count) and fixed == count:
        return _whole_power(base, int(count))

    def slopes(x: Any) -> Sequence[Any]:
        # n x^(n-1), not n x^n / x, which is none at x = 0
        value, first, second, third = (of_two("POWER", x, n - float(k)) for k in range(4))
        falling = n * (n - 1.0)
        return value, n * first, falling * second, falling * (n - 2.0) * third

    return _through(slopes)(base)


def _whole_power(base: JetNumber, count: int) -> JetNumber:
    if count == 0:
        return JetNumber([1.0, 0.0, 0.0, 0.0])
    product = base
    for _ in range(abs(count) - 1):
        product = product * base
    return product if count > 0 else 1.0 / product


def _step(operation: str, x: Any) -> Any:
    """A sign, or the nearest whole number, of a float, of rows or of a recorded number."""
    if isinstance(x, Recorded):
        return x.apply(operation)
    return np.rint(x) if operation == "WHOLE" else np.sign(x)


_ONE: dict[str, Callable[[JetNumber], JetNumber]] = {
    **{operation: _through(slopes) for operation, slopes in SLOPES.items()},
    "NEGATE": lambda a: JetNumber([_opposite(order) for order in a.orders]),
    "MAGNITUDE": lambda a: (a < 0.0).choose(-a, a),
    "SIGN": lambda a: JetNumber([_step("SIGN", a.orders[0]), 0.0, 0.0, 0.0]),
    "WHOLE": lambda a: JetNumber([_step("WHOLE", a.orders[0]), 0.0, 0.0, 0.0]),
}
_TWO: dict[str, Callable[[JetNumber, JetNumber], JetNumber]] = {
    "ADD": lambda a, b: JetNumber([*map(_sum, a.orders, b.orders)]),
    "SUBTRACT": lambda a, b: a + -b,
    "MULTIPLY": _times,
    "DIVIDE": _over,
    "ATAN2": _angle,
    "POWER": _power,
    "LARGER": lambda a, b: (b > a).choose(b, a),
    "SMALLER": lambda a, b: (b < a).choose(b, a),
}
