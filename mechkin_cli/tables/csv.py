"""CSV of a table: RFC 4180 with LF line ends, labels as header, numbers as the kernel writes them.

Numbers have the shortest digits that read back as the same double, or, for tables kept under
version control, the shortest of the value rounded to a number of significant digits; an empty cell
is a missing value, in quotes where it is alone in its line, as many readers skip blank lines.
With a decimal comma, for spreadsheets of countries that write it, semicolons part the cells.
Labels that a spreadsheet would take for formulas begin with an apostrophe (`tables/layout.py`).
"""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Iterable, Sequence
from io import StringIO
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.tables.columns import FloatArray, TableColumn, Words, number_column, words_of
from mechkin_cli.tables.layout import csv_text
from mechkin_cli.tables.table import Columns
from mechkin_cli.tolerances import CELLS_PER_THREAD, MOST_TEXT_THREADS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    WordColumn = tuple[NDArray[np.int32], list[str]]

COMMITTED_DIGITS = 12
"""Significant digits of committed tables: above any rounding, below what a last bit can change."""

SHORTEST = 0


def word_column(words: Words, written: Callable[[str], str] = str) -> WordColumn:
    """Codes and texts; `written` makes of each text what is to stand in the file."""
    return np.ascontiguousarray(words.codes, np.int32), [written(word) for word in words.words]


def threads_for(columns: Columns | Iterable[TableColumn], threads: int = 0) -> int:
    """Threads that write a table: those asked for, or with 0 as many as there are processors and
    as the number of cells is worth. The text does not depend on it."""
    if threads:
        return min(threads, MOST_TEXT_THREADS)
    listed = columns.columns if isinstance(columns, Columns) else tuple(columns)
    cells = sum(column.rows for column in listed)
    return max(1, min(_processors(), cells // CELLS_PER_THREAD, MOST_TEXT_THREADS))


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def csv_bytes(
    columns: Columns,
    significant_digits: int = SHORTEST,
    threads: int = 0,
    units: bool = False,
    decimal_comma: bool = False,
) -> bytes:
    """The whole file as UTF-8; `SHORTEST` or 1 to 15 significant digits; threads 0: as many as the
    table is worth; with `units` in the header, as `theta [deg]`; with a decimal comma, and then
    semicolons between the cells."""
    labels = [
        csv_text(f"{column.label} [{column.unit}]" if units and column.unit else column.label)
        for column in columns.columns
    ]
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
    if decimal_comma:
        is_number = [not isinstance(column.values, Words) for column in columns.columns]
        return _with_commas(text.decode(), is_number)
    return text


def _with_commas(text: str, is_number: Sequence[bool]) -> bytes:
    """CSV with a comma in its numbers, and semicolons between its cells."""
    stream = StringIO()
    writer = csv.writer(stream, delimiter=";", lineterminator="\n")
    header, *rows = csv.reader(StringIO(text, newline=""))
    writer.writerow(header)
    for row in rows:
        cells = zip(row, is_number, strict=True)
        writer.writerow([one.replace(".", ",") if number else one for one, number in cells])
    return stream.getvalue().encode()


def _numbers(column: TableColumn, significant_digits: int) -> FloatArray | WordColumn:
    """The cells as the kernel takes them: as texts where one is infinite."""
    assert not isinstance(column.values, Words)
    cells = number_column(column.values)
    if column.unbounded is None:
        return cells
    one: bytes = _kernel.csv_text(
        [""], [cells], significant_digits=significant_digits, quoted_empty=False, threads=1
    )
    return word_column(words_of(column.texts(one.decode().split("\n")[1:-1])))
