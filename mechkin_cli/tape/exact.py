"""Recording with exact numbers: a tape whose constants are those of the text, not their doubles.

Every number of the text, and every constant that knows what it was rounded from (`exact`), is taken
as it is. Doubles decide: each comparison, choice, sign and whole number is that of the doubles of
the recording, so that the structure is that of the ordinary build and the tape holds nothing but
+ - * / sqrt, magnitudes and elementary functions.

`ExactRecorder` records numbers, `ShiftingRecorder` numbers of which some can be shifted later,
`ExactRows` numbers that differ from row to row.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.exact import double_double, fraction_of
from mechkin_cli.tape.decimals import Approximation, of_fraction, parts, replay, run
from mechkin_cli.tape.recorder import Recorder, Traced, register
from mechkin_cli.tape.row_programs import RowNumber, RowRecorder
from mechkin_cli.tape.scalars import Undecided
from mechkin_cli.tape.tape import (
    ARITY,
    CONDITIONS,
    ExactTape,
    Operation,
    Tape,
    compiled,
    meaning,
    replay_precise,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats
    from mechkin_cli.tape.recorder import Instruction

    _Which = NDArray[np.intp] | Callable[[], NDArray[np.intp]]
    _Picked = tuple[Sequence[Any], _Which]
    """Recorded numbers or floats, and which of them each row has (rows,), also as found by a call
    when the numbers are computed, which may be shifted then."""


DECIDED = (*CONDITIONS, Operation.SIGN, Operation.POWER_OF_TWO, Operation.WHOLE)
"""Operations whose results are decisions: constants of the structure."""

_LARGEST_POWER = 64
"""Whole exponents up to this one are products."""


class ExactRecorder(Recorder):
    """Records without inputs, only `written` numbers and constants."""

    is_settled = True

    def __init__(self) -> None:
        super().__init__((), ())
        self.exact: dict[int, Fraction] = {}
        self._doubles: dict[tuple[int, int], int] = {}
        self._origin: dict[int, int] = {}
        self._registers: dict[tuple[Fraction, float, float], int] = {}

    def written(self, value: float, number: Fraction) -> Traced:
        """A number of the text, and its double."""
        return self.number(self._exact(value, number))

    def constant(self, value: float) -> int:
        """The register of a constant, as the number it was rounded from."""
        if not math.isfinite(value):
            return super().constant(value)
        return self._exact(float(value), fraction_of(value))

    def compute(self, operation: Operation, *operands: int) -> int:
        """The register of an operation's result; decisions are made by the doubles."""
        values = [self.values[register] for register in operands]
        if operation in DECIDED:
            return self.constant(meaning(operation)(*values))
        if operation is Operation.CHOOSE:
            return operands[1] if values[0] != 0.0 else operands[2]
        if operation in (Operation.LARGER, Operation.SMALLER):
            first, second = values
            other = second > first if operation is Operation.LARGER else second < first
            return operands[1] if other else operands[0]
        if operation is Operation.POWER and operands[1] in self.exact:
            power = self._power(operands[0], self.exact[operands[1]])
            if power is not None:
                return power
        result = super().compute(operation, *operands)
        origins = tuple(map(self.origin, operands))
        if origins != operands:
            self._origin.setdefault(result, self.compute(operation, *origins))
        return result

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """The truth of a condition of the doubles, which no replay checks again."""
        return meaning(condition)(self.values[a], self.values[b]) != 0.0

    def by_rounding(self, condition: Undecided) -> Undecided:
        """The branch of a condition that does not hold, with the doubles of the branch taken."""
        return _ExactBranch(self, condition)

    def with_double(self, register: int, other: int) -> int:
        """The exact number of one register with the double of another."""
        if self.values[register] == self.values[other]:
            return register
        if (register, other) not in self._doubles:
            number = self._doubles[register, other] = self._register(self.values[other])
            self._origin[number] = self.origin(register)
            if register in self._written:
                self._written[number] = self._written[register]
            else:
                self.exact[number] = self.exact[register]
        return self._doubles[register, other]

    def without_zero(self, number: Traced) -> float | Traced:
        """As `Recorder.without_zero`: of one that is zero in the text."""
        value = self.values[number.register]
        return value if value == 0.0 and self.exact.get(number.register) == 0 else number

    def origin(self, register: int) -> int:
        """The register from which `with_double` made this one, or its operands; else itself."""
        return self._origin.get(register, register)

    def exact_tape(self, outputs: Iterable[int]) -> ExactTape:
        """The tape of some registers."""
        outputs = list(outputs)
        needed = self._needed(outputs)
        leaves = [r for r in needed if r not in self._written]
        inputs = [r for r in leaves if self._is_rounded(r)]
        constants = [r for r in leaves if not self._is_rounded(r)]
        names = tuple(f"x{k}" for k in range(len(inputs)))
        values = [self.values[r] for r in constants]
        tape = self._tape(names, [*inputs, *constants], values, needed, outputs)
        numbers = tuple(self.exact[r] for r in inputs)
        pairs = np.array([double_double(value) for value in numbers], dtype=np.float64)
        return ExactTape(tape, numbers, pairs.reshape(-1, 2), tuple(inputs))

    def steps_to(self, register: int) -> Iterator[tuple[int, Operation | None, tuple[int, ...]]]:
        """How to compute a register: those it depends on, each with its operation and operands; a
        number of the text has None and none."""
        for number in self._needed([register]):
            if number in self._written:
                operation, *operands = self._written[number]
                yield number, operation, tuple(operands[: ARITY[operation]])
            else:
                yield number, None, ()

    def undivided(self, registers: Sequence[int]) -> list[int]:
        """Numbers without the last numbers by which all of them were divided or multiplied, which
        are not zero: in the same ratios, but for the sign of all."""
        numbers = list(registers)
        while True:
            factors: set[tuple[Operation, int]] = set()
            rests = []
            for number in numbers:
                if self.exact.get(number) == 0:
                    rests.append(number)
                    continue
                operation, a, b, _ = self._written.get(number, (None, 0, 0, 0))
                if operation is Operation.DIVIDE:
                    factors.add((operation, b))
                    rests.append(a)
                elif operation is Operation.NEGATE:
                    factors.add((operation, 0))
                    rests.append(a)
                elif operation is Operation.MULTIPLY and self.exact.get(a):
                    factors.add((operation, a))
                    rests.append(b)
                else:
                    return numbers
            if len(factors) != 1:
                return numbers
            numbers = rests

    def _is_rounded(self, register: int) -> bool:
        return register in self.exact and self.exact[register] != self.values[register]

    def _exact(self, value: float, number: Fraction) -> int:
        key = (number, value, math.copysign(1.0, value))
        if key not in self._registers:
            self._registers[key] = register = self._register(value)
            self.exact[register] = number
        return self._registers[key]

    def _power(self, base: int, exponent: Fraction) -> int | None:
        """A power to a whole number by squaring; None for others."""
        if exponent.denominator != 1 or not 0 < abs(exponent) <= _LARGEST_POWER:
            return None
        count, square, power = abs(int(exponent)), base, None
        while count:
            if count & 1:
                power = square if power is None else self.compute(Operation.MULTIPLY, power, square)
            count >>= 1
            if count:
                square = self.compute(Operation.MULTIPLY, square, square)
        assert power is not None
        if exponent > 0:
            return power
        return self.compute(Operation.DIVIDE, self.constant(1.0), power)


