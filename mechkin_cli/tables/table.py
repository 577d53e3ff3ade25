"""A whole table: its columns evaluated, with what stands below it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.record import dataclass
from mechkin_cli.show import Listed, Listing
from mechkin_cli.tables.columns import (
    AT,
    TableColumn,
    TableSource,
    Words,
    column_of,
    column_of_numbers,
    column_texts,
    rounding_of,
    words_of,
)
from mechkin_cli.tables.layout import TableLayout

if TYPE_CHECKING:
    from mechkin_cli.tables.summary import Summary

NEEDS_OPENPYXL = "--format xlsx needs openpyxl: pip install 'mechkin[xlsx]'"
"""Said of a workbook before anything is computed for it."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Columns(Listed):
    """One evaluated table; `of_rows` says that its rows are those of the run, `summary` what stands
    below it."""

    name: str
    title: str
    columns: tuple[TableColumn, ...]
    of_rows: bool = True
    summary: Summary | None = None

    @property
    def listing(self) -> Listing:
        """The cells as files write them, below labels with units."""
        labels = tuple(f"{c.label} [{c.unit}]" if c.unit else c.label for c in self.columns)
        rows = tuple(zip(*(_cells(column) for column in self.columns), strict=True))
        return Listing(f"{self.name}: {self.title}" if self.title else self.name, labels, rows)


def _cells(column: TableColumn) -> list[str]:
    if isinstance(column.values, Words):
        return column.values.texts(range(column.rows))
    return column.texts(column_texts(column.values, column.decimals, column.rounding))


def evaluate(table: TableLayout, source: TableSource) -> Columns:
    """All columns of a table, in file units.

    Raises:
        ExpressionError: a column is no number per row, or names what the source does not have.
    """
    columns = rounding_of(
        table.columns, [column_of(layout, source) for layout in table.columns], source
    )
    summary = None
    if table.summary:
        from mechkin_cli.tables.summary import summary_of

        summary = summary_of(table.summary, table.columns, columns, source)
    return Columns(table.name, table.title, columns, summary=summary)


def summary_table(name: str, title: str, summary: Summary) -> Columns:
    """The rows below a table as a table of its own, `NAME.summary`."""
    words: list[str] = []
    for line in summary.lines:
        words.append(f"{words[-1]} {AT}" if line == AT else line)
    columns = [TableColumn("summary", "", words_of(words))]
    for each in summary.columns:
        numbers = np.array(summary.numbers(each))
        columns.append(column_of_numbers(each.label, each.unit, numbers, each.decimals))
    return Columns(f"{name}.summary", f"Summary of {title or name}", tuple(columns), of_rows=False)
