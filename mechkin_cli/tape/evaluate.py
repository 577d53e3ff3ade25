"""The reference evaluator: a tape replayed on floats, operation by operation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from mechkin_cli.tape.floats import meaning
from mechkin_cli.tape.operations import Operation
from mechkin_cli.tape.recorder import ARITY
from mechkin_cli.tape.tape import Tape


class Replayed(NamedTuple):
    """The outputs, and whether every guard found what it found when the tape was recorded."""

    outputs: list[float]
    holds: bool


def evaluate(tape: Tape, values: Sequence[float]) -> Replayed:
    """Replays a tape for other inputs.

    Args:
        tape: the tape.
        values: (inputs,) in the tape's order, in SI.
    """
    registers: list[float] = [*map(float, values), *tape.constants.tolist()]
    for code, operands in zip(tape.operations.tolist(), tape.operands.tolist(), strict=True):
        operation = Operation(code)
        arguments = (registers[r] for r in operands[: ARITY[operation]])
        registers.append(meaning(operation)(*arguments))
    holds = all(
        (meaning(Operation(code))(registers[a], registers[b]) != 0.0) is bool(expected)
        for (code, a, b), expected in zip(tape.guards.tolist(), tape.expected, strict=True)
    )
    return Replayed([registers[r] for r in tape.outputs.tolist()], holds)
