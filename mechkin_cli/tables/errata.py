"""Tables against print, in Markdown: a mechanism's errata page, and a folder's overview page.

First the numbers that the source does not give, and what speaks for them. Per table: how many
printed cells agree, are one off in the last digit, differ; the columns that do not agree throughout
with their largest difference; the worst cells; the reasons in words, as the mechanism file gives
them. `disagreements.csv` lists every printed cell that does not agree.
"""

from __future__ import annotations

import posixpath
from collections.abc import Iterable, Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np

from mechkin_cli.diagnostics import UsageError, whole
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.tables.columns import TableColumn, words_of
from mechkin_cli.tables.csv import COMMITTED_DIGITS, csv_bytes
from mechkin_cli.tables.layout import (
    ROW_NUMBER,
    PrintedSource,
    TableLayout,
    counted,
    link_target,
    markdown_line,
    markdown_text,
)
from mechkin_cli.tables.print import PrintedCell, TableAgreement, agreement, read_printed
from mechkin_cli.tables.table import Columns

PAGE = "errata.md"
_THOUSAND, _MILLION = Decimal(1000), Decimal(1_000_000)
WORST_CELLS = 5
"""Cells shown per table; the rest is counted."""

HEAD = """\
A printed cell **agrees** when it is the computed number rounded to the printed digits, it is **one
off** when it is a neighbour of that number in the last digit, else it **differs**. Differences are
printed less computed; a *unit* is one unit of the last printed digit."""

ZERO_HEAD = """\
Cells of columns that are zero throughout, in print and computed, are counted apart (*zero*)."""


@dataclass(frozen=True, slots=True)
class PrintedTable:
    """A computed table, where its printed values stand, and how the two agree.

    `link` is the path from the page to the printed values.
    """

    table: Columns
    published: PrintedSource
    agreement: TableAgreement
    link: str


def errata_page(name: str, source: str, tables: Sequence[PrintedTable]) -> str:
    """The whole page of a mechanism, with a newline at its end."""
    parts = [f"# {markdown_text(whole(name))}: printed and computed values"]
    if source:
        parts.append(f"Source: {markdown_text(source)}.")
    parts += [HEAD, *_overview(tables), *_data(tables)]
    for table in tables:
        parts += _table_parts(table)
    return "\n\n".join(parts) + "\n"


def counts(agreements: Iterable[TableAgreement]) -> str:
    """Agreement of some tables in a few words: `12 of 15 cells agree, 2 one off, 1 differs`, and
    how many more are in columns of zeros."""
    total = TableAgreement(tuple(cell for one in agreements for cell in one.cells))
    text = f"{total.agreeing} of {counted(len(total.cells) - total.zero, 'cell')} agree"
    text += f", {total.one_off} one off" if total.one_off else ""
    differ = "differs" if total.differing == 1 else "differ"
    text += f", {total.differing} {differ}" if total.differing else ""
    return text + (f"; {total.zero} more in columns of zeros" if total.zero else "")


def _overview(tables: Sequence[PrintedTable]) -> list[str]:
    """The counts of all tables, with a column for zeros where there are any."""
    labels = ["table", "cells", "agree", "one off", "differ", "largest, units"]
    rows = [_table_row(one.table.name, one.agreement) for one in tables]
    if not any(one.agreement.zero for one in tables):
        return [_markdown(labels, rows)]
    zeros = [str(one.agreement.zero) for one in tables]
    rows = [[*row[:2], zero, *row[2:]] for row, zero in zip(rows, zeros, strict=True)]
    return [ZERO_HEAD, _markdown([*labels[:2], "zero", *labels[2:]], rows)]


def _data(tables: Sequence[PrintedTable]) -> list[str]:
    remarks = [remark for one in tables for remark in one.published.remarks if remark.data]
    if not remarks:
        return []
    lines = [f"- {markdown_line(', '.join(r.data) + ': ' + r.text)}" for r in remarks]
    return ["## Data that the source does not give, or gives otherwise", "\n".join(lines)]


def _table_row(name: str, agreement: TableAgreement) -> list[str]:
    return [
        name,
        str(len(agreement.cells)),
        str(agreement.agreeing),
        str(agreement.one_off),
        str(agreement.differing),
        _units(worst.units) if (worst := _worst(agreement.cells)) else "",
    ]


