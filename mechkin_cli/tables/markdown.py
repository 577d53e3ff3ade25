"""Markdown of a table: title, labels with units, declared decimals, footnotes.

Cells are padded so that the text reads as a table in a terminal as well. Undeclared decimals are
chosen as `mechkin_cli.tables.decimal_text` says.
"""

from __future__ import annotations

from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.decimal_text import decimal_column
from mechkin_cli.tables.footnotes import footnotes
from mechkin_cli.tables.native_columns import threads_for, word_column
from mechkin_cli.tables.neutral import markdown_text
from mechkin_cli.tables.source import Source


def markdown_bytes(columns: Columns, source: Source, threads: int = 0) -> bytes:
    """The whole file as UTF-8, with a newline at its end and no trailing spaces; threads 0: as many
    as the table is worth."""
    from mechkin_cli.kernel import _kernel

    headers = [_header(column) for column in columns.columns]
    cells = [
        word_column(column.values, markdown_text)
        if isinstance(column.values, Words)
        else decimal_column(column.values, column.decimals)
        for column in columns.columns
    ]
    title = f"# {markdown_text(columns.title or columns.name)}\n\n"
    table: bytes = _kernel.markdown_text(headers, cells, threads_for(columns, threads))
    notes = "".join(f"- {note}\n" for note in footnotes(columns, source, markdown_text))
    return b"".join((title.encode(), table, f"\n{notes}".encode() if notes else b""))


def _header(column: Column) -> str:
    label = markdown_text(column.label)
    return f"{label} [{column.unit}]" if column.unit else label
