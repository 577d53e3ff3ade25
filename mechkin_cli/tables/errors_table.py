"""The true errors of a run as tables: cell by cell (`errors.csv`), and the worst of each column.

Both say, in the column `why`, what of a table was not repeated, or why a cell has no error.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.runs import SWEEP
from mechkin_cli.tables.cell_errors import (
    AT_DEAD_CENTRE,
    AT_LEAST,
    EMPTY,
    NO_DIGITS,
    ColumnErrors,
    counted_cells,
)
from mechkin_cli.tables.columns import Column, Columns, Words, words_of

if TYPE_CHECKING:
    from mechkin_cli.tables.source import FloatArray


def _name(run: str) -> str:
    return "errors" if run == SWEEP else f"{run}.errors"


def clashing(names: Iterable[str], runs: Iterable[str]) -> str | None:
    """The first of some tables whose files are those of the errors of a run; None where none is.

    Files differ by more than capitals, for there are disks that do not tell these apart.
    """
    own = {_name(run).casefold() for run in runs}
    return next((name for name in names if name.casefold() in own), None)


def cells_table(columns: Sequence[ColumnErrors], run: str = SWEEP) -> Columns:
    """Columns table, column, unit, row, value, error, relative, digits, why: a line for each cell.

    Rows count from 1. A column that was not repeated has one line, without a row.
    """
    parts = [_cells(column) for column in columns]
    counts = [len(rows) for rows, *_ in parts]
    number = [np.concatenate([part[k] for part in parts] or [np.empty(0)]) for k in range(5)]
    row, value, error, relative, digits = number
    return Columns(
        _name(run),
        "True errors of the cells",
        (
            *_names(columns, counts),
            Column("row", "", row, 0),
            Column("value", "", value),
            Column("error", "", error),
            Column("relative", "", relative),
            Column("digits", "", digits, 0),
            Column("why", "", _whys(columns, counts)),
        ),
        of_rows=False,
    )


def worst_table(columns: Sequence[ColumnErrors], run: str = SWEEP) -> Columns:
    """Columns table, column, unit, largest, error, relative, digits, row, why: a line for each
    column, with its worst cell."""
    at = [c.worst for c in columns]
    pairs = list(zip(columns, at, strict=True))
    worst = [c.error[k] if k >= 0 else np.nan for c, k in pairs]
    relative = [c.relative[k] if k >= 0 else np.nan for c, k in pairs]
    digits = [float(c.digits[k]) if k >= 0 else np.nan for c, k in pairs]
    return Columns(
        _name(run),
        "True errors, worst of each column",
        (
            *_names(columns, [1] * len(columns)),
            Column("largest", "", np.array([c.largest or np.nan for c in columns])),
            Column("error", "", np.array(worst)),
            Column("relative", "", np.array(relative)),
            Column("digits", "", _or_nan(np.array(digits)), 0),
            Column("row", "", np.array([k + 1.0 if k >= 0 else np.nan for k in at]), 0),
            Column("why", "", words_of([_why(c) for c in columns])),
        ),
        of_rows=False,
    )


def _why(column: ColumnErrors) -> str:
    if column.why:
        return column.why
    there = int(np.count_nonzero(column.stands_there))
    said = [(column.lost, column.lost_why), (there, AT_DEAD_CENTRE)]
    without = [f"{counted_cells(cells)} without: {why}" for cells, why in said if cells]
    return "; ".join(without) or (AT_LEAST if column.is_bound.any() else "")


def _names(columns: Sequence[ColumnErrors], counts: Sequence[int]) -> tuple[Column, ...]:
    """The columns table, column and unit."""
    codes = np.repeat(np.arange(len(columns), dtype=np.int32), counts)

    def words(texts: Sequence[str]) -> Words:
        found = words_of(texts)
        return Words(found.codes[codes], found.words)

    return (
        Column("table", "", words([c.table for c in columns])),
        Column("column", "", words([c.label for c in columns])),
        Column("unit", "", words([c.unit for c in columns])),
    )


def _cells(column: ColumnErrors) -> tuple[FloatArray, ...]:
    """Row, value, error, relative and digits of a column's lines."""
    if not np.isfinite(column.error).any() and column.why:
        return tuple(np.full(1, np.nan) for _ in range(5))
    rows = np.arange(1.0, column.values.size + 1.0)
    digits = _or_nan(column.digits.astype(np.float64))
    return rows, column.values, column.error, column.relative, digits


def _whys(columns: Sequence[ColumnErrors], counts: Sequence[int]) -> Words:
    """What is said of each line."""
    lost, whys = [c.lost_why for c in columns], [c.why for c in columns]
    words = tuple(dict.fromkeys(("", EMPTY, AT_LEAST, AT_DEAD_CENTRE, *lost, *whys)))
    known = [np.zeros(0, dtype=np.int32)]
    for column, count in zip(columns, counts, strict=True):
        if column.why:
            codes = np.full(count, words.index(column.why))
        else:
            measured = np.where(column.is_bound, 2, 0)
            gone = words.index(column.lost_why)
            measured = np.where(np.isfinite(column.error), measured, gone)
            codes = np.where(np.isfinite(column.values), measured, 1)
            codes = np.where(column.stands_there, 3, codes)
        known.append(codes.astype(np.int32))
    return Words(np.concatenate(known), words)


def _or_nan(digits: FloatArray) -> FloatArray:
    return np.where(digits == NO_DIGITS, np.nan, digits)
