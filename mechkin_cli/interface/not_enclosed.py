"""Which rows that are proven have no bounds of a quantity, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, Number

if TYPE_CHECKING:
    from mechkin_cli.arrays import Bools

_WHY: Final = {
    "value": (
        "it has no finite value there, or is not unique",
        "row.status and the notes of the analysis say which",
    ),
    "input": (
        "the input is farther from what the file's text says than the row's box holds",
        "write the law so that its terms do not cancel",
    ),
    "box": (
        "it is not bounded over the row's box",
        "the place is singular or nearly so: look at row.condition and row.status",
    ),
}


def not_enclosed(
    name: str, proven: Bools, has_value: Bools, is_inside: Bools, bounded: Bools
) -> tuple[Diagnostic, ...]:
    """A note for each reason, with the rows; all arrays (rows,).

    Args:
        proven: rows of which something is proven.
        has_value: rows with a number in doubles.
        is_inside: rows whose inputs as the text says them are among those of their boxes.
        bounded: rows with bounds.
    """
    missing = proven & ~bounded
    reasons = {
        "value": missing & ~has_value,
        "input": missing & has_value & ~is_inside,
        "box": missing & has_value & is_inside,
    }
    return tuple(_note(name, why, rows) for why, rows in reasons.items() if rows.any())


def _note(name: str, why: str, chosen: Bools) -> Diagnostic:
    rows = np.flatnonzero(chosen) + 1
    first, last = int(rows[0]), int(rows[-1])
    where = f"row {first}" if rows.size == 1 else f"{rows.size} rows from {first} to {last}"
    words, hint = _WHY[why]
    numbers = (Number("rows", rows.size), Number("first_row", first), Number("last_row", last))
    text = f"{name} has no bounds in {where}, proven as that is: {words}"
    return Diagnostic("not-enclosed", "note", text, hint=hint, numbers=numbers)
