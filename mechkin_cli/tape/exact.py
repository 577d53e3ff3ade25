"""Recording with exact numbers: a tape whose constants are what the text says, not their doubles.

Every number that is written, and every constant that knows what it was rounded from (`exact`), is
taken as it is. Doubles decide: each comparison, choice, sign and whole number is what the doubles
of the recording find, so that the structure is that of the ordinary build and the tape holds
nothing but + - * / sqrt, magnitudes and elementary functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from math import nan
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.exact import double_double, fraction_of
from mechkin_cli.record import NamedTuple
from mechkin_cli.tape.decimals import Approximation, of_fraction, parts, replay, run
from mechkin_cli.tape.recorder import Recorder, Traced, register, renumbered
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


DECIDED = (*CONDITIONS, Operation.SIGN, Operation.POWER_OF_TWO, Operation.WHOLE)
"""Operations whose results are decisions: constants of the structure."""

_LARGEST_POWER = 64
"""Whole exponents up to this one are products."""


class ExactStep(NamedTuple):
    """A register with its operation and operands; a number of the text has none."""

    register: int
    operation: Operation | None
    operands: tuple[int, ...]


class ExactRecorder(Recorder):
    """Records without inputs: `written` numbers and constants are all that there is."""

    is_settled = True

    def __init__(self) -> None:
        super().__init__((), ())
        self.exact: dict[int, Fraction] = {}
        self._told: dict[tuple[int, int], int] = {}
        self._origin: dict[int, int] = {}
        self._registers: dict[tuple[Fraction, float, float], int] = {}

    def written(self, value: float, number: Fraction) -> Traced:
        """A number that the text says, and its double."""
        return self.number(self._exact(value, number))

    def constant(self, value: float) -> int:
        """The register of a constant, taken for the number that it stands for."""
        if not math.isfinite(value):
            return super().constant(value)
        return self._exact(float(value), fraction_of(value))

    def compute(self, operation: Operation, *operands: int) -> int:
        """The register of an operation's result; what doubles decide is decided."""
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
        found = super().compute(operation, *operands)
        origins = tuple(map(self.origin, operands))
        if origins != operands:
            self._origin.setdefault(found, self.compute(operation, *origins))
        return found

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """What a condition finds of the doubles; nothing hangs on it later."""
        return meaning(condition)(self.values[a], self.values[b]) != 0.0

    def by_rounding(self, condition: Undecided) -> Undecided:
        """The way that does not hold, with the doubles of the way that doubles take."""
        return _Exactly(self, condition)

    def told_as(self, register: int, told: int) -> int:
        """The exact number of one register with the double of another."""
        if self.values[register] == self.values[told]:
            return register
        if (register, told) not in self._told:
            number = self._told[register, told] = self._register(self.values[told])
            self._origin[number] = self.origin(register)
            if register in self._written:
                self._written[number] = self._written[register]
            else:
                self.exact[number] = self.exact[register]
        return self._told[register, told]

    def origin(self, register: int) -> int:
        """The register whose exact number one has under another double, or computed in the same way
        of such; else itself."""
        return self._origin.get(register, register)

    def exact_tape(self, outputs: Iterable[int]) -> ExactTape:
        """The tape of some registers."""
        outputs = list(outputs)
        needed = self._needed(list(outputs))
        leaves = [r for r in needed if r not in self._written]
        given = [r for r in leaves if self._is_rounded(r)]
        kept = [r for r in leaves if not self._is_rounded(r)]
        computed = [r for r in needed if r in self._written]
        number = {r: k for k, r in enumerate((*given, *kept, *computed))}
        written = [self._written[r] for r in computed]
        operands = [renumbered(instruction, number) for instruction in written]
        tape = Tape(
            tuple(f"x{k}" for k in range(len(given))),
            np.array([self.values[r] for r in kept], dtype=np.float64),
            np.array([instruction[0] for instruction in written], dtype=np.uint8),
            np.array(operands, dtype=np.int32).reshape(-1, 3),
            np.array([number[r] for r in outputs], dtype=np.int32),
            np.zeros((0, 3), dtype=np.int32),
            np.zeros(0, dtype=np.bool_),
            np.zeros(0, dtype=np.bool_),
        )
        numbers = tuple(self.exact[r] for r in given)
        pairs = [double_double(value) for value in numbers]
        values = np.array(pairs, dtype=np.float64).reshape(-1, 2)
        return ExactTape(tape, numbers, values, tuple(given))

    def steps_to(self, wanted: int) -> Iterator[ExactStep]:
        """How a register comes about, from the numbers of the text on."""
        for number in self._needed([wanted]):
            if number in self._written:
                operation, *operands = self._written[number]
                yield ExactStep(number, operation, tuple(operands[: ARITY[operation]]))
            else:
                yield ExactStep(number, None, ())

    def undivided(self, registers: Sequence[int]) -> list[int]:
        """Numbers without the last numbers by which all of them were divided or multiplied, which
        are not zero: in the same ratios, but for the sign of all."""
        found = list(registers)
        while True:
            factors: set[tuple[Operation, int]] = set()
            rests = []
            for number in found:
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
                    return found
            if len(factors) != 1:
                return found
            found = rests

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
        count, square, found = abs(int(exponent)), base, None
        while count:
            if count & 1:
                found = square if found is None else self.compute(Operation.MULTIPLY, found, square)
            count >>= 1
            if count:
                square = self.compute(Operation.MULTIPLY, square, square)
        assert found is not None
        if exponent > 0:
            return found
        return self.compute(Operation.DIVIDE, self.constant(1.0), found)


