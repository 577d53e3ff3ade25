"""Recording with exact numbers of which some can be shifted later.

A shift is a number of its own, zero when it is recorded. As long as no decision of the doubles is
another one for the shifted numbers, the tape tells what the text with them says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING

from mechkin_cli.tape.decimal_replay import replay
from mechkin_cli.tape.exact_recorder import DECIDED, ExactRecorder
from mechkin_cli.tape.floats import meaning
from mechkin_cli.tape.operations import ARITY, Operation

if TYPE_CHECKING:
    from mechkin_cli.tape.recorder import Instruction

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
