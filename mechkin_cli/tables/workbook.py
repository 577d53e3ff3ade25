"""All tables of a file as one workbook of Office Open XML (`.xlsx`), a sheet each.

Columns, labels and units are those of CSV. Numbers are cells of numbers with all their digits; a
missing value is an empty cell, and what grows without bound, a status or a mode is text, which no
spreadsheet takes for a formula. The bytes depend on the tables alone: all dates are those of
`WRITTEN`. It is made by openpyxl, which is loaded only here.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from io import BytesIO
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from mechkin_cli.diagnostics import UsageError, legible
from mechkin_cli.tables.columns import TableColumn, Words
from mechkin_cli.tables.table import Columns, summary_table

if TYPE_CHECKING:
    from mechkin_cli.tables.results import Results

MOST_ROWS = 1_048_576
MOST_COLUMNS = 16_384
LONGEST_NAME = 31
LONGEST_TEXT = 32_767
"""Limits of Excel: rows and columns of a sheet, characters of its name and of a cell."""

ROWS_AT_ONCE = 10_000
"""Rows that are made into text together."""

WRITTEN = datetime(1980, 1, 1)
"""The date of every workbook and of the files in it: the first that an archive can have."""

_NOT_IN_NAMES = re.compile(r"[\[\]:*?/\\]|^'|'$")
_NO_ROWS = re.compile(rb"<sheetData\s*/>|<sheetData></sheetData>")
_MODIFIED = re.compile(rb"(<dcterms:modified[^>]*>)[^<]*")


def workbook_bytes(runs: Sequence[Results]) -> bytes:
    """The workbook of all tables of all runs, each with its summary behind it.

    Raises:
        UsageError: openpyxl is not installed, or a table is larger than a sheet may be, or one of
            its texts longer than a cell.
    """
    book = _openpyxl().Workbook(write_only=True)
    book.properties.creator = "mechkin"
    book.properties.created = WRITTEN
    taken: set[str] = set()
    sheets: dict[str, tuple[Columns, bool]] = {}
    for results in runs:
        for table in _with_summaries(results.tables):
            _refuse_large(table)
            sheet = book.create_sheet(sheet_name(table.name, taken))
            sheet.freeze_panes = "A2"
            sheets[f"xl/worksheets/sheet{len(taken)}.xml"] = table, results.units
    if not taken:
        book.create_sheet("no tables")
    stream = BytesIO()
    book.save(stream)
    return _filled(stream.getvalue(), sheets)


def sheet_name(name: str, taken: set[str]) -> str:
    """A name that a sheet may have and no other has, in capitals or not; it is added to `taken`.

    Example:
        >>> sheet_name("a/b", {"A_B"}), sheet_name(40 * "x", set()) == 31 * "x"
        ('a_b~2', True)
    """
    wished = _NOT_IN_NAMES.sub("_", legible(name))
    found, number = wished[:LONGEST_NAME], 1
    while found.upper() in taken:
        number += 1
        end = f"~{number}"
        found = wished[: LONGEST_NAME - len(end)] + end
    taken.add(found.upper())
    return found


def _openpyxl() -> Any:
    try:
        import openpyxl
    except ImportError:
        raise UsageError("xlsx needs openpyxl: pip install 'mechkin[xlsx]'") from None
    return openpyxl


def _with_summaries(tables: Iterable[Columns]) -> Iterator[Columns]:
    for table in tables:
        yield table
        if table.summary is not None:
            yield summary_table(table.name, table.title, table.summary)


def _refuse_large(table: Columns) -> None:
    rows = max((column.rows for column in table.columns), default=0) + 1
    for count, most, what in (
        (rows, MOST_ROWS, "rows with its header"),
        (len(table.columns), MOST_COLUMNS, "columns"),
    ):
        if count > most:
            raise UsageError(
                f"table {table.name} has {count} {what}, and a sheet of a workbook at most {most}; "
                "write it as --format csv"
            )
    for column in table.columns:
        words = column.values.words if isinstance(column.values, Words) else ()
        longest = max(map(len, map(legible, (f"{column.label} [{column.unit}]", *words))))
        if longest > LONGEST_TEXT:
            raise UsageError(
                f"table {table.name} has a text of {longest} characters, and a cell of a workbook "
                f"holds at most {LONGEST_TEXT}; write it as --format csv"
            )


def _rows(table: Columns, units: bool) -> Iterator[str]:
    """The rows of a sheet with its header, some at a time, as the elements that hold them."""
    columns = table.columns
    heads = [f"{c.label} [{c.unit}]" if units and c.unit else c.label for c in columns]
    yield _elements(1, [[head] for head in heads])
    for first in range(0, max((column.rows for column in columns), default=0), ROWS_AT_ONCE):
        rows = slice(first, first + ROWS_AT_ONCE)
        yield _elements(first + 2, [_cells(column, rows) for column in columns])


def _elements(first: int, columns: Sequence[Sequence[str | float | None]]) -> str:
    """Rows from number `first` on. Of floats openpyxl writes 16 digits, and is slow; here a number
    is the shortest text of all its digits."""
    written = []
    for number, column in enumerate(columns):
        letters = _letters(number)
        written.append([_cell(f"{letters}{row}", each) for row, each in enumerate(column, first)])
    rows = map("".join, zip(*written, strict=True))
    return "".join(f'<row r="{row}">{cells}</row>' for row, cells in enumerate(rows, first))


def _cell(place: str, value: str | float | None) -> str:
    if value is None:
        return ""
    if isinstance(value, str):  # never a formula
        text = escape(legible(value))
        return f'<c r="{place}" t="inlineStr"><is><t xml:space="preserve">{text}</t></is></c>'
    return f'<c r="{place}"><v>{value!r}</v></c>'


def _letters(number: int) -> str:
    """The letters of a column, counted from 0.

    Example:
        >>> _letters(0), _letters(25), _letters(26), _letters(16383)
        ('A', 'Z', 'AA', 'XFD')
    """
    found = ""
    while number >= 0:
        number, letter = divmod(number, 26)
        found, number = chr(ord("A") + letter) + found, number - 1
    return found


def _cells(column: TableColumn, rows: slice) -> list[str | float | None]:
    """Numbers of some rows, None for what is missing, and words."""
    if isinstance(column.values, Words):
        return [word or None for word in column.values.texts(range(column.rows)[rows])]
    numbers = column.numbers[rows]
    return [
        number if finite else None if number != number else "inf" if number > 0.0 else "-inf"
        for number, finite in zip(numbers.tolist(), np.isfinite(numbers).tolist(), strict=True)
    ]


def _filled(content: bytes, sheets: Mapping[str, tuple[Columns, bool]]) -> bytes:
    """The archive with the rows of its sheets, and one date for all of its files."""
    stream = BytesIO()
    date = WRITTEN.timetuple()[:6]
    with ZipFile(BytesIO(content)) as made, ZipFile(stream, "w") as archive:
        for name in made.namelist():
            part = made.read(name)
            if name == "docProps/core.xml":
                part = _MODIFIED.sub(rb"\g<1>" + f"{WRITTEN.isoformat()}Z".encode(), part)
            info = ZipInfo(name, date)
            if name not in sheets:
                archive.writestr(info, part, ZIP_DEFLATED)
                continue
            info.compress_type = ZIP_DEFLATED
            before, after = _NO_ROWS.split(part)
            with archive.open(info, "w", force_zip64=True) as sheet:
                sheet.write(before + b"<sheetData>")
                for rows in _rows(*sheets[name]):
                    sheet.write(rows.encode())
                sheet.write(b"</sheetData>" + after)
    return stream.getvalue()