class _Exactly(Undecided):
    """A condition that exact numbers do not pass for."""

    __slots__ = ("condition", "recorder")

    def __init__(self, recorder: ExactRecorder, condition: Undecided) -> None:
        self.recorder, self.condition = recorder, condition

    def choose(self, chosen: Any, other: Any) -> Any:
        """The exact number of `other`, with the double of the one that doubles choose."""
        recorder = self.recorder
        registers = [register(recorder, one) for one in (chosen, other)]
        told = registers[0] if self.condition else registers[1]
        return recorder.number(recorder.told_as(registers[1], told))


# Recording with exact numbers of which some can be shifted later.
#
# A shift is a number of its own, zero when it is recorded. As long as no decision of the doubles is
# another one for the shifted numbers, the tape tells what the text with them says.

_ZERO = Fraction(0)


class ShiftingRecorder(ExactRecorder):
    """An `ExactRecorder` with leaves: numbers that are zero, and may be given others."""

    def __init__(self) -> None:
        super().__init__()
        self._leaves: dict[int, int] = {}
        self._hanging: list[int] = []
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
        self.exact.update(shifts)
        try:
            yield
        finally:
            self.exact.update(dict.fromkeys(shifts, _ZERO))

    def compute(self, operation: Operation, *operands: int) -> int:
        """As `ExactRecorder.compute`; decisions are kept."""
        if operation in DECIDED or operation in (Operation.LARGER, Operation.SMALLER):
            self._decided(operation, operands)
        return super().compute(operation, *operands)

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """As `ExactRecorder.guard`; decisions are kept."""
        if not advice:
            self._decided(condition, (a, b))
        return super().guard(condition, a, b, advice=advice)

    def turns(self, leaf: int, amount: Fraction) -> bool:
        """Whether a decision is another one where a leaf has this amount or its negative.

        Raises:
            NotEnclosed: what is decided by is not defined there.
        """
        asked = self._decided_by(leaf)
        if not asked:
            return False
        registers = sorted({r for operation, *ab in asked for r in ab[: ARITY[operation]]})
        for shift in (_ZERO, amount, -amount):
            with self.shifted({leaf: shift}):
                values = [near.value for near in replay(self.exact_tape(registers))]
            at = dict(zip(registers, values, strict=True))
            found = [_outcome(op, [at[r] for r in ab[: ARITY[op]]]) for op, *ab in asked]
            if not shift:
                own = found
            elif found != own:
                return True
        return False

    def _decided(self, operation: Operation, operands: Sequence[int]) -> None:
        a, b, c = (*operands, 0, 0)[:3]
        self._decisions[operation, a, b, c] = None

    def _decided_by(self, leaf: int) -> list[Instruction]:
        """The decisions that hang on a leaf."""
        if len(self._hanging) != len(self.values):
            self._hanging = self._all_hanging()
        bit, hanging = 1 << self._leaves[leaf], self._hanging
        return [
            (op, a, b, c)
            for op, a, b, c in self._decisions
            if any(hanging[register] & bit for register in (a, b, c)[: ARITY[op]])
        ]

    def _all_hanging(self) -> list[int]:
        """For every register the leaves that it hangs on, as bits."""
        hanging = [0] * len(self.values)
        for leaf, number in self._leaves.items():
            hanging[leaf] = 1 << number
        for result in sorted(self._written):
            operation, *operands = self._written[result]
            for operand in operands[: ARITY[operation]]:
                hanging[result] |= hanging[operand]
        return hanging

    def _is_rounded(self, register: int) -> bool:
        return register in self._leaves or super()._is_rounded(register)


def _outcome(operation: Operation, values: Sequence[Decimal]) -> float:
    """What is decided of exact numbers."""
    if operation is Operation.LARGER:
        return float(values[1] > values[0])
    if operation in (Operation.SMALLER, Operation.LESS):
        return float(values[0] < values[1])
    if operation is Operation.NOT_MORE:
        return float(values[0] <= values[1])
    if operation is Operation.EQUAL:
        return float(values[0] == values[1])
    return float(meaning(operation)(*map(float, values)))


