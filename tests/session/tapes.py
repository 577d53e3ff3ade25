"""Tapes of exact numbers evaluated by mpmath at 80 digits; the mechanisms kept."""

from __future__ import annotations

from functools import cache
from typing import Any

from mpmath import MPContext
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.model.model import Model
from mechkin_cli.tape.tape import ARITY, ExactTape, Operation

mp = MPContext()
mp.dps = 80

STEMS = [
    path.stem
    for path in list(FILE_OF.values())
    if "motion:" in path.read_text(encoding="utf-8").splitlines()
]

_MEANING = {
    Operation.ADD: lambda a, b: a + b,
    Operation.SUBTRACT: lambda a, b: a - b,
    Operation.MULTIPLY: lambda a, b: a * b,
    Operation.DIVIDE: lambda a, b: a / b,
    Operation.NEGATE: lambda a: -a,
    Operation.MAGNITUDE: abs,
    Operation.SQUARE_ROOT: mp.sqrt,
    Operation.SIN: mp.sin,
    Operation.COS: mp.cos,
    Operation.TAN: mp.tan,
    Operation.ASIN: mp.asin,
    Operation.ACOS: mp.acos,
    Operation.ATAN: mp.atan,
    Operation.ATAN2: mp.atan2,
    Operation.EXP: mp.exp,
    Operation.LOG: mp.log,
    Operation.POWER: mp.power,
}


@cache
def model(stem: str) -> Model:
    return mk.load(FILE_OF[stem])


def true_outputs(tape: ExactTape) -> list[Any]:
    registers = [mp.mpf(x.numerator) / x.denominator for x in tape.numbers]
    registers += [mp.mpf(x) for x in tape.tape.constants.tolist()]
    lines = zip(tape.tape.operations.tolist(), tape.tape.operands.tolist(), strict=True)
    for code, operands in lines:
        operation = Operation(code)
        arguments = [registers[r] for r in operands[: ARITY[operation]]]
        registers.append(_MEANING[operation](*arguments))
    return [registers[r] for r in tape.tape.outputs.tolist()]
