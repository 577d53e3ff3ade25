"""The reference evaluator: a tape replayed on floats, operation by operation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from mechkin_cli.tape.floats import meaning
from mechkin_cli.tape.operations import ARITY, Operation
from mechkin_cli.tape.tape import Tape, Verdict


class Replayed(NamedTuple):
    """The outputs, and what the guards say of them."""

    outputs: list[float]
    verdict: Verdict


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
    verdict = Verdict.SAME
    every = zip(tape.guards.tolist(), tape.expected, tape.advice, strict=True)
    for (code, a, b), expected, advice in every:
        found = meaning(Operation(code))(registers[a], registers[b]) != 0.0
        if found is not bool(expected):
            verdict = max(verdict, Verdict.OTHER_ADVICE if advice else Verdict.OTHER_WAY)
    return Replayed([registers[r] for r in tape.outputs.tolist()], verdict)