class _ExactBranch(Undecided):
    """A condition that never holds for exact numbers."""

    __slots__ = ("condition", "recorder")

    def __init__(self, recorder: ExactRecorder, condition: Undecided) -> None:
        self.recorder, self.condition = recorder, condition

    def choose(self, chosen: Any, other: Any) -> Any:
        """The exact number of `other`, with the double of the one that doubles choose."""
        recorder = self.recorder
        registers = [register(recorder, number) for number in (chosen, other)]
        taken = registers[0] if self.condition else registers[1]
        return recorder.number(recorder.with_double(registers[1], taken))


_ZERO = Fraction(0)


class ShiftingRecorder(ExactRecorder):
    """An `ExactRecorder` with leaves: shifts, which are zero when they are recorded.

    As long as no decision of the doubles is another one for the shifted numbers, the tape computes
    with shifts what a text with the shifted numbers would give.
    """

    def __init__(self) -> None:
        super().__init__()
        self._leaves: dict[int, int] = {}
        self._dependence: list[int] = []
        self._decisions: dict[Instruction, None] = {}

    def leaf(self) -> int:
        """The register of a new shift."""
        register = self._register(0.0)
        self.exact[register] = _ZERO
        self._leaves[register] = len(self._leaves)
        return register

    @contextmanager
    def shifted(self, shifts: Mapping[int, Fraction]) -> Iterator[None]:
        """Within the context, replays take these numbers for the leaves' zeros."""
        before = {leaf: self.exact[leaf] for leaf in shifts}
        self.exact.update(shifts)
        try:
            yield
        finally:
            self.exact.update(before)

    @property
    def shifts(self) -> dict[int, Fraction]:
        """The leaves that are not zero now."""
        return {leaf: self.exact[leaf] for leaf in self._leaves if self.exact[leaf]}

    def compute(self, operation: Operation, *operands: int) -> int:
        """As `ExactRecorder.compute`; decisions are remembered."""
        if operation in DECIDED or operation in (Operation.LARGER, Operation.SMALLER):
            self._decided(operation, operands)
        return super().compute(operation, *operands)

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """As `ExactRecorder.guard`; decisions are remembered."""
        if not advice:
            self._decided(condition, (a, b))
        return super().guard(condition, a, b, advice=advice)

    def turns(self, leaf: int, amount: Fraction) -> bool:
        """Whether a decision is another one where a leaf has this amount or its negative.

        Raises:
            NotEnclosed: an operand of a decision is not defined there.
        """
        decisions = self._decided_by(leaf)
        if not decisions:
            return False
        registers = sorted({r for operation, *ab in decisions for r in ab[: ARITY[operation]]})
        for shift in (_ZERO, amount, -amount):
            with self.shifted({leaf: shift}):
                values = [near.value for near in replay(self.exact_tape(registers))]
            at = dict(zip(registers, values, strict=True))
            outcomes = [_outcome(op, [at[r] for r in ab[: ARITY[op]]]) for op, *ab in decisions]
            if not shift:
                unshifted = outcomes
            elif outcomes != unshifted:
                return True
        return False

    def _decided(self, operation: Operation, operands: Sequence[int]) -> None:
        a, b, c = (*operands, 0, 0)[:3]
        self._decisions[operation, a, b, c] = None

    def _decided_by(self, leaf: int) -> list[Instruction]:
        """The decisions that depend on a leaf."""
        if len(self._dependence) != len(self.values):
            self._dependence = self._leaves_of_all()
        bit, dependence = 1 << self._leaves[leaf], self._dependence
        return [
            (op, a, b, c)
            for op, a, b, c in self._decisions
            if any(dependence[register] & bit for register in (a, b, c)[: ARITY[op]])
        ]

    def _leaves_of_all(self) -> list[int]:
        """For every register the leaves that it depends on, as bits."""
        leaves = [0] * len(self.values)
        for leaf, number in self._leaves.items():
            leaves[leaf] = 1 << number
        for result in sorted(self._written):
            operation, *operands = self._written[result]
            for operand in operands[: ARITY[operation]]:
                leaves[result] |= leaves[operand]
        return leaves

    def _is_rounded(self, register: int) -> bool:
        return register in self._leaves or super()._is_rounded(register)


