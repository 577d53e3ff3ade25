"""Every printed cell that does not agree with the computed one, as a table and as plain data.

The errata page shows the worst few of a table; here each can be found: the table, the computed row
counted from 1, what found the row in the print, the column, both numbers, and printed less computed
in units of the last printed digit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.tables.columns import Column, Columns, words_of
from mechkin_cli.tables.csv_writer import COMMITTED_DIGITS, csv_bytes

if TYPE_CHECKING:
    from mechkin_cli.tables.agreement import PrintedCell
    from mechkin_cli.tables.errata import PrintedTable

NAME = "disagreements.csv"
"""File beside the errata page; there is none where all cells agree."""

HEADER = "table,row,found by,at,column,printed,computed,units\n"
"""Its first line."""


def disagreements_csv(tables: Sequence[PrintedTable]) -> bytes:
    """The file, as UTF-8; empty where all cells agree."""
    found = [(one, cell) for one in tables for cell in one.agreement.off]
    if not found:
        return b""
    columns = (
        _words("table", [one.table.name for one, _ in found]),
        _numbers("row", [cell.row for _, cell in found]),
        _words("found by", [one.agreement.rows_by for one, _ in found]),
        _numbers("at", [float(cell.key) for _, cell in found]),
        _words("column", [cell.label for _, cell in found]),
        _numbers("printed", [float(cell.printed) for _, cell in found]),
        _numbers("computed", [float(cell.computed) for _, cell in found]),
        _numbers("units", [float(cell.units) for _, cell in found]),
    )
    return csv_bytes(Columns("disagreements", "", columns), COMMITTED_DIGITS)


def against_print_record(tables: Sequence[PrintedTable]) -> list[dict[str, Any]]:
    """Counts and disagreeing cells of each table, as JSON has them; numbers keep their digits."""
    return [
        {
            "table": one.table.name,
            "published": one.published.file,
            "rows_by": one.agreement.rows_by,
            "cells": len(one.agreement.cells),
            "agree": one.agreement.agreeing,
            "one_off": one.agreement.one_off,
            "differ": one.agreement.differing,
            "disagreements": [_cell_record(cell) for cell in one.agreement.off],
        }
        for one in tables
    ]


def _cell_record(cell: PrintedCell) -> dict[str, Any]:
    return {
        "row": cell.row,
        "at": str(cell.key),
        "column": cell.label,
        "printed": str(cell.printed),
        "computed": float(cell.computed),
        "units": float(cell.units),
    }


def _words(label: str, texts: Sequence[str]) -> Column:
    return Column(label, "", words_of(texts))


def _numbers(label: str, values: Sequence[float]) -> Column:
    return Column(label, "", np.array(values, dtype=np.float64))
