"""Printed values of a table: a CSV file with the digits as the source prints them.

The first line holds labels of the table, the first of them that of the column by which rows are
found again. A cell's text carries its precision: `1.30` is printed to 0.01. Empty cells are values
that the source does not have, or that cannot be read.
"""

from __future__ import annotations

import re
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError
from mechkin_cli.regular_file import read_regular
from mechkin_cli.tables.table_text import read_table_text

MOST_BYTES = 1 << 20
"""Size of a file of printed values; the longest printed tables have some ten kilobytes."""

_NUMBER = re.compile(
    r"[+-]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][+-]?[0-9]{1,2})?"
)

Cell = Decimal | None


class PrintedValues(NamedTuple):
    """Labels and rows of numbers, as printed; None where the print has no value."""

    labels: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]


def read_printed(path: Path) -> PrintedValues:
    """The printed values in a CSV file.

    Raises:
        UsageError: the file cannot be read.
        InvalidFile: it is no table of numbers; with the place of each error.
    """
    try:
        content = read_regular(path, MOST_BYTES)
    except OSError as error:
        raise UsageError(
            f"cannot read the printed values {path}: {error.strerror}; "
            "put the file there or correct `published:`"
        ) from error
    if len(content) > MOST_BYTES:
        raise _invalid(path, 1, 1, f"the file is larger than {MOST_BYTES} bytes", "shorten it")
    try:
        labels, rows, _ = read_table_text("printed.csv", content)
    except ValueError as error:
        raise _invalid(path, 1, 1, str(error), "write CSV in UTF-8") from error
    labels = tuple(label.removeprefix("\ufeff").strip() for label in labels)
    if not any(labels) or len(set(labels)) < len(labels):
        raise _invalid(path, 1, 1, "the first line must hold labels, each one once", "add them")
    filled = [(line, row) for line, row in enumerate(rows, start=2) if any(map(str.strip, row))]
    return PrintedValues(labels, tuple(_numbers(path, line, labels, row) for line, row in filled))


def _numbers(
    path: Path, line: int, labels: tuple[str, ...], row: tuple[str, ...]
) -> tuple[Cell, ...]:
    if len(row) != len(labels):
        text = f"the row has {len(row)} cells for {len(labels)} labels"
        raise _invalid(path, line, 1, text, "leave a cell empty where the print has no value")
    return tuple(_number(path, line, row, place, labels[place]) for place in range(len(row)))


def _number(path: Path, line: int, row: tuple[str, ...], place: int, label: str) -> Cell:
    text = row[place].strip()
    if not text:
        return None
    if not _NUMBER.fullmatch(text):
        column = 1 + sum(len(cell) + 1 for cell in row[:place])
        message = f"{label}: {text[:40]!r} is no number"
        raise _invalid(path, line, column, message, "write the digits as printed, or nothing")
    return Decimal(text)


def _invalid(path: Path, line: int, column: int, message: str, hint: str) -> InvalidFile:
    place = Place(str(path), line, column)
    return InvalidFile([Diagnostic("printed-values", "error", message, place, hint=hint)])