# Exact numbers that differ from row to row: a tape over the rows, its constants those of a
# recording of exact numbers (`exact_recorder`).
#
# Rows enter as doubles that are exact as they are (numbers of rows, choices) or picked from a list
# of recorded numbers. Unlike constants, rows are chosen by the double-doubles themselves.


class Picked(NamedTuple):
    """Recorded numbers or floats, and which of them each row has (rows,)."""

    numbers: Sequence[Any]
    which: NDArray[np.intp]


class _Given(NamedTuple):
    """An input over the rows: doubles (rows,), or which of some numbers each row has."""

    rows: NDArray[Any]
    near: list[Approximation] | None

    @property
    def parts(self) -> Floats:
        """In double-double (2, rows)."""
        if self.near is None:
            return np.stack([self.rows, np.zeros(self.rows.size)])
        pairs: Floats = np.array([parts(one)[:2] for one in self.near])
        over_rows: Floats = pairs[self.rows].T
        return over_rows

    def at(self, row: int) -> Approximation:
        """The number of a row, not rounded."""
        place = self.rows[row]
        return of_fraction(Fraction(float(place))) if self.near is None else self.near[place]


class RowsTape(NamedTuple):
    """A tape over rows.

    Attributes:
        tape: from the rows' inputs; `constants` are high parts.
        constants: the constants, not rounded.
        given: every input.
    """

    tape: Tape
    constants: list[Approximation]
    given: list[_Given]


class ExactRows(RowRecorder):
    """Records what is computed over `rows` rows.

    Args:
        recorder: holds the numbers that are the same in all rows.
        rows: their number.
    """

    def __init__(self, recorder: ExactRecorder, rows: int) -> None:
        super().__init__(0)
        self.recorder, self.rows = recorder, rows
        self._given: dict[int, Floats | Picked] = {}

    def given(self, values: Floats | Picked) -> RowNumber:
        """A number of each row: doubles (rows,) that are exact, or picked recorded numbers."""
        number = self._register(nan)
        self._given[number] = values
        return self.number(number)

    def double_doubles(self, numbers: Sequence[Any], lanes: int = 0) -> Floats:
        """Some numbers in double-double (numbers, 2, rows), high and low."""
        made = self._tape(numbers)
        constants = np.array([parts(one)[:2] for one in made.constants]).reshape(-1, 2)
        rows = np.stack([given.parts for given in made.given])
        found = replay_precise(compiled(made.tape), rows, constants[:, 1], lanes)[0]
        return np.ascontiguousarray(found.transpose(1, 2, 0))

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
        made = self._tape(numbers)
        rows = (
            [*(given.at(row) for given in made.given), *made.constants] for row in range(self.rows)
        )
        found = [[parts(near) for near in row] for row in run(made.tape, rows)]
        return np.ascontiguousarray(np.array(found).transpose(1, 2, 0))

    def _tape(self, numbers: Sequence[Any]) -> RowsTape:
        outputs = [register(self, number) for number in numbers]
        needed = self._needed(list(outputs))
        given = [r for r in needed if r in self._given]
        if not given:
            # rows are counted by an input
            given = [self.given(np.zeros(self.rows)).register]
        constants = [r for r in needed if r in self.constants]
        computed = [r for r in needed if r in self._written]
        number = {r: k for k, r in enumerate((*given, *constants, *computed))}
        near = self._near([self.constants[r] for r in constants])
        written = [self._written[r] for r in computed]
        operands = [renumbered(instruction, number) for instruction in written]
        tape = Tape(
            tuple(f"r{k}" for k in range(len(given))),
            np.array([float(one.value) for one in near], dtype=np.float64),
            np.array([instruction[0] for instruction in written], dtype=np.uint8),
            np.array(operands, dtype=np.int32).reshape(-1, 3),
            np.array([number[r] for r in outputs], dtype=np.int32),
            np.zeros((0, 3), dtype=np.int32),
            np.zeros(0, dtype=np.bool_),
            np.zeros(0, dtype=np.bool_),
        )
        return RowsTape(tape, near, [self._over_rows(self._given[r]) for r in given])

    def _over_rows(self, given: Floats | Picked) -> _Given:
        if isinstance(given, Picked):
            return _Given(given.which, self._near(given.numbers))
        return _Given(given, None)

    def _near(self, numbers: Sequence[Any]) -> list[Approximation]:
        """Floats, and numbers of the recording, to all their digits."""
        registers = [register(self.recorder, n) for n in numbers if isinstance(n, Traced)]
        traced = iter(replay(self.recorder.exact_tape(registers)))
        return [
            next(traced) if isinstance(n, Traced) else of_fraction(fraction_of(n)) for n in numbers
        ]