def _table_parts(one: PrintedTable) -> list[str]:
    table, found = one.table, one.agreement
    parts = [f"## {table.name}: {markdown_text(table.title)}"]
    links = f"[computed]({table.name}.csv), [printed]({link_target(one.link)})"
    parts.append(f"{counts([found])} ({links}).{_left_out(found)}")
    columns = _column_rows(one)
    if columns:
        labels = ["column", "cells", "agree", "one off", "differ", "largest, units", "as value"]
        parts += [_markdown(labels, columns), *_worst_cells(one)]
    parts += _reasons(one)
    return parts


def _left_out(found: TableAgreement) -> str:
    texts = []
    if found.without_row:
        texts.append(f"{counted(found.without_row, 'printed row')} without a computed one.")
    if found.without_value:
        texts.append(f"{counted(found.without_value, 'printed cell')} with an empty computed one.")
    if found.other_labels:
        others = ", ".join(map(markdown_text, found.other_labels))
        texts.append(f"Printed columns not computed here: {others}.")
    return "".join(f" {text}" for text in texts)


def _column_rows(one: PrintedTable) -> list[list[str]]:
    """One row per column that does not agree throughout, in the order of the table."""
    units = {column.label: column.unit for column in one.table.columns}
    rows = []
    for label, unit in units.items():
        cells = tuple(cell for cell in one.agreement.cells if cell.label == label)
        worst = _worst(cells)
        if worst is not None and not all(cell.agrees for cell in cells):
            value = f"{_value(worst.difference)} {unit}".strip()
            rows.append([*_table_row(markdown_text(label), TableAgreement(cells)), value])
    return rows


def _worst_cells(one: PrintedTable) -> list[str]:
    off = one.agreement.off
    shown = sorted(off, key=lambda cell: -abs(cell.units))[:WORST_CELLS]
    rows_by = one.agreement.rows_by
    first = "row" if rows_by == ROW_NUMBER else markdown_text(rows_by)
    rows = [
        [
            str(c.key),
            markdown_text(c.label),
            str(c.printed),
            _two_digits_more(c),
            _units(c.units),
        ]
        for c in shown
    ]
    parts = [_markdown([first, "column", "printed", "computed", "units"], rows)]
    rest = len(off) - len(shown)
    more = f"and {counted(rest, 'more cell')} that do not agree ([all](disagreements.csv))."
    return [*parts, more] if rest else parts


def _reasons(one: PrintedTable) -> list[str]:
    remarks = [remark for remark in one.published.remarks if not remark.data]
    lines = []
    for remark in remarks:
        where = f"{', '.join(remark.labels)}: " if remark.labels else ""
        lines.append(f"- {markdown_line(where + remark.text)}")
    if not remarks and one.agreement.differing:
        lines.append("- The reason is not known.")
    return ["\n".join(lines)] if lines else []


def _worst(cells: Iterable[PrintedCell]) -> PrintedCell | None:
    return max(cells, key=lambda cell: abs(cell.units), default=None)


def _units(value: Decimal) -> str:
    """With its sign, to hundredths; from a thousand on to whole units."""
    if _THOUSAND <= abs(value) < _MILLION:
        return f"{value:+.0f}"
    return f"{value:+.3e}" if abs(value) >= _MILLION else f"{value:+.2f}"


def _two_digits_more(cell: PrintedCell) -> str:
    """The computed number with two digits more than the printed one."""
    decimals = max(0, 2 - int(cell.printed.as_tuple().exponent))
    return f"{cell.computed:.{decimals}f}"


def _value(value: Decimal) -> str:
    """To three significant digits, and to whole numbers from a thousand on."""
    if _THOUSAND <= abs(value) < _MILLION:
        return f"{value:.0f}"
    return f"{value:.3g}" if value else "0"


