"""Tables on stdout: aligned columns that fit the terminal, long tables shortened in the middle."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.decimal_text import column_texts

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis

MOST_ROWS = 60
"""Longer tables are shown with this many rows."""

GAP = "  "


def shown_tables(analysis: Analysis, folder: Path) -> Iterator[str]:
    """Each table as text that ends in an empty line; the files in `folder` hold all of it."""
    width = shutil.get_terminal_size((80, 24)).columns
    for table in analysis.tables:
        yield _table_text(table, analysis.rows, width, folder)


def _table_text(table: Columns, rows: int, width: int, folder: Path) -> str:
    chosen = _chosen_rows(rows)
    columns = [_cells(column, chosen) for column in table.columns]
    lines = [f"{table.name}: {table.title}" if table.title != table.name else table.name]
    for group in _groups(columns, width):
        lines.append("")
        for row in zip(*group, strict=True):
            lines.append(GAP.join(row).rstrip())
    if len(chosen) < rows:
        lines.append(f"({rows - len(chosen)} of {rows} rows left out here; all are in {folder})")
    return "\n".join(lines) + "\n\n"


def _chosen_rows(rows: int) -> list[int]:
    if rows <= MOST_ROWS:
        return list(range(rows))
    half = MOST_ROWS // 2
    return [*range(half), *range(rows - half, rows)]


def _cells(column: Column, chosen: list[int]) -> list[str]:
    """Label, unit and cells of a column, padded to one width."""
    if isinstance(column.values, Words):
        every = column.values.texts()
        texts = [every[i] for i in chosen]
    else:
        texts = column_texts(column.values[chosen], column.decimals)
    cells = [column.label, f"[{column.unit}]" if column.unit else "", *texts]
    width = max(map(len, cells))
    return [cell.rjust(width) for cell in cells]


def _groups(columns: list[list[str]], width: int) -> Iterator[list[list[str]]]:
    """Columns side by side within the width; the first column leads every group."""
    group = columns[:1]
    for cells in columns[1:]:
        taken = sum(len(c[0]) + len(GAP) for c in group)
        if len(group) > 1 and taken + len(cells[0]) > width:
            yield group
            group = columns[:1]
        group.append(cells)
    yield group
