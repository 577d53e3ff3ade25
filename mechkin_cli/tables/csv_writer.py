"""CSV of a table: RFC 4180 with LF line ends, labels as header, numbers as the kernel writes them.

Numbers have the shortest digits that read back as the same double, or, for tables kept under
version control, the shortest of the value rounded to a number of significant digits; an empty cell
is a missing value, in quotes where it is alone in its line, as many readers skip blank lines.
Labels that a spreadsheet would take for formulas begin with an apostrophe (`tables/neutral.py`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.tables.columns import Column, Columns, Words, words_of
from mechkin_cli.tables.native_columns import number_column, threads_for, word_column
from mechkin_cli.tables.neutral import csv_text

if TYPE_CHECKING:
    from mechkin_cli.tables.native_columns import WordColumn
    from mechkin_cli.tables.source import FloatArray

COMMITTED_DIGITS = 12
"""Significant digits of committed tables: above any rounding, below what a last bit can change."""

SHORTEST = 0


def csv_bytes(
    columns: Columns, significant_digits: int = SHORTEST, threads: int = 0, units: bool = False
) -> bytes:
    """The whole file as UTF-8; `SHORTEST` or 1 to 15 significant digits; threads 0: as many as the
    table is worth; with `units` in the header, as `theta [deg]`."""
    from mechkin_cli.kernel import _kernel

    labels = [csv_text(_header(column, units)) for column in columns.columns]
    cells = [
        word_column(column.values, csv_text)
        if isinstance(column.values, Words)
        else _numbers(column, significant_digits)
        for column in columns.columns
    ]
    text: bytes = _kernel.csv_text(
        labels,
        cells,
        significant_digits=significant_digits,
        quoted_empty=len(labels) == 1,
        threads=threads_for(columns, threads),
    )
    return text


def _numbers(column: Column, significant_digits: int) -> FloatArray | WordColumn:
    """The cells as the kernel takes them: as texts where one is infinite."""
    assert not isinstance(column.values, Words)
    cells = number_column(column.values)
    if column.unbounded is None:
        return cells
    from mechkin_cli.kernel import _kernel

    one: bytes = _kernel.csv_text(
        [""], [cells], significant_digits=significant_digits, quoted_empty=False, threads=1
    )
    return word_column(words_of(column.texts(one.decode().split("\n")[1:-1])))


def _header(column: Column, units: bool) -> str:
    return f"{column.label} [{column.unit}]" if units and column.unit else column.label
