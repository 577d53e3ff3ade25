"""Markdown text of a table: title, labels with units, declared decimals, footnotes.

Cells are padded so that the text reads as a table in a terminal as well. Undeclared decimals are
chosen as `mechkin_cli.tables.decimal_text` says.
"""

from __future__ import annotations

from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.decimal_text import column_texts
from mechkin_cli.tables.footnotes import footnotes
from mechkin_cli.tables.source import Source

_NARROWEST = 4  # room for the alignment row's `---:`


def markdown_text(columns: Columns, source: Source) -> str:
    """The whole file, with a newline at its end and no trailing spaces."""
    padded = [_padded(column) for column in columns.columns]
    lines = [f"# {_one_line(columns.title or columns.name)}", ""]
    lines += [f"| {' | '.join(cells)} |" for cells in zip(*padded, strict=True)]
    notes = footnotes(columns, source)
    if notes:
        lines += ["", *(f"- {_one_line(note)}" for note in notes)]
    return "\n".join(lines) + "\n"


def _padded(column: Column) -> list[str]:
    """Header, alignment and cells of one column, all of one width."""
    is_text = isinstance(column.values, Words)
    header = _escaped(f"{column.label} [{column.unit}]" if column.unit else column.label)
    cells = [header, *_cells(column)]
    width = max(_NARROWEST, *map(len, cells))
    cells = [cell.ljust(width) if is_text else cell.rjust(width) for cell in cells]
    rule = ":" + "-" * (width - 1) if is_text else "-" * (width - 1) + ":"
    return [cells[0], rule, *cells[1:]]


def _cells(column: Column) -> list[str]:
    if isinstance(column.values, Words):
        return [_escaped(text) for text in column.values.texts()]
    return column_texts(column.values, column.decimals)


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _escaped(text: str) -> str:
    """One line of text that cannot end a cell."""
    return _one_line(text).replace("\\", "\\\\").replace("|", "\\|")
