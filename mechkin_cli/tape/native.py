"""Tapes replayed by the kernel, over many sets of inputs at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.kernel.width import width
from mechkin_cli.tape.tape import Tape

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


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
