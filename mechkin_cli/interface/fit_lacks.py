"""Which value a fit lacks although its rows have positions: infinite at a dead centre, or empty."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.status import Status

if TYPE_CHECKING:
    from collections.abc import Iterable

    from mechkin_cli.arrays import Floats
    from mechkin_cli.interface.analysis import Analysis

END_BEFORE = "end the sweep before it, or vary a dimension that moves the dead centre"
ASK_BEFORE = "ask for it before that, or vary a dimension that moves the dead centre"
OTHERWISE = "ask for another quantity there, or end the run before it"
NOT_REACHED = "ask for it at inputs that are reached, or widen the bounds"


class Lack(NamedTuple):
    """A value that is not finite, and where; whether it is infinite; and what to do."""

    text: str
    infinite: bool
    hint: str

    @property
    def reason(self) -> str:
        """What a fit says of it."""
        return (
            "no variant that was tried has a finite value of all that is asked for; in the best "
            f"{self.text}; {self.hint}"
        )


def lack_of(analysis: Analysis, texts: Iterable[str]) -> Lack | None:
    """The first of some expressions that has no finite value in some row, infinite ones first."""
    found = [lack for text in texts if (lack := _lack(analysis, text)) is not None]
    return min(found, key=lambda one: not one.infinite, default=None)


def lack_at(text: str, values: Floats, inputs: Floats, along: str, unit: str) -> Lack | None:
    """The same of values (points, width) at inputs (points,)."""
    for value, place in zip(values, inputs.tolist(), strict=True):
        where = f"at {along} = {place:.9g} {unit}".rstrip()
        if np.isinf(value).any():
            return Lack(f"{text} is infinite {where}, a dead centre", True, ASK_BEFORE)
        if np.isnan(value).any():
            return Lack(f"{text} has no value {where}", False, NOT_REACHED)
    return None


def _lack(analysis: Analysis, text: str) -> Lack | None:
    values = np.asarray(analysis[text])
    values = values.reshape(len(values), -1)
    infinite = np.isinf(values).any(axis=1)
    without = infinite if infinite.any() else np.isnan(values).any(axis=1)
    if not without.any():
        return None
    row = int(np.argmax(without))
    where = f"in row {row + 1}{_place(analysis, row)}"
    if int(analysis.result.status[row]) == Status.dead_centre:
        where += ", which stands at a dead centre"
    if infinite.any():
        return Lack(f"{text} is infinite {where}", True, END_BEFORE)
    return Lack(f"{text} has no value {where}", False, OTHERWISE)


def _place(analysis: Analysis, row: int) -> str:
    """Where a row stands along its run."""
    from mechkin_cli.tables.run_parameter import run_parameter

    along = run_parameter(analysis.result)
    if along is None:
        return ""
    return f" ({along.name} = {along.values[row]:.9g} {along.unit}".rstrip() + ")"
