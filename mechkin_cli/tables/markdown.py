"""Markdown of a table: title, labels with units, declared decimals, its summary, footnotes.

Cells are padded so that the text reads as a table in a terminal as well. Undeclared decimals are
chosen as `mechkin_cli.tables.decimal_text` says.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.tables.columns import Column, Columns, Words, words_of
from mechkin_cli.tables.decimal_text import column_texts, decimal_column
from mechkin_cli.tables.footnotes import footnotes
from mechkin_cli.tables.native_columns import threads_for, word_column
from mechkin_cli.tables.neutral import markdown_text
from mechkin_cli.tables.source import Source

if TYPE_CHECKING:
    from mechkin_cli.tables.decimal_text import DecimalColumn
    from mechkin_cli.tables.native_columns import WordColumn
    from mechkin_cli.tables.summary import Summary


def markdown_bytes(columns: Columns, source: Source, threads: int = 0) -> bytes:
    """The whole file as UTF-8, with a newline at its end and no trailing spaces; threads 0: as many
    as the table is worth."""
    from mechkin_cli.kernel import _kernel

    headers = [_padded_header(column) for column in columns.columns]
    cells = [
        word_column(column.values, markdown_text)
        if isinstance(column.values, Words)
        else _numbers(column)
        for column in columns.columns
    ]
    title = f"# {markdown_text(columns.title or columns.name)}\n\n"
    table: bytes = _kernel.markdown_text(headers, cells, threads_for(columns, threads))
    if any(column.unbounded is not None for column in columns.columns):
        table = _to_the_right(table, columns)
    below = "" if columns.summary is None else _below(columns.summary)
    notes = "".join(f"- {note}\n" for note in footnotes(columns, source, markdown_text))
    notes = below + (f"\n{notes}" if notes else "")
    return b"".join((title.encode(), table, notes.encode()))


def _below(summary: Summary) -> str:
    """The rows below a table as a table of their own, and what is said of them."""
    from mechkin_cli.tables.summary import written_notes

    columns = [["summary", *summary.lines]]
    for each in summary.columns:
        header = _header(Column(each.label, each.unit, np.empty(0)))
        columns.append([header, *summary.texts(each)])
    widths = [max(map(len, cells)) for cells in columns]
    pads = [str.ljust, *(str.rjust for _ in summary.columns)]
    head, *lines = (
        f"| {' | '.join(pad(*cell) for pad, *cell in zip(pads, row, widths, strict=True))} |\n"
        for row in zip(*columns, strict=True)
    )
    rule = [f":{'-' * (widths[0] - 1)}", *(f"{'-' * (width - 1)}:" for width in widths[1:])]
    said = "".join(f"- {note}\n" for note in written_notes(summary, markdown_text))
    return "".join(("\n", head, f"| {' | '.join(rule)} |\n", *lines, f"\n{said}" if said else ""))


def _numbers(column: Column) -> DecimalColumn | WordColumn:
    """The cells as the kernel takes them: as texts where one is infinite."""
    assert not isinstance(column.values, Words)
    if column.unbounded is None:
        return decimal_column(column.values, column.decimals)
    texts = _texts(column)
    width = max(len(_header(column)), *map(len, texts))
    return word_column(words_of([text.rjust(width) for text in texts]))


def _padded_header(column: Column) -> str:
    """The header, of cells that the kernel takes as texts as wide as they are."""
    header = _header(column)
    if column.unbounded is None:
        return header
    return header.rjust(max(map(len, _texts(column))))


def _texts(column: Column) -> list[str]:
    assert not isinstance(column.values, Words)
    return column.texts(column_texts(column.values, column.decimals))


def _to_the_right(table: bytes, columns: Columns) -> bytes:
    """The table with columns of numbers that the kernel took as texts set to the right."""
    head, rule, rest = table.split(b"\n", 2)
    marks = rule.split(b"|")
    for number, column in enumerate(columns.columns, 1):
        if column.unbounded is not None:
            marks[number] = b" " + marks[number].strip()[1:] + b": "
    return b"\n".join((head, b"|".join(marks), rest))


def _header(column: Column) -> str:
    label = markdown_text(column.label)
    return f"{label} [{column.unit}]" if column.unit else label
