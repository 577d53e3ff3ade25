"""Markdown and LaTeX of a table: title, labels with units, decimals, its summary, footnotes.

Cells of Markdown are padded so that the text reads as a table in a terminal as well. Footnotes say
which rows are not ok or lack a cell, and why. The table `rows` has per row its inputs, assembly
mode, verdict and measured errors.

LaTeX is for a paper: booktabs, units in the heads, decimals in line, verdicts as notes. It needs
`\\usepackage{booktabs}`, and where a table is longer than a page `longtable`. Every number of a
column has as many decimals, so that columns aligned at the right have their points in line;
undeclared decimals are chosen as in `tables/columns.py`. A cell that is empty is a dash.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.diagnostics import legible
from mechkin_cli.kernel import _kernel
from mechkin_cli.tables.columns import (
    INFINITE,
    DecimalColumn,
    RunParameter,
    TableColumn,
    TableSource,
    Words,
    column_texts,
    decimal_column,
    row_words,
    run_parameter,
    words_of,
)
from mechkin_cli.tables.csv import threads_for, word_column
from mechkin_cli.tables.layout import ROW_EVENT, ROW_PROOF, markdown_text
from mechkin_cli.tables.table import Columns
from mechkin_cli.verdict import SWEEP, Status, has_rates

if TYPE_CHECKING:
    from mechkin_cli.tables.csv import WordColumn
    from mechkin_cli.tables.summary import Summary, SummaryColumn


LISTED_RANGES = 6


def footnotes(
    columns: Columns, source: TableSource, written: Callable[[str], str] = str
) -> list[str]:
    """One sentence per verdict other than ok, then one per column with unexplained empty cells.

    `written` makes of a label what is to stand in the file.
    """
    if not columns.of_rows:
        return []
    notes = [
        f"{_where(source.status == status, source)}: {status.label}: {status.sentence}"
        for status in Status
        if status is not Status.ok and bool((source.status == status).any())
    ]
    explained = ~has_rates(source.status)
    for column in columns.columns:
        if isinstance(column.values, Words):
            continue
        empty = ~np.isfinite(column.values) & ~explained
        if bool(empty.any()):
            reason = "the value is not finite or not unique there."
            notes.append(f"{_where(empty, source)}: no {written(column.label)}: {reason}")
    return notes


def _where(chosen: NDArray[np.bool_], source: TableSource) -> str:
    """Rows in words, counted from 1: `Rows 3, 27-30 (O1.theta 202 to 208 deg)`."""
    rows = np.flatnonzero(chosen)
    starts = np.flatnonzero(np.diff(rows, prepend=-2) != 1)
    ends = np.append(starts[1:], rows.size)
    swept = run_parameter(source)
    texts = [
        _range_text(int(rows[start]) + 1, int(rows[end - 1]) + 1, swept)
        for start, end in zip(starts[:LISTED_RANGES], ends[:LISTED_RANGES], strict=True)
    ]
    if starts.size > LISTED_RANGES:
        texts.append(f"and {rows.size - ends[LISTED_RANGES - 1]} more")
    return f"{'Row' if rows.size == 1 else 'Rows'} {', '.join(texts)}"


def _range_text(first: int, last: int, swept: RunParameter | None) -> str:
    rows = str(first) if first == last else f"{first}-{last}"
    if swept is None:
        return rows
    ends = " to ".join(f"{swept.values[row - 1]:.12g}" for row in dict.fromkeys((first, last)))
    return f"{rows} ({f'{swept.name} {ends} {swept.unit}'.rstrip()})"


def markdown_bytes(
    columns: Columns, source: TableSource, threads: int = 0, decimal_comma: bool = False
) -> bytes:
    """The whole file as UTF-8, with a newline at its end and no trailing spaces; threads 0: as many
    as the table is worth; with a comma in the numbers of its cells where that is asked for."""
    headers = [_header(column) for column in columns.columns]
    cells: list[DecimalColumn | WordColumn] = []
    as_texts: set[int] = set()
    for number, column in enumerate(columns.columns):
        if isinstance(column.values, Words):
            cells.append(word_column(column.values, markdown_text))
        elif column.unbounded is None and not decimal_comma:
            cells.append(decimal_column(column.values, column.decimals, column.rounding))
        else:  # the kernel takes texts, and sets them to the left
            texts = _texts(column, decimal_comma)
            as_texts.add(number)
            width = max(map(len, (headers[number], *texts)))
            headers[number] = headers[number].rjust(width)
            cells.append(word_column(words_of([text.rjust(width) for text in texts])))
    title = f"# {markdown_text(columns.title or columns.name)}\n\n"
    text: bytes = _kernel.markdown_text(headers, cells, threads_for(columns, threads))
    if as_texts:
        text = _to_the_right(text, as_texts)
    below = "" if columns.summary is None else _below(columns.summary, decimal_comma)
    notes = "".join(f"- {note}\n" for note in footnotes(columns, source, markdown_text))
    notes = below + (f"\n{notes}" if notes else "")
    return b"".join((title.encode(), text, notes.encode()))


def _texts(column: TableColumn, decimal_comma: bool) -> list[str]:
    """The cells of a column of numbers as they are written."""
    assert not isinstance(column.values, Words)
    texts = column.texts(column_texts(column.values, column.decimals, column.rounding))
    return [text.replace(".", ",") for text in texts] if decimal_comma else list(texts)


def _summary_texts(summary: Summary, column: SummaryColumn, decimal_comma: bool) -> list[str]:
    texts = summary.texts(column)
    return [text.replace(".", ",") for text in texts] if decimal_comma else list(texts)


def _below(summary: Summary, decimal_comma: bool) -> str:
    columns = [["summary", *summary.lines]]
    for each in summary.columns:
        header = _header(TableColumn(each.label, each.unit, np.empty(0)))
        columns.append([header, *_summary_texts(summary, each, decimal_comma)])
    widths = [max(map(len, cells)) for cells in columns]
    pads = [str.ljust, *(str.rjust for _ in summary.columns)]
    head, *lines = (
        f"| {' | '.join(pad(*cell) for pad, *cell in zip(pads, row, widths, strict=True))} |\n"
        for row in zip(*columns, strict=True)
    )
    rule = [f":{'-' * (widths[0] - 1)}", *(f"{'-' * (width - 1)}:" for width in widths[1:])]
    said = "".join(f"- {note}\n" for note in summary.written_notes(markdown_text))
    return "".join(("\n", head, f"| {' | '.join(rule)} |\n", *lines, f"\n{said}" if said else ""))


def _to_the_right(table: bytes, as_texts: Iterable[int]) -> bytes:
    """The table with columns of numbers, counted from 0, that the kernel took as texts set to the
    right."""
    head, rule, rest = table.split(b"\n", 2)
    marks = rule.split(b"|")
    for number in as_texts:
        marks[number + 1] = b" " + marks[number + 1].strip()[1:] + b": "
    return b"\n".join((head, b"|".join(marks), rest))


def _header(column: TableColumn) -> str:
    label = markdown_text(column.label)
    return f"{label} [{column.unit}]" if column.unit else label


def rows_table(source: TableSource, run: str = SWEEP) -> Columns:
    """Columns row, the inputs, mode, status, residual, condition, power_error; of a sweep whose
    proofs were asked for additionally proof. That of another run is called `NAME.rows` and has
    event and energy_error, or of equilibria imbalance.

    Rows count from 1; inputs are in file units, errors and condition without dimension.
    """
    inputs = [
        TableColumn(name, source.units.label(source.quantity(name).dimension), values)
        for name, values in source.inputs.items()
    ]
    columns = [
        TableColumn("row", "", np.arange(1, source.rows + 1, dtype=np.float64), 0),
        *inputs,
        TableColumn("mode", "", Words(np.zeros(source.rows, dtype=np.int32), (source.mode,))),
        TableColumn("status", "", row_words("row.status", source)),
        TableColumn("residual", "", source.residual),
        TableColumn("condition", "", source.condition),
        TableColumn("power_error", "", source.power_error),
    ]
    if run == SWEEP:
        if source.is_certified:
            columns.insert(-3, TableColumn("proof", "", row_words(ROW_PROOF, source)))
        return Columns("rows", "Rows and their verdicts", tuple(columns))
    columns.insert(-3, TableColumn("event", "", row_words(ROW_EVENT, source)))
    if source.measure:
        error = np.asarray(source.quantity(f"row.{source.measure}").value, dtype=np.float64)
        columns.append(TableColumn(source.measure, "", error))
    return Columns(f"{run}.rows", f"Rows of {run} and their verdicts", tuple(columns))


PAGE_ROWS: Final = 45
"""Rows that fit on a page of ten points; longer tables are broken over pages."""

EMPTY: Final = "--"

_WRITTEN: Final = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
    # behind the end of a row they would be its options
    "[": "{[}",
    "*": "{*}",
    **{mark: f"\\{mark}" for mark in "$&#_%"},
}
_SPECIAL: Final = re.compile("|".join(map(re.escape, _WRITTEN)))
_POWER: Final = re.compile(r"\^\(?(-?[\d/.]+)\)?")
_NUMBER: Final = re.compile(r"(-?)([\d.,]+)(?:e([+-]?\d+))?")


def latex_text(text: str) -> str:
    r"""The text in one line, with nothing that LaTeX would do something with.

    Example:
        >>> latex_text("50% of {x_1} \\input")
        '50\\% of \\{x\\_1\\} \\textbackslash{}input'
    """
    return _SPECIAL.sub(lambda found: _WRITTEN[found[0]], legible(" ".join(text.split())))


def latex_unit(unit: str) -> str:
    r"""A unit as it is printed: factors apart, powers raised, degrees as a circle.

    Example:
        >>> latex_unit("kg*mm^2"), latex_unit("deg/s")
        ('kg\\,mm$^{2}$', '$^{\\circ}$/s')
    """
    raised = _POWER.sub(r"$^{\1}$", unit).replace("*", r"\,")
    return re.sub(r"\bdeg\b", r"$^{\\circ}$", raised)


def latex_number(text: str) -> str:
    r"""A number with a minus sign that is one, and its exponent as a power of ten.

    Example:
        >>> latex_number("-1.50"), latex_number("2.5e-07"), latex_number("")
        ('$-$1.50', '2.5$\\times10^{-7}$', '--')
    """
    if text.endswith(INFINITE):
        return f"${text.removesuffix(INFINITE)}\\infty$"
    found = _NUMBER.fullmatch(text)
    if found is None:
        return EMPTY
    sign, digits, exponent = found.groups()
    power = "" if exponent is None else rf"$\times10^{{{int(exponent)}}}$"
    return f"{'$-$' if sign else ''}{digits}{power}"


def latex_bytes(columns: Columns, source: TableSource, decimal_comma: bool = False) -> bytes:
    """The whole file as UTF-8, with a newline at its end; with a comma in the numbers of its cells
    where that is asked for."""
    caption = (
        rf"\caption{{{latex_text(columns.title or columns.name)}}}\label{{tab:{columns.name}}}"
    )
    heads = [_head(column.label, column.unit) for column in columns.columns]
    rows = list(zip(*(_cells(column, decimal_comma) for column in columns.columns), strict=True))
    aligned = "".join("l" if isinstance(c.values, Words) else "r" for c in columns.columns)
    notes = footnotes(columns, source)
    below = [] if columns.summary is None else _latex_below(columns.summary, decimal_comma)
    if columns.summary is not None:
        notes = [*columns.summary.written_notes(), *notes]
    if len(rows) > PAGE_ROWS:
        lines = [r"% \usepackage{booktabs,longtable}", *_longtable(aligned, heads, rows, caption)]
    else:
        lines = [r"% \usepackage{booktabs}", r"\begin{table}", r"\centering", caption]
        lines += _tabular(aligned, heads, rows)
    lines += [*below, *_notes(notes)]
    if len(rows) <= PAGE_ROWS:
        lines.append(r"\end{table}")
    return ("\n".join(lines) + "\n").encode()


def _longtable(
    aligned: str, heads: Sequence[str], rows: Iterable[Sequence[str]], caption: str
) -> list[str]:
    head = [r"\toprule", _row(heads), r"\midrule"]
    return [
        rf"\begin{{longtable}}{{{aligned}}}",
        rf"{caption}\\",
        *head,
        r"\endfirsthead",
        *head,
        r"\endhead",
        r"\bottomrule",
        r"\endfoot",
        *map(_row, rows),
        r"\end{longtable}",
    ]


def _tabular(aligned: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [
        rf"\begin{{tabular}}{{{aligned}}}",
        r"\toprule",
        _row(heads),
        r"\midrule",
        *map(_row, rows),
        r"\bottomrule",
        r"\end{tabular}",
    ]


def _latex_below(summary: Summary, decimal_comma: bool) -> list[str]:
    columns = [list(map(latex_text, summary.lines))]
    texts = (_summary_texts(summary, each, decimal_comma) for each in summary.columns)
    columns += [list(map(latex_number, each)) for each in texts]
    heads = ["", *(_head(each.label, each.unit) for each in summary.columns)]
    aligned = "l" + "r" * len(summary.columns)
    rows = zip(*columns, strict=True)
    return [r"\par\medskip", *_tabular(aligned, heads, rows)]


def _notes(notes: Sequence[str]) -> list[str]:
    if not notes:
        return []
    lines = [rf"{latex_text(note)}\par" for note in notes]
    return [r"\begin{flushleft}\footnotesize", *lines, r"\end{flushleft}"]


def _cells(column: TableColumn, decimal_comma: bool) -> list[str]:
    if isinstance(column.values, Words):
        texts = [latex_text(word) for word in column.values.words]
        return [texts[code] for code in column.values.codes]
    return list(map(latex_number, _texts(column, decimal_comma)))


def _head(label: str, unit: str) -> str:
    return f"{latex_text(label)} {{[}}{latex_unit(unit)}]" if unit else latex_text(label)


def _row(cells: Sequence[str]) -> str:
    return " & ".join(cells) + r" \\"
