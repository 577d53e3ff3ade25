"""The true errors of a run as tables: cell by cell (`errors.csv`), and the worst of each column.

The error of a cell is |cell - true value|, in the file's units, where the true value is that of the
same column in double-double numbers. Its relative error is that in parts of the largest number of
its column, and its right digits are those of the relative error: 12 for 3e-13. A column that is
zero but for rounding has errors and no digits. The column `why` says what of a table was not
repeated, or why a cell has no error.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.record import dataclass
from mechkin_cli.tables.columns import FloatArray, TableColumn, Words, words_of
from mechkin_cli.tables.layout import counted
from mechkin_cli.tables.table import Columns
from mechkin_cli.tape import DoubleDoubles, difference
from mechkin_cli.tolerances import (
    DOUBTFUL,
    NO_DOUBT,
    ZERO_BUT_FOR_ROUNDING,
    ZERO_WHERE_DOUBLES_ARE,
)
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from numpy.typing import NDArray


EMPTY = "empty"
"""Said of a cell without a number."""

LOST = "no value in double-double"
"""Said of a cell that the repetition has no number for."""

NO_VALUE = "no value, or none that double-double decides"
"""Said of a cell whose true value hangs on a rounding of zero: the text divides by zero."""

AT_LEAST = "at least so many digits: the repetition itself is known to no more"
"""Said of a cell whose error is that of the repetition, too."""

AT_DEAD_CENTRE = "at a dead centre, where no digit is sure"
"""Said of a cell without a figure in a row that stands at a dead centre."""

ZERO = "zero but for rounding"
"""Said of a column whose true numbers are none beside its rounding."""

ALL_COLUMNS = "all columns"
"""Stands for the labels of a table of which no column is repeated."""

NO_DIGITS = -1
"""Stands for the right digits of a cell of which nothing is known."""

MOST_DIGITS = 16
"""Digits of a cell that is the nearest double."""

_POWERS = tuple(float(f"1e-{k}") for k in range(1, MOST_DIGITS + 1))


@dataclass(frozen=True, eq=False)
class ColumnErrors:
    """The errors of one column of a table.

    Attributes:
        table: its name.
        label: of the column.
        unit: of cells and errors.
        values: (rows,) the cells, nan where empty.
        error: (rows,) |cell - true value|, with what the true value may be off by where that
            counts; nan where a cell is empty or was not repeated.
        is_bound: (rows,) whether it counts: the error is at most so large.
        lost_why: why a cell has no true value.
        why: why the column was not repeated, or has no digits; "" of others.
        dead_centres: (rows,) rows that stand at a dead centre; None: no row does.
    """

    table: str
    label: str
    unit: str
    values: FloatArray
    error: FloatArray
    is_bound: NDArray[np.bool_]
    why: str = ""
    lost_why: str = LOST
    dead_centres: NDArray[np.bool_] | None = None

    @cached_property
    def largest(self) -> float:
        """The largest magnitude in the column; 0 where it has no number."""
        sizes = np.abs(self.values[np.isfinite(self.values)])
        return float(sizes.max(initial=0.0))

    @cached_property
    def relative(self) -> FloatArray:
        """The errors in parts of the column's largest (rows,)."""
        if self.why:
            return np.full(self.error.shape, np.nan)
        size = self.largest
        found: FloatArray = self.error / size if size > 0.0 else np.where(self.error > 0, 1.0, 0.0)
        return np.where(np.isfinite(self.error), found, np.nan)

    @cached_property
    def digits(self) -> NDArray[np.int8]:
        """Right digits (rows,), `NO_DIGITS` where nothing is known."""
        with np.errstate(invalid="ignore"):
            found = np.count_nonzero([self.relative <= power for power in _POWERS], axis=0)
        known = np.isfinite(self.relative)
        return np.where(known, found, NO_DIGITS).astype(np.int8)

    @cached_property
    def worst(self) -> int:
        """The row with the largest error, -1 where none is known."""
        known = np.isfinite(self.error)
        return int(np.argmax(np.where(known, self.error, -1.0))) if known.any() else -1

    @cached_property
    def lost(self) -> int:
        """Cells with a number of which the repetition has none, but for those at a dead centre."""
        if self.why:
            return 0
        lost = np.isfinite(self.values) & ~np.isfinite(self.error) & ~self.at_dead_centre
        return int(np.count_nonzero(lost))

    @cached_property
    def at_dead_centre(self) -> NDArray[np.bool_]:
        """Cells without a figure in rows at a dead centre (rows,)."""
        if self.dead_centres is None:
            return np.zeros(self.error.shape, np.bool_)
        return self.dead_centres & ~np.isfinite(self.error)


def not_repeated(
    table: str, label: str, unit: str, values: FloatArray | int, why: str
) -> ColumnErrors:
    """Errors of a column whose cells are no numbers (`values`: how many), or was not repeated."""
    cells = np.full(values, np.nan) if isinstance(values, int) else values
    nothing = np.full(cells.shape, np.nan)
    return ColumnErrors(table, label, unit, cells, nothing, np.zeros(cells.shape, np.bool_), why)