def _outcome(operation: Operation, values: Sequence[Decimal]) -> float:
    """The result of a decision on exact numbers."""
    if operation is Operation.LARGER:
        return float(values[1] > values[0])
    if operation in (Operation.SMALLER, Operation.LESS):
        return float(values[0] < values[1])
    if operation is Operation.NOT_MORE:
        return float(values[0] <= values[1])
    if operation is Operation.EQUAL:
        return float(values[0] == values[1])
    return float(meaning(operation)(*map(float, values)))


class ExactRows(RowRecorder):
    """Records exact numbers over `rows` rows, with the numbers of another recording as constants.

    Rows enter as doubles that are exact as they are (numbers of rows, choices) or picked from a
    list of recorded numbers. Unlike constants, rows are chosen by the double-doubles themselves.

    Args:
        recorder: holds the numbers that are the same in all rows.
        rows: their number.
    """

    def __init__(self, recorder: ExactRecorder, rows: int) -> None:
        super().__init__(0)
        self.recorder, self.rows = recorder, rows
        self._given: dict[int, Floats | _Picked] = {}

    def given(self, values: Floats) -> RowNumber:
        """A number of each row: doubles (rows,) that are exact."""
        return self._enter(values)

    def picked(self, numbers: Sequence[Any], which: _Which) -> RowNumber:
        """A number of each row, picked from recorded numbers or floats by place (rows,), or by
        what a call gives for these."""
        return self._enter((numbers, which))

    def changes(self, number: Any) -> tuple[Floats, Floats] | None:
        """A number of each row (rows,) without shifts, and how shifts change it; None where nothing
        is shifted."""
        recorder = self.recorder
        shifts = recorder.shifts if isinstance(recorder, ShiftingRecorder) else {}
        if not shifts:
            return None
        shifted = self.double_doubles([number])[0]
        assert isinstance(recorder, ShiftingRecorder)
        with recorder.shifted(dict.fromkeys(shifts, _ZERO)):
            own = self.double_doubles([number])[0]
        high, low = shifted - own
        return own[0], high + low

    def _enter(self, values: Floats | _Picked) -> RowNumber:
        number = self._register(nan)
        self._given[number] = values
        return self.number(number)

    def double_doubles(self, numbers: Sequence[Any], lanes: int = 0) -> Floats:
        """Some numbers in double-double (numbers, 2, rows), high and low."""
        tape, constants, inputs = self._tape_over_rows(numbers)
        low = np.array([parts(constant)[1] for constant in constants])
        rows = np.stack([self._pairs(values) for values in inputs])
        outputs = replay_precise(compiled(tape), rows, low, lanes)[0]
        return np.ascontiguousarray(outputs.transpose(1, 2, 0))

    def enclosures(self, numbers: Sequence[Any]) -> Floats:
        """Some numbers enclosed (numbers, 3, rows): as in double-double, and radii about that.

        Raises:
            NotEnclosed: one is not defined in some row.
        """
        return self._by_decimals(numbers)

    def rounded(self, numbers: Sequence[Any]) -> Floats:
        """As `double_doubles`, by decimals: slower, and both parts the nearest."""
        return np.ascontiguousarray(self._by_decimals(numbers)[:, :2])

    def _by_decimals(self, numbers: Sequence[Any]) -> Floats:
        tape, constants, inputs = self._tape_over_rows(numbers)
        columns = [self._approximations(values) for values in inputs]
        rows = ([*row, *constants] for row in zip(*columns, strict=True))
        outputs = np.array([[parts(near) for near in row] for row in run(tape, rows)])
        return np.ascontiguousarray(outputs.transpose(1, 2, 0))

    def _tape_over_rows(
        self, numbers: Sequence[Any]
    ) -> tuple[Tape, list[Approximation], list[Floats | _Picked]]:
        """A tape with the high parts of its constants, all constants, and all inputs."""
        outputs = [register(self, number) for number in numbers]
        needed = self._needed(outputs)
        # without any input there would be no number of rows
        inputs = [r for r in needed if r in self._given] or [
            self.given(np.zeros(self.rows)).register
        ]
        leaves = [r for r in needed if r in self.constants]
        constants = self._near([self.constants[r] for r in leaves])
        high = [float(constant.value) for constant in constants]
        names = tuple(f"r{k}" for k in range(len(inputs)))
        tape = self._tape(names, [*inputs, *leaves], high, needed, outputs)
        return tape, constants, [self._given[r] for r in inputs]

    def _pairs(self, values: Floats | _Picked) -> Floats:
        """An input in double-double (2, rows)."""
        if not isinstance(values, tuple):
            return np.stack([values, np.zeros(self.rows)])
        numbers, which = values
        pairs: Floats = np.array([parts(near)[:2] for near in self._near(numbers)])
        return pairs[which() if callable(which) else which].T

    def _approximations(self, values: Floats | _Picked) -> list[Approximation]:
        """An input of every row, not rounded."""
        if not isinstance(values, tuple):
            return [of_fraction(Fraction(value)) for value in map(float, values)]
        numbers, which = values
        near = self._near(numbers)
        return [near[k] for k in (which() if callable(which) else which)]

    def _near(self, numbers: Sequence[Any]) -> list[Approximation]:
        """Floats, and numbers of the recording, to all their digits."""
        registers = [register(self.recorder, n) for n in numbers if isinstance(n, Traced)]
        traced = iter(replay(self.recorder.exact_tape(registers)))
        return [
            next(traced) if isinstance(n, Traced) else of_fraction(fraction_of(n)) for n in numbers
        ]
