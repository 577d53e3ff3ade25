"""Comparison of fresh tables with committed ones, byte by byte, explained cell by cell.

The relative change of a cell is |fresh - committed| / max(|fresh|, |committed|); the scaled change
is the same difference over the column's largest committed magnitude, which separates rounding near
a zero crossing from a change that matters.

A file beside a mechanism for which there is no table any more is stale only if it shows that
mechkin wrote it, since stale files are removed: a table has two files of one name, CSV and
Markdown, with the same labels and as many rows, and perhaps its summary beside them; the errata
page and the list of disagreements have the words and the header that they always have.
"""

from __future__ import annotations

import math
import textwrap
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from itertools import zip_longest
from pathlib import Path
from typing import Literal

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.reading import MOST_TABLE_BYTES, read_regular
from mechkin_cli.record import dataclass
from mechkin_cli.tables.errata import HEAD, HEADER, NAME, PAGE
from mechkin_cli.tables.layout import counted
from mechkin_cli.tables.print import TableText, read_table_text

TABLE_SUFFIXES = (".csv", ".md")

REMOVED = "`mechkin tables` removes it"
LEFT = "it does not look like one of mechkin's, which leaves it: move it, or remove it yourself"

SHOWN_CELLS = 3
SHOWN_LINES = 3


def stale_files(fresh: Collection[str], committed: Mapping[str, bytes]) -> tuple[str, ...]:
    """Names in `committed` that mechkin wrote and that are not among the `fresh` ones."""
    others = {name: committed[name] for name in sorted(committed) if name not in fresh}
    own = {name for name, content in others.items() if _is_page(name, content)}
    for name in others:
        twin = f"{name.removesuffix('.csv')}.md"
        if name.endswith(".csv") and twin in others and _is_pair(others[name], others[twin]):
            own |= {name, twin}
    for name, content in others.items():
        table = f"{name.removesuffix('.summary.csv')}.csv"
        if name.endswith(".summary.csv") and (table in own or table in fresh):
            own |= {name} if content.startswith(b"summary,") else set()
    return tuple(name for name in others if name in own)


def stale_in(folder: Path, fresh: Collection[str]) -> tuple[str, ...]:
    """The same for the files that stand in a folder, without links and unreadable files."""
    found = {}
    for path in folder.iterdir() if folder.is_dir() else ():
        if path.name in fresh or path.suffix not in TABLE_SUFFIXES or path.is_symlink():
            continue
        with suppress(OSError):
            found[path.name] = read_regular(path, MOST_TABLE_BYTES)
    return stale_files(fresh, found)


def _is_page(name: str, content: bytes) -> bool:
    if name == NAME:
        return content.startswith(HEADER.encode())
    return name == PAGE and HEAD.encode() in content


def _is_pair(csv: bytes, markdown: bytes) -> bool:
    """Whether both are the same table: a title, labels with their units, and as many rows."""
    try:
        table = markdown.partition(b"\n\n| summary ")[0]
        cells, page = read_table_text("a.csv", csv), read_table_text("a.md", table)
    except ValueError:
        return False
    labels = tuple(label.partition(" [")[0] for label in page.labels)
    return (
        markdown.startswith(b"# ")
        and bool(labels)
        and labels == tuple(label.partition(" [")[0] for label in cells.labels)
        and len(page.rows) == len(cells.rows)
    )


Verdict = Literal["equal", "missing", "extra", "different"]


@dataclass(frozen=True, slots=True)
class CellChange:
    """One differing cell; `row` counts from 1 below the labels, cells are as in the files."""

    row: int
    column: str
    committed: str
    fresh: str
    relative: float | None = None
    scaled: float | None = None


@dataclass(frozen=True, slots=True)
class FileComparison:
    """Outcome for one file.

    `missing`: not committed; `extra`: committed, but no table makes it, and the remark says what to
    do. `cells` holds the first few of `cell_count` differing cells, `remarks` what is no matter of
    cells. The largest changes are over all numeric cells, None where no numeric cell differs.
    """

    name: str
    verdict: Verdict
    remarks: tuple[str, ...] = ()
    cells: tuple[CellChange, ...] = ()
    cell_count: int = 0
    largest_relative_change: float | None = None
    largest_scaled_change: float | None = None


def compare_files(
    fresh: Mapping[str, bytes], committed: Mapping[str, bytes]
) -> list[FileComparison]:
    """One comparison per file name, those of `fresh` first and in its order."""
    found = [
        _compare(name, content, committed[name])
        if name in committed
        else FileComparison(name, "missing")
        for name, content in fresh.items()
    ]
    stale = stale_files(fresh, committed)
    cures = {name: REMOVED if name in stale else LEFT for name in committed.keys() - fresh}
    return found + [FileComparison(name, "extra", (cures[name],)) for name in sorted(cures)]


def read_committed(folder: Path, also: Collection[str] = ()) -> dict[str, bytes]:
    """The table files that stand directly in `folder`, and `also` those named, by name; none where
    it does not exist.

    Raises:
        UsageError: the folder or a file in it cannot be read.
    """
    try:
        if not folder.is_dir():
            return {}
        paths = sorted(
            path for path in folder.iterdir() if path.suffix in TABLE_SUFFIXES or path.name in also
        )
        return {path.name: _content(path) for path in paths if path.is_file()}
    except OSError as error:
        place = error.filename or folder
        raise UsageError(
            f"cannot read {place}: {error.strerror}; make it readable to compare with it"
        ) from error


def _content(path: Path) -> bytes:
    content = read_regular(path, MOST_TABLE_BYTES)
    if len(content) > MOST_TABLE_BYTES:
        raise UsageError(f"{path} is too large to compare with (limit {MOST_TABLE_BYTES} bytes)")
    return content