def column_errors(
    table: str,
    label: str,
    unit: str,
    values: FloatArray,
    true: DoubleDoubles,
    doubt: FloatArray | float = 0.0,
    lost_why: str = LOST,
) -> ColumnErrors:
    """Errors of a column.

    Args:
        values: (rows,) the cells.
        true: (rows,) what they should be, in the same unit.
        doubt: how far that may be off.
        lost_why: why a cell has no true value.
    """
    with np.errstate(invalid="ignore"):
        error = np.abs(difference(values, true))
    error = np.where(np.isfinite(values) & np.isfinite(error), error, np.nan)
    known = np.isfinite(error)
    cells, exact = (np.abs(v[known]).max(initial=0.0) for v in (values, true.high))
    zero = (
        exact <= ZERO_BUT_FOR_ROUNDING * cells
        if cells > 0.0
        else 0.0 < exact <= ZERO_WHERE_DOUBLES_ARE
    )
    with np.errstate(invalid="ignore"):
        is_bound = known & ~(doubt <= np.maximum(DOUBTFUL * error, NO_DOUBT * cells))
        error = np.where(is_bound, error + doubt, error)
        none = is_bound & ~(error < cells * _POWERS[0])
    return ColumnErrors(
        table,
        label,
        unit,
        values,
        np.where(none, np.nan, error),
        is_bound & ~none,
        ZERO if zero else "",
        NO_VALUE if none.any() else lost_why,
    )


def least_digits(columns: Sequence[ColumnErrors]) -> int | None:
    """Digits that every cell has; None where nothing was repeated."""
    known = [int(c.digits[c.digits >= 0].min()) for c in columns if (c.digits >= 0).any()]
    return min(known, default=None)


def worst_column(columns: Sequence[ColumnErrors]) -> ColumnErrors | None:
    """The column with the largest relative error; None where nothing was repeated."""
    known = [c for c in columns if (c.digits >= 0).any()]
    return max(known, key=lambda c: float(np.nanmax(c.relative)), default=None)


def _name(run: str) -> str:
    return "errors" if run == SWEEP else f"{run}.errors"


def clashing(names: Iterable[str], runs: Iterable[str]) -> str | None:
    """The first of some tables whose files are those of the errors of a run; None where none is.

    Names differ by more than capitals, which not every file system distinguishes.
    """
    own = {_name(run).casefold() for run in runs}
    return next((name for name in names if name.casefold() in own), None)


def cells_table(columns: Sequence[ColumnErrors], run: str = SWEEP) -> Columns:
    """Columns table, column, unit, row, value, error, relative, digits, why: a line for each cell.

    Rows count from 1. A column that was not repeated has one line, without a row.
    """
    parts = [_cells(column) for column in columns]
    counts = [len(rows) for rows, *_ in parts]
    row, value, error, relative, digits = (
        np.concatenate([part[k] for part in parts] or [np.empty(0)]) for k in range(5)
    )
    return Columns(
        _name(run),
        "True errors of the cells",
        (
            *_names(columns, counts),
            TableColumn("row", "", row, 0),
            TableColumn("value", "", value),
            TableColumn("error", "", error),
            TableColumn("relative", "", relative),
            TableColumn("digits", "", digits, 0),
            TableColumn("why", "", _whys(columns, counts)),
        ),
        of_rows=False,
    )


def worst_table(columns: Sequence[ColumnErrors], run: str = SWEEP) -> Columns:
    """Columns table, column, unit, largest, error, relative, digits, row, why: a line for each
    column, with its worst cell."""
    none = (np.nan,) * 4
    worst = [
        (c.error[k], c.relative[k], float(c.digits[k]), k + 1.0) if (k := c.worst) >= 0 else none
        for c in columns
    ]
    error, relative, digits, row = np.array(worst or np.empty((0, 4))).T
    return Columns(
        _name(run),
        "True errors, worst of each column",
        (
            *_names(columns, [1] * len(columns)),
            TableColumn("largest", "", np.array([c.largest or np.nan for c in columns])),
            TableColumn("error", "", error),
            TableColumn("relative", "", relative),
            TableColumn("digits", "", _or_nan(digits), 0),
            TableColumn("row", "", row, 0),
            TableColumn("why", "", words_of([_why(c) for c in columns])),
        ),
        of_rows=False,
    )


def _why(column: ColumnErrors) -> str:
    if column.why:
        return column.why
    there = int(np.count_nonzero(column.at_dead_centre))
    said = [(column.lost, column.lost_why), (there, AT_DEAD_CENTRE)]
    without = [counted(cells, "cell") + f" without: {why}" for cells, why in said if cells]
    return "; ".join(without) or (AT_LEAST if column.is_bound.any() else "")


def _names(columns: Sequence[ColumnErrors], counts: Sequence[int]) -> tuple[TableColumn, ...]:
    codes = np.repeat(np.arange(len(columns), dtype=np.int32), counts)

    def words(texts: Sequence[str]) -> Words:
        found = words_of(texts)
        return Words(found.codes[codes], found.words)

    return (
        TableColumn("table", "", words([c.table for c in columns])),
        TableColumn("column", "", words([c.label for c in columns])),
        TableColumn("unit", "", words([c.unit for c in columns])),
    )


def _cells(column: ColumnErrors) -> tuple[FloatArray, ...]:
    """Row, value, error, relative and digits of a column's lines."""
    if not np.isfinite(column.error).any() and column.why:
        return tuple(np.full(1, np.nan) for _ in range(5))
    rows = np.arange(1.0, column.values.size + 1.0)
    digits = _or_nan(column.digits.astype(np.float64))
    return rows, column.values, column.error, column.relative, digits


def _whys(columns: Sequence[ColumnErrors], counts: Sequence[int]) -> Words:
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
            codes = np.where(column.at_dead_centre, 3, codes)
        known.append(codes.astype(np.int32))
    return Words(np.concatenate(known), words)


def _or_nan(digits: FloatArray) -> FloatArray:
    return np.where(digits == NO_DIGITS, np.nan, digits)
