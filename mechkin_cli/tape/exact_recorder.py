"""Recording with exact numbers: a tape whose constants are what the text says, not their doubles.

Every number that is written, and every constant that knows what it was rounded from (`exact`), is
taken as it is. Doubles decide: each comparison, choice, sign and whole number is what the doubles
of the recording find, so that the structure is that of the ordinary build and the tape holds
nothing but + - * / sqrt, magnitudes and elementary functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mechkin_cli.exact import double_double, fraction_of
from mechkin_cli.tape.floats import meaning
from mechkin_cli.tape.operations import ARITY, CONDITIONS, Operation
from mechkin_cli.tape.recorder import Recorder, renumbered
from mechkin_cli.tape.scalars import Undecided
from mechkin_cli.tape.tape import Tape
from mechkin_cli.tape.traced import register

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.tape.traced import Traced

DECIDED = (*CONDITIONS, Operation.SIGN, Operation.POWER_OF_TWO, Operation.WHOLE)
"""Operations whose results are decisions: constants of the structure."""

_LARGEST_POWER = 64
"""Whole exponents up to this one are products."""


class ExactTape(NamedTuple):
    """A tape without guards, the exact numbers that are its inputs, these as double-doubles
    (inputs, 2), and the registers in which they are recorded."""

    tape: Tape
    numbers: tuple[Fraction, ...]
    values: Floats
    given: tuple[int, ...]


class Step(NamedTuple):
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

    def steps_to(self, wanted: int) -> Iterator[Step]:
        """How a register comes about, from the numbers of the text on."""
        for number in self._needed([wanted]):
            if number in self._written:
                operation, *operands = self._written[number]
                yield Step(number, operation, tuple(operands[: ARITY[operation]]))
            else:
                yield Step(number, None, ())

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
