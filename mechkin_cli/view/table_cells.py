"""Tables as the texts of their cells, the same as in CSV."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from mechkin_cli.tables.columns import Columns
from mechkin_cli.tables.csv_writer import csv_bytes
from mechkin_cli.tables.table_text import read_table_text

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from mechkin_cli.view.encoding import Plain


def table_record(table: Columns, run: str, rows: NDArray[np.intp], codes: list[int]) -> Plain:
    """A table for the page: of one that has the rows of its run some `rows` with the `codes` of
    their verdicts, of others all."""
    shown = _part(table, rows) if table.of_rows else table
    cells = read_table_text("cells.csv", csv_bytes(shown)).rows
    return {
        "name": table.name,
        "title": table.title,
        "run": run,
        "columns": [{"label": one.label, "unit": one.unit} for one in table.columns],
        "rows": [list(row) for row in cells],
        "status": codes if table.of_rows else [],
    }


def _part(table: Columns, rows: NDArray[np.intp]) -> Columns:
    return replace(table, columns=tuple(column.part(rows) for column in table.columns))
