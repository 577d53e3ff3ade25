"""A whole table: its columns evaluated, with what stands below it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from mechkin_cli.record import NamedTuple, dataclass, replace
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
    from io import RawIOBase
    from typing import IO

    from mechkin_cli.tables.summary import Summary


Sink: TypeAlias = "IO[bytes] | RawIOBase"
"""A file that bytes are written to."""


class Heading(NamedTuple):
    """A column before its rows: its label, its unit ("" where it has none), and what it holds.

    Attributes:
        kind: `number`, `whole` or `text`.
        texts: all that a column of texts may hold; () where they are not known before.
    """

    label: str
    unit: str = ""
    kind: str = "number"
    texts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Columns(Listed):
    """One evaluated table; `of_rows` says that its rows are those of the run, `summary` what stands
    below it."""

    name: str
    title: str
    columns: tuple[TableColumn, ...]
    of_rows: bool = True
    summary: Summary | None = None

    def chosen(self, labels: Sequence[str]) -> Columns:
        """With those of its columns alone that have one of the labels, in the order of these."""
        numbers = {column.label: number for number, column in enumerate(self.columns)}
        kept = [numbers[label] for label in labels if label in numbers]
        summary = self.summary
        if summary is not None:
            by_number = {column.number: column for column in summary.columns}
            below = [
                by_number[number]._replace(number=place)
                for place, number in enumerate(kept)
                if number in by_number
            ]
            summary = summary._replace(columns=tuple(below)) if below else None
        columns = tuple(self.columns[number] for number in kept)
        return replace(self, columns=columns, summary=summary)

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
