"""A plan as text, for the core without Python: the same bits wherever it is read.

What stands there is said in `core/text/plan_text.hpp`; `c/mechkin.h` runs it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from numbers import Integral
from typing import Any

FIRST_LINE = "mechkin plan 1"
FIRST_LINE_OF_TAPE = "mechkin tape 1"

Record = tuple[str, Sequence[Any]]
"""A name and its values, a line of the text."""


def plan_text(
    calls: Iterable[Record],
    outputs: Iterable[Sequence[Any]] = (),
    tape: Sequence[Any] | None = None,
    variants: Iterable[Record] = (),
) -> str:
    """The text of a plan, the quantities that its runs write, and the tape of its constants.

    Args:
        calls: `plan` with the arguments of `PlanBuilder`, then its calls by name with theirs.
        outputs: the records that `Outputs` takes.
        tape: the arguments of `Tape`, which gives the constants of plan and outputs.
        variants: what variants have in common: `variants`, `way` and `course` with their values.

    Example:
        >>> print(plan_text([("plan", (1.0, (0, 0, 0), 0.5)), ("set_rest", ([],))]), end="")
        mechkin plan 1
        plan x3ff0000000000000 [0 0 0] x3fe0000000000000
        set_rest []
    """
    records = [*calls, *(("output", record) for record in outputs)]
    if tape is not None:
        records.append(("tape", tape))
    return _text(FIRST_LINE, [*records, *variants])


def tape_text(tape: Sequence[Any]) -> str:
    """The text of a tape alone, of the arguments of `Tape`."""
    return _text(FIRST_LINE_OF_TAPE, [("tape", tape)])


def record_lines(records: Iterable[Record]) -> str:
    """Records alone, as they stand in a text."""
    return "".join(f"{' '.join([name, *map(_word, values)])}\n" for name, values in records)


def _text(first: str, records: Iterable[Record]) -> str:
    return f"{first}\n{record_lines(records)}"


def _word(value: Any) -> str:
    """An integer, the bits of a float, or a list of such words."""
    if isinstance(value, float):
        return f"x{struct.unpack('<Q', struct.pack('<d', value))[0]:016x}"
    if isinstance(value, Integral):
        return str(int(value))
    return f"[{' '.join(map(_word, value))}]"
