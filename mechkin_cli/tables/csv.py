"""CSV of a table: RFC 4180 with LF line ends, labels as header, numbers as the kernel writes them.

Numbers have the shortest digits that read back as the same double, or, for tables kept under
version control, the shortest of the value rounded to a number of significant digits; an empty cell
is a missing value, in quotes where it is alone in its line, as many readers skip blank lines.
With a decimal comma, for spreadsheets of countries that write it, semicolons part the cells.
Labels that a spreadsheet would take for formulas begin with an apostrophe (`tables/layout.py`).
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.columns import FloatArray, TableColumn, Words, number_column, words_of
from mechkin_cli.tables.layout import csv_text
from mechkin_cli.tables.table import Columns
from mechkin_cli.tolerances import CELLS_PER_THREAD, MOST_TEXT_THREADS, TEXT_ROOM

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
    return max(1, min(_kernel.available_processors(), cells // CELLS_PER_THREAD, MOST_TEXT_THREADS))


class CsvStyle(NamedTuple):
    """How tables stand in CSV.

    Attributes:
        significant_digits: `SHORTEST`, or 1 to 15.
        threads: that write; 0: as many as a table is worth.
        units: whether the header has them, as `theta [deg]`.
        decimal_comma: whether numbers have a comma, and semicolons part the cells.
    """

    significant_digits: int = SHORTEST
    threads: int = 0
    units: bool = False
    decimal_comma: bool = False


PLAIN_CSV = CsvStyle()


class TextRoom:
    """Memory that lines are written into, the same for all blocks of all tables of a run: they are
    written to their files before the next ones take their place."""

    def __init__(self, size: int = TEXT_ROOM) -> None:
        self._size = size  # for each thread
        self._memory = np.empty(0, np.uint8)
        self.rows_done = 0
        """Rows whose text was used, of those whose pieces were asked for last."""

    def pieces(
        self,
        rows: int,
        write: Callable[[int, NDArray[np.uint8]], tuple[int, list[tuple[int, int]]]],
        threads: int = 1,
    ) -> Iterator[memoryview]:
        """The text of all rows; each piece is to be used before the next one is asked for.

        Args:
            write: takes the first row and the memory, and says the row behind the last one for
                which there was room, with the starts and sizes of the pieces.
            threads: that write.
        """
        row = self.rows_done = 0
        while row < rows:
            size = self._size * threads
            if self._memory.size < size:
                self._memory = np.empty(size, np.uint8)
            end, pieces = write(row, self._memory[:size])
            if end == row:  # not even one line
                self._size *= 2
            view = self._memory.data
            for start, count in pieces:
                yield view[start : start + count]
            row = self.rows_done = end


def csv_header(columns: Iterable[tuple[str, str]], style: CsvStyle = PLAIN_CSV) -> bytes:
    """The first line, of labels and units."""
    labels = [
        csv_text(f"{label} [{unit}]" if style.units and unit else label) for label, unit in columns
    ]
    return _kernel.csv_header(labels, style.decimal_comma).encode()


def csv_lines(
    columns: Sequence[TableColumn], room: TextRoom, style: CsvStyle = PLAIN_CSV
) -> Iterator[memoryview]:
    """The lines of a block of rows, piece by piece, as `TextRoom.pieces`."""
    cells = [
        word_column(column.values, csv_text)
        if isinstance(column.values, Words)
        else _numbers(column, style)
        for column in columns
    ]
    threads = threads_for(columns, style.threads)
    return room.pieces(
        columns[0].rows if columns else 0,
        lambda first, memory: _kernel.csv_lines(
            cells,
            first,
            memory,
            significant_digits=style.significant_digits,
            quoted_empty=len(columns) == 1,
            decimal_comma=style.decimal_comma,
            threads=threads,
        ),
        threads,
    )


def csv_bytes(
    columns: Columns,
    significant_digits: int = SHORTEST,
    threads: int = 0,
    units: bool = False,
    decimal_comma: bool = False,
) -> bytes:
    """The whole file as UTF-8, with a `CsvStyle` of these."""
    style = CsvStyle(significant_digits, threads, units, decimal_comma)
    text = BytesIO(csv_header(((c.label, c.unit) for c in columns.columns), style))
    text.seek(0, os.SEEK_END)
    for piece in csv_lines(columns.columns, TextRoom(), style):
        text.write(piece)
    return text.getvalue()


_LONGEST_NUMBER = 40
"""Room for a number alone in its line."""


def _numbers(column: TableColumn, style: CsvStyle) -> FloatArray | WordColumn:
    """The cells as the kernel takes them: as texts where one is infinite."""
    assert not isinstance(column.values, Words)
    cells = number_column(column.values)
    if column.unbounded is None or not column.unbounded.any():
        return cells
    pieces = TextRoom(min(TEXT_ROOM, _LONGEST_NUMBER * cells.size)).pieces(
        cells.size,
        lambda first, memory: _kernel.csv_lines(
            [cells], first, memory, style.significant_digits, decimal_comma=style.decimal_comma
        ),
    )
    lines = b"".join(map(bytes, pieces)).decode()
    return word_column(words_of(column.texts(lines.split("\n")[:-1])))
