"""A tape as plain data, its reference evaluator on floats, and its replay by the kernel."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from enum import IntEnum
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.kernel import _kernel, functions
from mechkin_cli.kernel.functions import width
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.tape.scalars import next_power_of_two, sign

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


class Operation(IntEnum):
    """What an instruction computes of its operands a, b, c; for floats, the IEEE operation. The
    numbers are those of the kernel (`kernel/core/tape/tape.hpp`).

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
"""The conditions of guards."""

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


class Verdict(IntEnum):
    """The guards' verdict on some inputs: all as recorded, all but for a warning, or that the code
    would have branched otherwise, so that the outputs mean nothing."""

    SAME = 0
    OTHER_ADVICE = 1
    OTHER_WAY = 2


@dataclass(frozen=True, eq=False)
class Tape:
    """Instructions in the order of computation; register k holds input k, then constant
    k - inputs, then the result of instruction k - inputs - constants.

    Attributes:
        inputs: names of the input numbers, in SI.
        constants: (constants,).
        operations: (instructions,) of `Operation`.
        operands: (instructions, 3) registers that lie before; unused ones are 0.
        outputs: (outputs,) registers of the numbers computed.
        guards: (guards, 3): `Operation` out of `CONDITIONS`, and its two registers.
        expected: (guards,) the truth of each guard when the tape was recorded.
        advice: (guards,) whether it decides on a warning only.
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

    def depends(self, output: int) -> bool:
        """Whether an output depends on the first input."""
        first = len(self.inputs) + self.constants.size
        moved = {0}
        for k, operands in enumerate(self.operands.tolist(), start=first):
            if moved.intersection(operands[: ARITY[Operation(int(self.operations[k - first]))]]):
                moved.add(k)
        return int(self.outputs[output]) in moved


_ROUNDER = float(3 * 2**51)
"""1.5 * 2^52: adding it rounds to the nearest whole number."""

_LARGEST_HALF = math.ldexp(0.7, 1024)
"""The power of two next to a larger number is beyond the range of floats."""


def _divide(a: float, b: float) -> float:
    """a / b as IEEE has it; a guard against zero stands before every division."""
    if b != 0.0:
        return a / b
    if a == 0.0 or math.isnan(a) or math.isnan(b):
        return math.nan
    return math.copysign(math.inf, math.copysign(1.0, a) * math.copysign(1.0, b))


def _power_of_two_or_nan(a: float) -> float:
    if not 0.0 < a < math.inf:
        return math.nan
    return next_power_of_two(a) if a <= _LARGEST_HALF else math.inf


MEANING: dict[Operation, Callable[..., float]] = {
    Operation.ADD: lambda a, b: a + b,
    Operation.SUBTRACT: lambda a, b: a - b,
    Operation.MULTIPLY: lambda a, b: a * b,
    Operation.DIVIDE: _divide,
    Operation.NEGATE: lambda a: -a,
    Operation.MAGNITUDE: abs,
    Operation.SQUARE_ROOT: lambda a: math.sqrt(a) if a >= 0.0 else math.nan,
    Operation.LARGER: lambda a, b: b if b > a else a,
    Operation.SMALLER: lambda a, b: b if b < a else a,
    Operation.CHOOSE: lambda a, b, c: b if a != 0.0 else c,
    Operation.LESS: lambda a, b: float(a < b),
    Operation.NOT_MORE: lambda a, b: float(a <= b),
    Operation.EQUAL: lambda a, b: float(a == b),
    Operation.POWER_OF_TWO: _power_of_two_or_nan,
    Operation.WHOLE: lambda a: (a + _ROUNDER) - _ROUNDER,
    Operation.SIGN: sign,
}
"""The operations on floats, as the kernel computes them in lanes; elementary functions are those of
the kernel."""


def meaning(operation: Operation) -> Callable[..., float]:
    """The function of one, two or three floats."""
    if operation not in MEANING:
        MEANING[operation] = getattr(functions, operation.name.lower())
    return MEANING[operation]


def evaluate(tape: Tape, values: Sequence[float]) -> tuple[list[float], Verdict]:
    """Replays a tape on floats, operation by operation: its outputs, and the guards' verdict.

    Args:
        tape: the tape.
        values: (inputs,) in the tape's order, in SI.
    """
    registers: list[float] = [*map(float, values), *tape.constants.tolist()]
    for code, operands in zip(tape.operations.tolist(), tape.operands.tolist(), strict=True):
        operation = Operation(code)
        arguments = (registers[r] for r in operands[: ARITY[operation]])
        registers.append(meaning(operation)(*arguments))
    verdict = Verdict.SAME
    guards = zip(tape.guards.tolist(), tape.expected, tape.advice, strict=True)
    for (code, a, b), expected, advice in guards:
        holds = meaning(Operation(code))(registers[a], registers[b]) != 0.0
        if holds is not bool(expected):
            verdict = max(verdict, Verdict.OTHER_ADVICE if advice else Verdict.OTHER_WAY)
    return [registers[r] for r in tape.outputs.tolist()], verdict


def compiled(tape: Tape) -> _kernel.Tape:
    """The tape as the kernel takes it."""
    return _kernel.Tape(
        len(tape.inputs),
        tape.constants,
        tape.operations,
        tape.operands,
        tape.outputs,
        tape.guards,
        tape.expected.astype(np.uint8),
        tape.advice.astype(np.uint8),
    )


def tape_values(tape: Tape) -> tuple[Any, ...]:
    """The tape as its text has it (`kernel.plan_text`): the arguments of the kernel's `Tape` in
    lists."""
    arrays = (tape.constants, tape.operations, tape.operands, tape.outputs, tape.guards)
    lists = [array.tolist() for array in arrays]
    return (
        len(tape.inputs),
        *lists,
        tape.expected.astype(int).tolist(),
        tape.advice.astype(int).tolist(),
    )


def replay(tape: _kernel.Tape, values: Floats, lanes: int = 0) -> tuple[Floats, NDArray[np.uint8]]:
    """The outputs (sets, outputs) of inputs (inputs, sets), and a `Verdict` (sets,) each.

    `lanes` as everywhere: 0 for the widest, the bits do not depend on it.
    """
    return tape.replay(np.ascontiguousarray(values, dtype=np.float64), width(lanes))


def replay_precise(
    tape: _kernel.Tape, values: Floats, second: Floats | None = None, lanes: int = 0
) -> tuple[Floats, NDArray[np.uint8]]:
    """The outputs (sets, outputs, 2) in double-double, high and low, of inputs (inputs, 2, sets),
    and a `Verdict` (sets,) each.

    `second` (constants,) are the low parts of the tape's constants, None where these are exact;
    `lanes` as everywhere.

    Raises:
        ValueError: shapes that do not fit the tape.
    """
    low = None if second is None else np.ascontiguousarray(second, dtype=np.float64)
    return tape.replay_precise(np.ascontiguousarray(values, dtype=np.float64), low, width(lanes))


class ExactTape(NamedTuple):
    """A tape without guards, the exact numbers that are its inputs, these as double-doubles
    (inputs, 2), and the registers in which they are recorded."""

    tape: Tape
    numbers: tuple[Fraction, ...]
    values: Floats
    given: tuple[int, ...]
