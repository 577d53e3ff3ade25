"""Recording: instructions as they are computed, each only once; guards; the tape of some outputs.

What no output and no guard needs is left out of a tape, and so are the registers of equal
instructions: the code may compute a frame ten times over.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tape.floats import meaning
from mechkin_cli.tape.operations import ARITY, Operation
from mechkin_cli.tape.tape import Tape

if TYPE_CHECKING:
    from mechkin_cli.tape.scalars import Undecided
    from mechkin_cli.tape.traced import Traced

Instruction = tuple[Operation, int, int, int]


class Recorder:
    """Grows by `constant`, `compute` and `guard`; register numbers are its own.

    Attributes:
        values: what every register held when it was recorded.
        is_settled: whether no other numbers will be put in.
        holds_others: whether numbers of other recordings are constants of this one.
    """

    holds_others = False
    is_settled = False

    def __init__(self, inputs: Sequence[str], values: Sequence[float]) -> None:
        self.inputs = tuple(inputs)
        self.values: list[float] = list(values)
        self._constants: dict[tuple[float, float], int] = {}
        self._instructions: dict[Instruction, int] = {}
        self._written: dict[int, Instruction] = {}
        self._guards: dict[Instruction, bool] = {}
        self._serious: set[Instruction] = set()

    def constant(self, value: float) -> int:
        """The register of a constant; zeros of either sign are two constants."""
        key = (value, math.copysign(1.0, value))
        if key not in self._constants:
            self._constants[key] = self._register(value)
        return self._constants[key]

    def compute(self, operation: Operation, *operands: int) -> int:
        """The register of an operation's result."""
        a, b, c = (*operands, 0, 0)[:3]
        instruction = (operation, a, b, c)
        if instruction not in self._instructions:
            value = meaning(operation)(*(self.values[register] for register in operands))
            number = self._instructions[instruction] = self._register(value)
            self._written[number] = instruction
        return self._instructions[instruction]

    def number(self, register: int) -> Traced:
        """The number in a register."""
        from mechkin_cli.tape.traced import Traced

        return Traced(self, register)

    def guard(self, condition: Operation, a: int, b: int, *, advice: bool = False) -> bool:
        """What a condition finds now; a replay must find the same, or where that is only `advice`
        say so."""
        instruction = (condition, a, b, 0)
        if not advice:
            self._serious.add(instruction)
        if instruction not in self._guards:
            found = meaning(condition)(self.values[a], self.values[b]) != 0.0
            self._guards[instruction] = found
        return self._guards[instruction]

    def by_rounding(self, condition: Undecided) -> Undecided:
        """A condition of this recording on whose ways numbers are the same but for rounding."""
        return condition

    def tape(self, outputs: Iterable[int], *, guarded: bool = True) -> Tape:
        """The tape of some registers, with all guards so far or with none."""
        outputs = list(outputs)
        asked = self._guards if guarded else {}
        needed = self._needed([*outputs, *(r for g in asked for r in g[1:3])])
        first = len(self.inputs)
        computed = [r for r in needed if r in self._written]
        constants = [r for r in needed if r >= first and r not in self._written]
        number = {r: r for r in range(first)}
        number |= {r: first + k for k, r in enumerate((*constants, *computed))}
        written = [self._written[r] for r in computed]
        operands = [renumbered(instruction, number) for instruction in written]
        guards = [(g[0], number[g[1]], number[g[2]]) for g in asked]
        return Tape(
            self.inputs,
            np.array([self.values[r] for r in constants], dtype=np.float64),
            np.array([instruction[0] for instruction in written], dtype=np.uint8),
            np.array(operands, dtype=np.int32).reshape(-1, 3),
            np.array([number[r] for r in outputs], dtype=np.int32),
            np.array(guards, dtype=np.int32).reshape(-1, 3),
            np.array(list(asked.values()), dtype=np.bool_),
            np.array([g not in self._serious for g in asked], dtype=np.bool_),
        )

    def _register(self, value: float) -> int:
        self.values.append(value)
        return len(self.values) - 1

    def _needed(self, wanted: list[int]) -> list[int]:
        """The registers that some depend on, themselves included, in order."""
        found: set[int] = set()
        while wanted:
            register = wanted.pop()
            if register in found:
                continue
            found.add(register)
            if register in self._written:
                operation, *operands = self._written[register]
                wanted += operands[: ARITY[operation]]
        return sorted(found)


def renumbered(instruction: Instruction, number: dict[int, int]) -> tuple[int, int, int]:
    """The operands of an instruction by other numbers of their registers; unused ones are 0."""
    operation, *operands = instruction
    count = ARITY[operation]
    a, b, c = ([number[r] for r in operands[:count]] + [0, 0])[:3]
    return a, b, c
