"""A tape as plain data."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tape.operations import ARITY, Operation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


class Verdict(IntEnum):
    """What the guards say of some inputs: all as recorded, all but for a warning, or that the code
    would have gone another way, so that the outputs mean nothing."""

    SAME = 0
    OTHER_ADVICE = 1
    OTHER_WAY = 2


@dataclass(frozen=True, eq=False)
class Tape:
    """Instructions in the order of computation; register k holds input k, then constant
    k - inputs, then the result of instruction k - inputs - constants.

    Attributes:
        inputs: names of the numbers given, in SI.
        constants: (constants,).
        operations: (instructions,) of `Operation`.
        operands: (instructions, 3) registers that lie before; unused ones are 0.
        outputs: (outputs,) registers of the numbers computed.
        guards: (guards, 3): `Operation` out of `CONDITIONS`, and its two registers.
        expected: (guards,) what each guard found when the tape was recorded.
        advice: (guards,) whether only a warning hangs on it.
    """

    inputs: tuple[str, ...]
    constants: Floats
    operations: NDArray[np.uint8]
    operands: NDArray[np.int32]
    outputs: NDArray[np.int32]
    guards: NDArray[np.int32]
    expected: NDArray[np.bool_]
    advice: NDArray[np.bool_]

    @property
    def registers(self) -> int:
        """Number of registers."""
        return len(self.inputs) + self.constants.size + self.operations.size

    def depends(self, output: int, given: int = 0) -> bool:
        """Whether an output depends on an input."""
        first = len(self.inputs) + self.constants.size
        moved = {given}
        for k, operands in enumerate(self.operands.tolist(), start=first):
            if moved.intersection(operands[: ARITY[Operation(int(self.operations[k - first]))]]):
                moved.add(k)
        return int(self.outputs[output]) in moved

    @cached_property
    def fixed(self) -> NDArray[np.bool_]:
        """Which outputs depend on no input: constants."""
        first = len(self.inputs)
        fixed: NDArray[np.bool_] = (self.outputs >= first) & (
            self.outputs < first + self.constants.size
        )
        return fixed
