"""Reading table files back as text: labels, cells and the lines around them.

Cells stay the text that stands in the file; nothing is converted, so that a comparison sees what a
reader sees.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable
from itertools import groupby
from typing import NamedTuple

_UNESCAPED_BAR = re.compile(r"(?<!\\)\|")


class TableText(NamedTuple):
    """Labels and rows of cells; `lines` are the lines outside the table that are not blank."""

    labels: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    lines: tuple[str, ...] = ()


def read_table_text(name: str, content: bytes) -> TableText:
    """The table in a `.csv` or `.md` file; any other file, and a page of several tables, is lines
    without a table.

    Raises:
        ValueError: the content is not UTF-8 text, or no CSV.
    """
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError(f"byte {error.start} is not UTF-8 text") from error
    if name.endswith(".csv"):
        return _read_csv(text)
    if name.endswith(".md"):
        return _read_markdown(text)
    return TableText(lines=_filled(text.splitlines()))


def _read_csv(text: str) -> TableText:
    try:
        records = [tuple(record) for record in csv.reader(io.StringIO(text, newline=""))]
    except csv.Error as error:
        raise ValueError(f"not readable as CSV: {error}") from error
    if not records:
        return TableText()
    # a blank line is a row whose only cell is empty
    return TableText(records[0], tuple(record or ("",) for record in records[1:]))


def _read_markdown(text: str) -> TableText:
    lines = text.splitlines()
    table = [_markdown_cells(line) for line in lines if _is_of_table(line)]
    others = _filled(line for line in lines if not _is_of_table(line))
    if not table or _has_several_tables(lines):
        return TableText(lines=_filled(lines))
    return TableText(table[0], tuple(table[2:]), others)


def _is_of_table(line: str) -> bool:
    return line.lstrip().startswith("|")


def _has_several_tables(lines: Iterable[str]) -> bool:
    return sum(is_table for is_table, _ in groupby(lines, _is_of_table)) > 1


def _markdown_cells(line: str) -> tuple[str, ...]:
    return tuple(cell.strip() for cell in _UNESCAPED_BAR.split(line.strip())[1:-1])


def _filled(lines: Iterable[str]) -> tuple[str, ...]:
    return tuple(line.rstrip() for line in lines if line.strip())
