"""Elementary functions of double-double numbers, by the kernel."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tape.double_doubles import DoubleDoubles
from mechkin_cli.tape.native import compiled, replay_precise
from mechkin_cli.tape.operations import ARITY, Operation
from mechkin_cli.tape.tape import Tape

if TYPE_CHECKING:
    from mechkin_cli.kernel import _kernel


def elementary(operation: str, *numbers: DoubleDoubles) -> DoubleDoubles:
    """The function of a name (`SIN`), number by number."""
    parts = np.broadcast_arrays(*(part for n in numbers for part in (n.high, n.low)))
    shape = parts[0].shape
    values = np.stack([part.ravel() for part in parts]).reshape(len(numbers), 2, -1)
    found = replay_precise(_tape(operation), values)[0]
    return DoubleDoubles(found[:, 0, 0].reshape(shape), found[:, 0, 1].reshape(shape))


@cache
def _tape(operation: str) -> _kernel.Tape:
    """The tape of one operation."""
    code = Operation[operation]
    count = ARITY[code]
    operands = np.array([[k if k < count else 0 for k in range(3)]], dtype=np.int32)
    nothing = np.zeros(0, dtype=np.bool_)
    return compiled(
        Tape(
            tuple("xyz"[:count]),
            np.zeros(0),
            np.array([code], dtype=np.uint8),
            operands,
            np.array([count], dtype=np.int32),
            np.zeros((0, 3), dtype=np.int32),
            nothing,
            nothing,
        )
    )
