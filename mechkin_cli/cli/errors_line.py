"""The line of a summary that says how many digits of all cells are right."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis.errors.reasons import WORDS
from mechkin_cli.legible import legible
from mechkin_cli.tables.cell_errors import ALL_COLUMNS, AT_DEAD_CENTRE, ZERO, counted_cells

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis
    from mechkin_cli.tables.cell_errors import ColumnErrors

COLUMNS_SHOWN = 3
"""Columns that are named one by one."""

_NO_GAP = {ZERO, WORDS}
"""Columns of which everything is known that there is."""


def errors_line(analysis: Analysis) -> str:
    """`every cell right to 12 digits; worst: alpha4 at 202, 3e-13`, and what was not repeated."""
    errors = analysis.errors
    parts: list[str] = []
    worst = errors.worst
    if worst is None:
        parts.append("no cell was repeated")
    else:
        said = f"every cell right to {errors.digits} digits"
        if any(c.why and c.why not in _NO_GAP for c in errors.columns):
            said = f"every cell repeated is right to {errors.digits} digits"
        parts.append(f"{said}; worst: {_place(analysis, worst)}")
    zero = [c for c in errors.columns if c.why == ZERO]
    parts += [f"{ZERO}: {_named(zero)}"] if zero else []
    parts += _left_out([c for c in errors.columns if c.why and c.why not in _NO_GAP])
    words = [c for c in errors.columns if c.why == WORDS]
    parts += [f"words, which have no error: {_named(words)}"] if words else []
    bounds = sum(int(np.count_nonzero(c.is_bound)) for c in errors.columns)
    parts += [f"{bounds} cells right to at least the digits told"] if bounds else []
    for why in dict.fromkeys(c.lost_why for c in errors.columns if c.lost):
        lost = sum(c.lost for c in errors.columns if c.lost_why == why)
        parts.append(f"{counted_cells(lost)} not measured ({why})")
    there = sum(int(np.count_nonzero(c.stands_there)) for c in errors.columns)
    parts += [f"{counted_cells(there)} without a figure ({AT_DEAD_CENTRE})"] if there else []
    return "; ".join(parts)


def _place(analysis: Analysis, column: ColumnErrors) -> str:
    """The worst cell of a column: its label, where, and the error in parts of the largest."""
    row = column.worst
    inputs = list(analysis.result.inputs.values())
    at = f"{inputs[0][row]:.12g}" if inputs else f"row {row + 1}"
    return f"{legible(column.label)} at {at}, {column.relative[row]:.0e}"


def _left_out(columns: list[ColumnErrors]) -> list[str]:
    """Which columns were not repeated, by the reasons why."""
    reasons = dict.fromkeys(column.why for column in columns)
    return [
        f"not repeated: {_named([c for c in columns if c.why == why])} ({why})" for why in reasons
    ]


def _label(column: ColumnErrors) -> str:
    return column.table if column.label == ALL_COLUMNS else column.label


def _named(columns: list[ColumnErrors]) -> str:
    """The labels of some columns, the first of them one by one."""
    labels = list(dict.fromkeys(legible(_label(column)) for column in columns))
    more = len(labels) - COLUMNS_SHOWN
    return ", ".join(labels[:COLUMNS_SHOWN]) + (f" and {more} more" if more > 0 else "")
