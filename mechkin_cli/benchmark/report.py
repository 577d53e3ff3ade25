"""What the benchmark found: tables of cells, as data for programs and as text for a person."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

Cell = str | float | int | bool | None
Kind = Literal["text", "time", "error", "ratio", "percent", "number", "verdict"]


@dataclass(frozen=True)
class Column:
    """`key` names the column for programs, `label` (which may have two lines) for a person."""

    key: str
    label: str
    kind: Kind = "text"


@dataclass(frozen=True)
class Table:
    """One part of the report; each row maps column keys to values."""

    name: str
    title: str
    columns: Sequence[Column]
    rows: Sequence[Mapping[str, Cell]]
    notes: Sequence[str] = field(default_factory=tuple)

    def record(self) -> dict[str, object]:
        """As plain data."""
        return {
            "title": self.title,
            "rows": [{c.key: row.get(c.key) for c in self.columns} for row in self.rows],
            "notes": list(self.notes),
        }

    def texts(self) -> list[list[str]]:
        """The cells as text, row by row."""
        return [[cell_text(row.get(c.key), c.kind) for c in self.columns] for row in self.rows]


def key_of(name: str) -> str:
    """A mechanism's name as part of a table's name: letters and digits, the rest as underscores."""
    return "".join(c if c.isalnum() else "_" for c in name.lower())


def cell_text(value: Cell, kind: Kind) -> str:
    """A cell for a person; nothing is an empty text."""
    if value is None:
        return ""
    if kind == "verdict":
        return "yes" if value else "no"
    if isinstance(value, str) or kind == "text":
        return str(value)
    if kind == "time":
        return _significant(value)
    if kind == "error":
        return f"{value:.1e}"
    if kind == "percent":
        return f"{100.0 * value:.0f}"
    return f"{value:.2f}" if kind == "ratio" else f"{value:.10g}"


def _significant(value: float) -> str:
    """Three significant digits without an exponent."""
    if value >= 100.0:
        return f"{value:.0f}"
    return f"{value:.1f}" if value >= 10.0 else f"{value:.2f}" if value >= 1.0 else f"{value:.3f}"


def width(table: Table) -> int:
    """Characters that the columns need side by side."""
    lines = plain_text(replace(table, notes=())).splitlines()
    return max(map(len, lines))


def plain_text(table: Table) -> str:
    """Aligned columns, numbers to the right."""
    labels = [column.label.split("\n") for column in table.columns]
    depth = max(map(len, labels))
    head = [[""] * (depth - len(label)) + label for label in labels]
    lines = [list(line) for line in zip(*head, strict=True)] + table.texts()
    widths = [max(len(line[i]) for line in lines) for i in range(len(table.columns))]
    text = [table.title, ""]
    for line in lines:
        cells = [
            cell.ljust(width) if column.kind == "text" else cell.rjust(width)
            for cell, width, column in zip(line, widths, table.columns, strict=True)
        ]
        text.append("  ".join(cells).rstrip())
    return "\n".join([*text, *([""] if table.notes else []), *table.notes]) + "\n"
