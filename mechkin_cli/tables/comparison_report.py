"""What a comparison of tables says to a person: lines of at most 80 columns."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence

from mechkin_cli.tables.compare import CellChange, FileComparison

WIDTH = 80
_LONGEST_CELL = 24
_LONGEST_REMARK = 300


def report(comparisons: Sequence[FileComparison]) -> str:
    """Every file that differs with its first differing cells, then a count; ends with a newline."""
    lines: list[str] = []
    for comparison in comparisons:
        if comparison.verdict != "equal":
            lines += _file_lines(comparison)
    lines += _wrapped(_summary(comparisons), "")
    return "\n".join(lines) + "\n"


def _file_lines(comparison: FileComparison) -> list[str]:
    if comparison.verdict == "missing":
        return _wrapped(f"{comparison.name}: missing, not committed yet", "")
    if comparison.verdict == "extra":
        text = f"{comparison.name}: extra, no table makes this file any more"
        return _wrapped("; ".join((text, *comparison.remarks)), "")
    lines = _wrapped(_headline(comparison), "")
    for remark in comparison.remarks:
        lines += _wrapped(_shortened(remark, _LONGEST_REMARK), "  ")
    for cell in comparison.cells:
        lines += _wrapped(_cell_line(cell), "  ")
    rest = comparison.cell_count - len(comparison.cells)
    return [*lines, f"  and {_counted(rest, 'more cell')}"] if rest else lines


def _headline(comparison: FileComparison) -> str:
    text = f"{comparison.name}: different"
    if comparison.cell_count:
        text += f", {_counted(comparison.cell_count, 'cell')}"
    if comparison.largest_relative_change is not None:
        text += f"; largest relative change {comparison.largest_relative_change:.2g}"
    if comparison.largest_scaled_change is not None:
        text += f" ({comparison.largest_scaled_change:.2g} of its column's largest value)"
    return text


def _cell_line(cell: CellChange) -> str:
    committed, fresh = (_shortened(text, _LONGEST_CELL) for text in (cell.committed, cell.fresh))
    label = _shortened(cell.column, _LONGEST_CELL)
    return f"row {cell.row}, {label}: committed {committed or 'empty'}, fresh {fresh or 'empty'}"


def _summary(comparisons: Sequence[FileComparison]) -> str:
    counts = Counter(comparison.verdict for comparison in comparisons)
    text = f"{_counted(len(comparisons), 'table file')}: {counts['equal']} equal"
    for verdict in ("different", "missing", "extra"):
        if counts[verdict]:
            text += f", {counts[verdict]} {verdict}"
    if counts["equal"] == len(comparisons):
        return text
    return f"{text}; where the change is meant, run `mechkin tables` and commit the files"


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _shortened(text: str, longest: int) -> str:
    """The text on one line of printable characters, cut in its middle where it is too long."""
    text = "".join(letter if letter.isprintable() else "?" for letter in " ".join(text.split()))
    if len(text) <= longest:
        return text
    kept = longest - 3
    return f"{text[: kept - kept // 2]}...{text[len(text) - kept // 2 :]}"


def _wrapped(text: str, indent: str) -> list[str]:
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=f"{indent}    ",
        break_on_hyphens=False,
    )