def _markdown(labels: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table padded to read as one in a terminal; the first column to the left."""
    cells = [labels, *rows]
    widths = [max(3, *map(len, column)) for column in zip(*cells, strict=True)]
    rule = [":" + "-" * (widths[0] - 1), *("-" * (width - 1) + ":" for width in widths[1:])]
    lines = [
        [row[0].ljust(widths[0]), *(t.rjust(w) for t, w in zip(row[1:], widths[1:], strict=True))]
        for row in cells
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in [lines[0], rule, *lines[1:]])


OVERVIEW_PAGE = "README.md"
MARK = "<!-- written by `mechkin tables` -->"
"""First line of the page; a page without it is somebody else's."""


class OverviewRow(NamedTuple):
    """What the page says of one file; `stem` is its path from the page without its ending,
    `picture` the name of its drawing in the folder of its tables, other cells are words."""

    stem: str
    name: str
    joints: str
    mobility: str
    modes: str
    rows: str
    verdict: str
    source: str
    picture: str


def overview_page(rows: Sequence[OverviewRow]) -> str:
    """The whole page, with a newline at its end."""
    labels = ["picture", "mechanism", "joints", "mobility", "modes", "rows"]
    labels += ["against print", "source"]
    lines = [_line(labels), _line(["---"] * len(labels)), *(_line(_cells(row)) for row in rows)]
    return "\n".join([MARK, "", "# Mechanisms", "", _HEAD, "", *lines]) + "\n"


_HEAD = """\
Each file has its tables in the folder of its name, and a page `errata.md` where they are compared
with print. The picture shows its first position, seen from a corner: links in colours, joints by
symbols of their types, the ways of its points. Joints stand in the order of the file. Mobility is
the true one; Kutzbach's count and idle freedoms stand beside it where they make a difference. Modes
are the ways of assembling it that were found at the first row. Rows are those solved, of all where
they differ."""


def _cells(row: OverviewRow) -> list[str]:
    stem = link_target(row.stem)
    link = f"[{_text(row.name)}]({stem}.yaml)"
    verdict = f"[{row.verdict}]({stem}/errata.md)" if row.verdict else ""
    return [
        f"![{_text(row.name)}]({stem}/{link_target(row.picture)})",
        link,
        *map(_text, (row.joints, row.mobility, row.modes, row.rows)),
        verdict,
        _text(row.source),
    ]


def _line(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _text(text: str) -> str:
    return markdown_text(whole(text))


def against_print(
    file: Path, layouts: Sequence[TableLayout], tables: Sequence[Columns]
) -> list[PrintedTable]:
    """The tables of the mechanism file `file` that have printed values, compared with them.

    Raises:
        UsageError: printed values cannot be read, or do not belong to the table.
        InvalidFile: a file of printed values is no table of numbers.
    """
    found = []
    for layout, table in zip(layouts, tables, strict=True):
        if layout.published is None:
            continue
        place = file.parent / layout.published.file
        try:
            compared = agreement(table, read_printed(place), layout.published.rows_by)
        except ValueError as error:
            raise UsageError(f"{place}: {error}") from error
        link = posixpath.relpath(layout.published.file, file.stem)
        found.append(PrintedTable(table, layout.published, compared, link))
    return found


NAME = "disagreements.csv"
"""File beside the errata page; there is none where all cells agree."""

HEADER = "table,row,found by,at,column,printed,computed,units\n"
"""Its first line."""


def disagreements_csv(tables: Sequence[PrintedTable]) -> bytes:
    """The file, as UTF-8; empty where all cells agree.

    Columns: the table, the computed row counted from 1, what found the row in the print, the
    column, both numbers, and printed less computed in units of the last printed digit.
    """
    lines = [
        (
            *(table.table.name, cell.row, table.agreement.rows_by, float(cell.key), cell.label),
            *map(float, (cell.printed, cell.computed, cell.units)),
        )
        for table in tables
        for cell in table.agreement.off
    ]
    columns: list[TableColumn] = []
    for label, values in zip(HEADER.strip().split(","), zip(*lines, strict=True), strict=False):
        is_text = isinstance(values[0], str)
        cells = words_of(values) if is_text else np.array(values, dtype=np.float64)
        columns.append(TableColumn(label, "", cells))
    return (
        csv_bytes(Columns("disagreements", "", tuple(columns)), COMMITTED_DIGITS) if lines else b""
    )


def against_print_record(tables: Sequence[PrintedTable]) -> list[dict[str, Any]]:
    """Counts and disagreeing cells of each table, as JSON has them; numbers keep their digits."""
    return [
        {
            "table": one.table.name,
            "published": one.published.file,
            "rows_by": one.agreement.rows_by,
            "cells": len(one.agreement.cells),
            "zero": one.agreement.zero,
            "agree": one.agreement.agreeing,
            "one_off": one.agreement.one_off,
            "differ": one.agreement.differing,
            "disagreements": [
                {
                    "row": cell.row,
                    "at": str(cell.key),
                    "column": cell.label,
                    "printed": str(cell.printed),
                    "computed": float(cell.computed),
                    "units": float(cell.units),
                }
                for cell in one.agreement.off
            ],
        }
        for one in tables
    ]