def _compare(name: str, fresh: bytes, committed: bytes) -> FileComparison:
    if fresh == committed:
        return FileComparison(name, "equal")
    new = read_table_text(name, fresh)
    try:
        old = read_table_text(name, committed)
    except ValueError as error:
        return FileComparison(name, "different", (f"committed file: {error}",))
    changes = _cell_changes(old, new)
    remarks = [*_label_remarks(old, new), *_count_remarks(old, new), *_line_remarks(old, new)]
    if not changes and not remarks:
        remarks.append(_spacing_remark(fresh, committed))
    return FileComparison(
        name,
        "different",
        tuple(remarks),
        tuple(changes[:SHOWN_CELLS]),
        len(changes),
        max((change.relative for change in changes if change.relative is not None), default=None),
        max((change.scaled for change in changes if change.scaled is not None), default=None),
    )


def _cell_changes(old: TableText, new: TableText) -> list[CellChange]:
    """Differing cells row by row, over the columns and rows that both have."""
    pairs = _column_pairs(old, new)
    scales = {place: _largest_magnitude(old, place) for _, place, _ in pairs}
    changes = []
    for number, (old_row, new_row) in enumerate(zip(old.rows, new.rows, strict=False), start=1):
        for label, old_place, new_place in pairs:
            committed, fresh = _cell(old_row, old_place), _cell(new_row, new_place)
            if committed != fresh:
                relative, scaled = _changes(committed, fresh, scales[old_place])
                changes.append(CellChange(number, label, committed, fresh, relative, scaled))
    return changes


def _column_pairs(old: TableText, new: TableText) -> list[tuple[str, int, int]]:
    """Label, place in `old` and place in `new` of each column that both have."""
    if old.labels == new.labels:
        return [(label, place, place) for place, label in enumerate(new.labels)]
    return [
        (label, old.labels.index(label), place)
        for place, label in enumerate(new.labels)
        if label in old.labels
    ]


def _largest_magnitude(table: TableText, place: int) -> float:
    numbers = (_number(_cell(row, place)) for row in table.rows)
    return max((abs(number) for number in numbers if number is not None), default=0.0)


def _changes(committed: str, fresh: str, scale: float) -> tuple[float | None, float | None]:
    old, new = _number(committed), _number(fresh)
    if old is None or new is None:
        return None, None
    difference = abs(new - old)
    largest = max(abs(old), abs(new))
    relative = difference / largest if largest else 0.0
    return relative, difference / scale if scale else relative


def _number(cell: str) -> float | None:
    try:
        value = float(cell)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _cell(row: tuple[str, ...], place: int) -> str:
    return row[place] if place < len(row) else ""


def _label_remarks(old: TableText, new: TableText) -> list[str]:
    if old.labels == new.labels:
        return []
    added = [label for label in new.labels if label not in old.labels]
    removed = [label for label in old.labels if label not in new.labels]
    remarks = []
    if added:
        remarks.append(f"columns not committed: {', '.join(added)}")
    if removed:
        remarks.append(f"columns no longer made: {', '.join(removed)}")
    return remarks or ["the columns stand in another order or number"]


def _count_remarks(old: TableText, new: TableText) -> list[str]:
    remarks = []
    if len(old.rows) != len(new.rows):
        remarks.append(f"committed {len(old.rows)} rows, fresh {len(new.rows)}")
    for number, row in enumerate(old.rows, start=1):
        if len(row) != len(old.labels):
            remarks.append(
                f"committed row {number} has {len(row)} cells for {len(old.labels)} columns"
            )
            break
    return remarks


def _line_remarks(old: TableText, new: TableText) -> list[str]:
    pairs = zip_longest(old.lines, new.lines, fillvalue="")
    differing = [(committed, fresh) for committed, fresh in pairs if committed != fresh]
    return [
        f"text: committed {_quoted(committed)}, fresh {_quoted(fresh)}"
        for committed, fresh in differing[:SHOWN_LINES]
    ]


def _quoted(line: str) -> str:
    return f'"{line}"' if line else "nothing"


def _spacing_remark(fresh: bytes, committed: bytes) -> str:
    pairs = zip_longest(committed.split(b"\n"), fresh.split(b"\n"))
    line = next(number for number, (old, new) in enumerate(pairs, start=1) if old != new)
    return f"the cells agree; line {line} differs in spacing, quotes or line ending"


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
    return [*lines, f"  and {counted(rest, 'more cell')}"] if rest else lines


def _headline(comparison: FileComparison) -> str:
    text = f"{comparison.name}: different"
    if comparison.cell_count:
        text += f", {counted(comparison.cell_count, 'cell')}"
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
    text = f"{counted(len(comparisons), 'table file')}: {counts['equal']} equal"
    for verdict in ("different", "missing", "extra"):
        if counts[verdict]:
            text += f", {counts[verdict]} {verdict}"
    if counts["equal"] == len(comparisons):
        return text
    return f"{text}; where the change is meant, run `mechkin tables` and commit the files"


def _shortened(text: str, longest: int) -> str:
    """The text on one line of printable characters, cut in its middle where it is too long."""
    text = "".join(letter if letter.isprintable() else "?" for letter in " ".join(text.split()))
    if len(text) <= longest:
        return text
    tail = (longest - 3) // 2
    return f"{text[: longest - 3 - tail]}...{text[len(text) - tail :]}"


def _wrapped(text: str, indent: str) -> list[str]:
    return textwrap.wrap(
        text,
        WIDTH,
        initial_indent=indent,
        subsequent_indent=f"{indent}    ",
        break_on_hyphens=False,
    )
