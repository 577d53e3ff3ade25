"""The tables of a mechanism that name printed values, beside these values."""

from __future__ import annotations

import posixpath
from collections.abc import Sequence
from pathlib import Path

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.agreement import agreement
from mechkin_cli.tables.columns import Columns
from mechkin_cli.tables.errata import PrintedTable
from mechkin_cli.tables.layout import TableLayout
from mechkin_cli.tables.printed import read_printed


def against_print(
    file: Path, layouts: Sequence[TableLayout], tables: Sequence[Columns]
) -> list[PrintedTable]:
    """The tables of the mechanism file `file` that have printed values, compared with them.

    Raises:
        UsageError: printed values cannot be read, or do not belong to the table.
        InvalidFile: a file of printed values is no table of numbers.
    """
    found = []
    for layout, table in zip(layouts, tables, strict=True):
        if layout.published is None:
            continue
        place = file.parent / layout.published.file
        try:
            compared = agreement(table, read_printed(place), layout.published.rows_by)
        except ValueError as error:
            raise UsageError(f"{place}: {error}") from error
        link = posixpath.relpath(layout.published.file, file.stem)
        found.append(PrintedTable(table, layout.published, compared, link))
    return found
