"""A plan as text, for the core without Python: the same bits wherever it is read.

What stands there is said in `core/text/plan_text.hpp`; `c/mechkin.h` runs it.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from numbers import Integral
from typing import Any

FIRST_LINE = "mechkin plan 1"


def plan_text(
    calls: Iterable[tuple[str, Sequence[Any]]],
    outputs: Iterable[Sequence[Any]] = (),
    tape: Sequence[Any] | None = None,
) -> str:
    """The text of a plan, the quantities that its runs write, and the tape of its constants.

    Args:
        calls: `plan` with the arguments of `PlanBuilder`, then its calls by name with theirs.
        outputs: the records that `Outputs` takes.
        tape: the arguments of `Tape`, which gives the constants of plan and outputs.

    Example:
        >>> print(plan_text([("plan", (1.0, (0, 0, 0), 0.5)), ("set_rest", ([],))]), end="")
        mechkin plan 1
        plan x3ff0000000000000 [0 0 0] x3fe0000000000000
        set_rest []
    """
    records = [*calls, *(("output", record) for record in outputs)]
    if tape is not None:
        records.append(("tape", tape))
    lines = [FIRST_LINE, *(" ".join([name, *map(_word, values)]) for name, values in records)]
    return "".join(f"{line}\n" for line in lines)


def _word(value: Any) -> str:
    """An integer, the bits of a float, or a list of such words."""
    if isinstance(value, float):
        return f"x{struct.unpack('<Q', struct.pack('<d', value))[0]:016x}"
    if isinstance(value, Integral):
        return str(int(value))
    return f"[{' '.join(map(_word, value))}]"
