"""Tables on stdout: aligned columns that fit the terminal, long tables shortened in the middle."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from mechkin_cli.legible import legible
from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.decimal_text import column_texts

if TYPE_CHECKING:
    from mechkin_cli.interface import Analysis
    from mechkin_cli.tables.summary import Summary

MOST_ROWS = 60
"""Longer tables are shown with this many rows."""

GAP = "  "


def shown_tables(analysis: Analysis, folder: Path) -> Iterator[str]:
    """Each table as text that ends in an empty line; the files in `folder` hold all of it."""
    width = shutil.get_terminal_size((80, 24)).columns
    chosen = _chosen_rows(analysis.rows)
    for table in analysis.tables:
        title = _one_line(table.title)
        heading = f"{table.name}: {title}" if title != table.name else table.name
        lines = wrap(heading, width)
        for group in _grouped(table, chosen, width):
            lines += ["", *group]
        left_out = analysis.rows - len(chosen)
        if left_out:
            lines.append(f"({left_out} of {analysis.rows} rows left out here; all are in {folder})")
        if table.summary is not None:
            from mechkin_cli.tables.summary import written_notes

            notes = written_notes(table.summary, _one_line)
            lines += [line for note in notes for line in wrap(f"({note})", width)]
        yield "\n".join(lines) + "\n\n"


def shown_table(table: Columns, count: int) -> str:
    """All rows of one table, without its title."""
    width = shutil.get_terminal_size((80, 24)).columns
    groups = _grouped(table, range(count), width)
    return "\n\n".join("\n".join(group) for group in groups) + "\n"


def _grouped(table: Columns, rows: Sequence[int], width: int) -> Iterator[list[str]]:
    """The lines of the columns that fit side by side, group by group."""
    columns = [_texts(column, rows) for column in table.columns]
    if table.summary is not None:
        columns = _with_summary(columns, table.summary)
    for group in _groups([_padded(cells) for cells in columns], width):
        yield [GAP.join(row).rstrip() for row in zip(*group, strict=True)]


def _with_summary(columns: list[list[str]], summary: Summary) -> list[list[str]]:
    """The columns with what stands below them; its words stand in the first column, or in one of
    their own where that is summed up itself."""
    below = {each.number: summary.texts(each) for each in summary.columns}
    words, gap = list(summary.lines), len(summary.lines) * [""]
    if 0 in below:
        columns = [len(columns[0]) * [""], *columns]
        below = {number + 1: texts for number, texts in below.items()}
    below[0] = words
    return [[*cells, "", *below.get(number, gap)] for number, cells in enumerate(columns)]


def _one_line(text: str) -> str:
    return legible(" ".join(text.split()), also="")


def _chosen_rows(rows: int) -> list[int]:
    if rows <= MOST_ROWS:
        return list(range(rows))
    half = MOST_ROWS // 2
    return [*range(half), *range(rows - half, rows)]


def _texts(column: Column, chosen: Sequence[int]) -> list[str]:
    """Label, unit and cells of a column."""
    if isinstance(column.values, Words):
        texts = column.values.texts(chosen)
    else:
        part = column.part(chosen)
        texts = part.texts(column_texts(part.numbers, part.decimals))
    return [_one_line(column.label), f"[{column.unit}]" if column.unit else "", *texts]


def _padded(cells: list[str]) -> list[str]:
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
