"""All tables of a file as one workbook of Office Open XML (`.xlsx`), a sheet each.

Columns, labels and units are those of CSV. Numbers are cells of numbers with all their digits; a
missing value is an empty cell, and what grows without bound, a status or a mode is text, which no
spreadsheet takes for a formula. The bytes depend on the tables alone: all dates are those of
`WRITTEN`. It is made by openpyxl, which is loaded only here.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from io import BytesIO
from typing import TYPE_CHECKING, Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np

from mechkin_cli.diagnostics import UsageError, legible
from mechkin_cli.tables.columns import TableColumn, Words
from mechkin_cli.tables.table import NEEDS_OPENPYXL, Columns, summary_table

if TYPE_CHECKING:
    from mechkin_cli.tables.results import Results

MOST_ROWS = 1_048_576
MOST_COLUMNS = 16_384
LONGEST_NAME = 31
LONGEST_TEXT = 32_767
"""Limits of Excel: rows and columns of a sheet, characters of its name and of a cell."""

WRITTEN = datetime(1980, 1, 1)
"""The date of every workbook and of the files in it: the first that an archive can have."""

_NOT_IN_NAMES = re.compile(r"[\[\]:*?/\\]|^'|'$")
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
    for results in runs:
        for table in _with_summaries(results.tables):
            _refuse_large(table)
            sheet = book.create_sheet(sheet_name(table.name, taken))
            sheet.freeze_panes = "A2"
            for row in _rows(table, results.units, sheet):
                sheet.append(row)
    if not taken:
        book.create_sheet("no tables")
    stream = BytesIO()
    book.save(stream)
    return _undated(stream.getvalue())


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
        raise UsageError(NEEDS_OPENPYXL) from None
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


def _rows(table: Columns, units: bool, sheet: Any) -> Iterator[list[Any]]:
    from openpyxl.cell import WriteOnlyCell

    def cell_of(value: str, kind: str) -> Any:
        cell = WriteOnlyCell(sheet)
        cell.value = value
        cell.data_type = kind
        return cell

    def text(value: str) -> Any:
        return cell_of(legible(value), "s")  # never a formula

    def number(value: float) -> Any:
        # as a text of all digits: of floats openpyxl writes 16
        return cell_of(repr(value), "n")

    columns = table.columns
    yield [text(f"{c.label} [{c.unit}]" if units and c.unit else c.label) for c in columns]
    every = [_cells(column) for column in columns]
    for row in zip(*every, strict=True):
        yield [
            each if each is None else text(each) if isinstance(each, str) else number(each)
            for each in row
        ]


def _cells(column: TableColumn) -> list[str | float | None]:
    """Numbers, None for what is missing, and words."""
    if isinstance(column.values, Words):
        return [word or None for word in column.values.texts(range(column.rows))]
    numbers = column.numbers
    return [
        number if finite else None if number != number else "inf" if number > 0.0 else "-inf"
        for number, finite in zip(numbers.tolist(), np.isfinite(numbers).tolist(), strict=True)
    ]


def _undated(content: bytes) -> bytes:
    """The archive with one date for all of its files."""
    stream = BytesIO()
    date = WRITTEN.timetuple()[:6]
    with ZipFile(BytesIO(content)) as made, ZipFile(stream, "w") as archive:
        for name in made.namelist():
            part = made.read(name)
            if name == "docProps/core.xml":
                part = _MODIFIED.sub(rb"\g<1>" + f"{WRITTEN.isoformat()}Z".encode(), part)
            archive.writestr(ZipInfo(name, date), part, ZIP_DEFLATED)
    return stream.getvalue()
