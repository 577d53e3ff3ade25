"""Numbers that differ from row to row, written down as they are computed with: programs of a plan.

Nothing is decided on them, as nothing is on the rows of an array: a quotient by zero or the root of
a negative number has no value in that row. What is constant over the rows, a float or a number that
is itself recorded elsewhere, becomes a constant of the program, each where it is met: equal
constants are not made one, so that the program of varied parameters has the same structure.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import nan
from typing import Any

from mechkin_cli.tape.operations import Operation
from mechkin_cli.tape.recorder import Instruction, Recorder, renumbered
from mechkin_cli.tape.traced import Traced, TraceLost


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
