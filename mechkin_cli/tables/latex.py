"""LaTeX of a table for a paper: booktabs, units in the heads, decimals in line, verdicts as notes.

It needs `\\usepackage{booktabs}`, and where a table is longer than a page `longtable`. Every number
of a column has as many decimals, so that columns aligned at the right have their points in line;
undeclared decimals are chosen as in `tables/columns.py`. A cell that is empty is a
dash.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Final

from mechkin_cli.diagnostics import legible
from mechkin_cli.tables.columns import INFINITE, TableColumn, TableSource, Words, column_texts
from mechkin_cli.tables.markdown import footnotes
from mechkin_cli.tables.table import Columns

if TYPE_CHECKING:
    from mechkin_cli.tables.summary import Summary


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
_NUMBER: Final = re.compile(r"(-?)([\d.]+)(?:e([+-]?\d+))?")


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


def latex_bytes(columns: Columns, source: TableSource) -> bytes:
    """The whole file as UTF-8, with a newline at its end."""
    caption = (
        rf"\caption{{{latex_text(columns.title or columns.name)}}}\label{{tab:{columns.name}}}"
    )
    heads = [_head(column.label, column.unit) for column in columns.columns]
    rows = list(zip(*map(_cells, columns.columns), strict=True))
    aligned = "".join("l" if isinstance(c.values, Words) else "r" for c in columns.columns)
    notes = footnotes(columns, source)
    below = [] if columns.summary is None else _below(columns.summary)
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


def _below(summary: Summary) -> list[str]:
    columns = [list(map(latex_text, summary.lines))]
    columns += [list(map(latex_number, summary.texts(each))) for each in summary.columns]
    heads = ["", *(_head(each.label, each.unit) for each in summary.columns)]
    aligned = "l" + "r" * len(summary.columns)
    rows = zip(*columns, strict=True)
    return [r"\par\medskip", *_tabular(aligned, heads, rows)]


def _notes(notes: Sequence[str]) -> list[str]:
    if not notes:
        return []
    lines = [rf"{latex_text(note)}\par" for note in notes]
    return [r"\begin{flushleft}\footnotesize", *lines, r"\end{flushleft}"]


def _cells(column: TableColumn) -> list[str]:
    if isinstance(column.values, Words):
        texts = [latex_text(word) for word in column.values.words]
        return [texts[code] for code in column.values.codes]
    return [
        latex_number(text)
        for text in column.texts(column_texts(column.values, column.decimals, column.rounding))
    ]


def _head(label: str, unit: str) -> str:
    return f"{latex_text(label)} {{[}}{latex_unit(unit)}]" if unit else latex_text(label)


def _row(cells: Sequence[str]) -> str:
    return " & ".join(cells) + r" \\"
