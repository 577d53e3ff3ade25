"""Agreement of a computed table with the printed one, cell by cell, in exact decimals.

A printed number states a value to within half a unit of its last digit. A cell agrees where the
computed number lies within that half unit, both ends included: the printed number is then the
computed one, rounded; at a tie both neighbours are. Beyond that and up to one and a half units it
is one off in the last digit. Computed numbers are taken with the twelve digits of committed
tables, which the last bits of a double do not reach, so that a tie is a tie; what is printed with
more is compared with twelve. A column that is zero throughout, in print and computed, says nothing
of the numbers: its cells are counted apart.

In reading order: table files as text (cells stay the text of the file, so that a comparison sees
what a reader sees), printed values, the comparison. Printed values are a CSV file with the digits
as the source prints them: labels of the table first, of which the first finds rows again, the one
nearest to the printed value among those that it is the rounded value of; a cell's text carries its
precision (`1.30` is printed to 0.01), an empty one is a value that the source does not have or that
cannot be read.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Context, Decimal
from functools import cached_property
from itertools import groupby
from pathlib import Path

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Place, UsageError
from mechkin_cli.reading import read_regular
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.tables.columns import TableColumn, Words
from mechkin_cli.tables.csv import COMMITTED_DIGITS
from mechkin_cli.tables.layout import ROW_NUMBER
from mechkin_cli.tables.table import Columns

_UNESCAPED_BAR = re.compile(r"(?<!\\)\|")


class TableText(NamedTuple):
    """Labels and rows of cells; `lines` are the lines outside the table that are not blank."""

    labels: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    lines: tuple[str, ...] = ()


def read_table_text(name: str, content: bytes) -> TableText:
    """The table in a `.csv` or `.md` file; any other file, and a page of several tables, is lines
    without a table.

    Raises:
        ValueError: the content is not UTF-8 text, or no CSV.
    """
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ValueError(f"byte {error.start} is not UTF-8 text") from error
    if name.endswith(".csv"):
        return _read_csv(text)
    if name.endswith(".md"):
        return _read_markdown(text)
    return TableText(lines=_filled(text.splitlines()))


def _read_csv(text: str) -> TableText:
    try:
        records = [tuple(record) for record in csv.reader(io.StringIO(text, newline=""))]
    except csv.Error as error:
        raise ValueError(f"not readable as CSV: {error}") from error
    if not records:
        return TableText()
    # a blank line is a row whose only cell is empty
    return TableText(records[0], tuple(record or ("",) for record in records[1:]))


def _read_markdown(text: str) -> TableText:
    lines = text.splitlines()
    if [is_table for is_table, _ in groupby(lines, _is_of_table)].count(True) != 1:
        return TableText(lines=_filled(lines))
    table = [
        tuple(cell.strip() for cell in _UNESCAPED_BAR.split(line.strip())[1:-1])
        for line in lines
        if _is_of_table(line)
    ]
    others = _filled(line for line in lines if not _is_of_table(line))
    return TableText(table[0], tuple(table[2:]), others)


def _is_of_table(line: str) -> bool:
    return line.lstrip().startswith("|")


def _filled(lines: Iterable[str]) -> tuple[str, ...]:
    return tuple(line.rstrip() for line in lines if line.strip())


MOST_BYTES = 1 << 20
"""Size of a file of printed values; the longest printed tables have some ten kilobytes."""

_NUMBER = re.compile(
    r"[+-]?(?:[0-9]{1,30}(?:\.[0-9]{0,30})?|\.[0-9]{1,30})(?:[eE][+-]?[0-9]{1,2})?"
)

Cell = Decimal | None


PrintedValues = tuple[tuple[str, ...], tuple[tuple[Cell, ...], ...]]
"""Labels and rows of numbers, as printed; None where the print has no value."""


def read_printed(path: Path) -> PrintedValues:
    """The printed values in a CSV file.

    Raises:
        UsageError: the file cannot be read.
        InvalidFile: it is no table of numbers; with the place of each error.
    """
    try:
        content = read_regular(path, MOST_BYTES)
    except OSError as error:
        raise UsageError(
            f"cannot read the printed values {path}: {error.strerror}; "
            "put the file there or correct `published:`"
        ) from error
    if len(content) > MOST_BYTES:
        raise _invalid(path, 1, 1, f"the file is larger than {MOST_BYTES} bytes", "shorten it")
    try:
        labels, rows, _ = read_table_text("printed.csv", content)
    except ValueError as error:
        raise _invalid(path, 1, 1, str(error), "write CSV in UTF-8") from error
    labels = tuple(label.removeprefix("\ufeff").strip() for label in labels)
    if not any(labels) or len(set(labels)) < len(labels):
        raise _invalid(path, 1, 1, "the first line must hold labels, each one once", "add them")
    filled = [(line, row) for line, row in enumerate(rows, start=2) if any(map(str.strip, row))]
    return labels, tuple(_numbers(path, line, labels, row) for line, row in filled)


def _numbers(
    path: Path, line: int, labels: tuple[str, ...], row: tuple[str, ...]
) -> tuple[Cell, ...]:
    if len(row) != len(labels):
        text = f"the row has {len(row)} cells for {len(labels)} labels"
        raise _invalid(path, line, 1, text, "leave a cell empty where the print has no value")
    return tuple(_number(path, line, row, place, labels[place]) for place in range(len(row)))


def _number(path: Path, line: int, row: tuple[str, ...], place: int, label: str) -> Cell:
    text = row[place].strip()
    if not text:
        return None
    if not _NUMBER.fullmatch(text):
        column = 1 + sum(len(cell) + 1 for cell in row[:place])
        message = f"{label}: {text[:40]!r} is no number"
        raise _invalid(path, line, column, message, "write the digits as printed, or nothing")
    return Decimal(text)


def _invalid(path: Path, line: int, column: int, message: str, hint: str) -> InvalidFile:
    place = Place(str(path), line, column)
    return InvalidFile([Diagnostic("printed-values", "error", message, place, hint=hint)])


HALF = Decimal("0.5")
ONE_OFF = Decimal("1.5")
_TWELVE = Context(prec=COMMITTED_DIGITS)
_WIDE = Context(prec=700)
"""Holds any difference of a double and a printed number exactly."""


@dataclass(frozen=True)
class PrintedCell:
    """One printed number beside the computed one.

    `key` is what found the row, the printed number or its count; `row` counts computed rows from 1.
    `zero` tells that the whole column is zero, printed and computed.
    """

    row: int
    key: Decimal
    label: str
    printed: Decimal
    computed: Decimal
    zero: bool = False

    @property
    def unit(self) -> Decimal:
        """One unit of the last printed digit, of the twelfth where there are more."""
        exponent = int(self.printed.as_tuple().exponent)
        return Decimal(1).scaleb(max(exponent, self.printed.adjusted() - COMMITTED_DIGITS + 1))

    @property
    def difference(self) -> Decimal:
        """Printed less computed, in the unit of the column."""
        return _WIDE.subtract(self.printed, self.computed)

    @cached_property
    def units(self) -> Decimal:
        """Printed less computed, in units of the last printed digit."""
        return _WIDE.divide(self.difference, self.unit)

    @cached_property
    def agrees(self) -> bool:
        """Whether the printed number is the computed one, rounded to the printed digits."""
        return abs(self.units) <= HALF

    @property
    def one_off(self) -> bool:
        """Whether the printed number is a neighbour of the rounded one."""
        return HALF < abs(self.units) <= ONE_OFF


@dataclass(frozen=True)
class TableAgreement:
    """All printed cells of a table but those that find its rows, `rows_by` a label or the count.

    `without_row` counts printed rows that the table does not have, `without_value` printed cells
    whose computed cell is empty; `other_labels` are printed columns that the table does not have.
    """

    cells: tuple[PrintedCell, ...]
    without_row: int = 0
    without_value: int = 0
    other_labels: tuple[str, ...] = ()
    rows_by: str = ""

    @cached_property
    def off(self) -> tuple[PrintedCell, ...]:
        """The cells that do not agree."""
        return tuple(cell for cell in self.cells if not cell.agrees)

    @cached_property
    def agreeing(self) -> int:
        """Number of cells that agree, without those of columns of zeros."""
        return sum(cell.agrees and not cell.zero for cell in self.cells)

    @cached_property
    def zero(self) -> int:
        """Number of cells of columns that are zero throughout."""
        return sum(cell.zero for cell in self.cells)

    @cached_property
    def one_off(self) -> int:
        """Number of cells that are one off in the last digit."""
        return sum(cell.one_off for cell in self.cells)

    @cached_property
    def differing(self) -> int:
        """Number of cells that differ by more."""
        return len(self.cells) - self.agreeing - self.one_off - self.zero


def agreement(table: Columns, printed: PrintedValues, rows_by: str | None = None) -> TableAgreement:
    """The printed cells beside the computed ones.

    Rows are found by the values of the column `rows_by`, None for the first printed one, or one
    after the other where it is `ROW_NUMBER`.

    Raises:
        ValueError: the table or the print has no column of numbers with that label.
    """
    columns = {c.label: c for c in table.columns if not isinstance(c.values, Words)}
    key = printed[0][0] if rows_by is None else rows_by
    labels = [label for label in printed[0] if label != key]
    computed = {label: _decimals(columns[label]) for label in labels if label in columns}
    zeros = _zero_columns(printed, computed)
    cells, without_row, without_value = [], 0, 0
    for found, row, texts in _paired(table, columns, printed, key):
        if row is None or found is None:
            without_row += 1
            continue
        for label in computed:
            text, value = texts[label], computed[label][row]
            if text is not None and value is None:
                without_value += 1
            elif text is not None and value is not None:
                if _is_longer(text):
                    value = _shortest(columns[label], row)
                cells.append(PrintedCell(row + 1, found, label, text, value, label in zeros))
    others = tuple(label for label in labels if label not in computed)
    return TableAgreement(tuple(cells), without_row, without_value, others, key)


def _zero_columns(
    printed: PrintedValues, computed: Mapping[str, Sequence[Decimal | None]]
) -> frozenset[str]:
    """Labels of columns that are printed as zeros and computed as zeros, to twelve digits of the
    table's largest number."""
    numbers = [value for values in computed.values() for value in values if value is not None]
    largest = max(map(abs, numbers), default=Decimal(0))
    rounding = largest.scaleb(-COMMITTED_DIGITS)
    found = []
    for label, texts in zip(printed[0], zip(*printed[1], strict=True), strict=False):
        if label in computed and not any(texts):
            small = (abs(value) <= rounding for value in computed[label] if value is not None)
            found += [label] if all(small) else []
    return frozenset(found)


def _paired(
    table: Columns, columns: Mapping[str, TableColumn], printed: PrintedValues, key: str
) -> Iterator[tuple[Cell, int | None, Mapping[str, Cell]]]:
    """Of each printed row what finds it, the computed row, and its cells by label."""
    rows = [dict(zip(printed[0], row, strict=True)) for row in printed[1]]
    if key == ROW_NUMBER:
        count = table.columns[0].rows
        for number, row in enumerate(rows):
            yield Decimal(number + 1), number if number < count else None, row
        return
    for labels, who in ((columns, f"table {table.name}"), (printed[0], "the print")):
        if key not in labels:
            raise ValueError(
                f"the column {key!r} finds the rows, and {who} has no "
                f"such column of numbers; its labels are {', '.join(labels)}"
            )
    exact = _exact(columns[key])
    values = _decimals(columns[key])
    asked = Counter(row[key] for row in rows)
    by_exponent: dict[int, dict[Decimal, list[int]]] = {}  # rows by their rounded value
    nearest: dict[Decimal, list[int]] = {}
    for row in rows:
        value = row[key]
        if value is None:
            yield None, None, row
            continue
        if value not in nearest:
            # one that is printed again and again stands in several rows, in their order
            near = _near(value, exact, values, by_exponent)
            nearest[value] = sorted(near[: asked[value]])
        places = nearest[value]
        yield value, places.pop(0) if places else None, row


def _near(
    printed: Decimal,
    exact: Sequence[Decimal],
    values: Sequence[Decimal | None],
    by_exponent: dict[int, dict[Decimal, list[int]]],
) -> list[int]:
    """The rows whose value rounds to a printed one, the nearest first."""
    rounded, apart = printed, [0]
    if _is_longer(printed):
        # the last digit may have been rounded twice
        rounded, apart = _TWELVE.plus(printed), [-1, 0, 1]
    exponent = int(rounded.as_tuple().exponent)
    if exponent not in by_exponent:
        by_exponent[exponent] = _rows_by_rounded(values, exponent)
    unit = Decimal(1).scaleb(exponent)
    keys = (_WIDE.add(rounded, units * unit) for units in apart)
    rows = [row for key in keys for row in by_exponent[exponent].get(key, ())]
    off = {row: abs(_WIDE.subtract(exact[row], printed)) for row in rows}
    return sorted((row for row in rows if off[row] <= unit), key=off.__getitem__)


def _rows_by_rounded(values: Sequence[Decimal | None], exponent: int) -> dict[Decimal, list[int]]:
    unit, rows = Decimal(1).scaleb(exponent), defaultdict(list)
    for row, value in enumerate(values):
        if value is not None:
            rows[_WIDE.quantize(value, unit)].append(row)
    return rows


def _exact(column: TableColumn) -> list[Decimal]:
    assert not isinstance(column.values, Words)
    return [Decimal(value) for value in column.values.tolist()]


def _shortest(column: TableColumn, row: int) -> Decimal:
    """A computed number with the shortest digits that are its own."""
    assert not isinstance(column.values, Words)
    return Decimal(repr(float(column.values[row])))


def _is_longer(printed: Decimal) -> bool:
    """Whether a number is printed with more digits than computed ones are compared with."""
    return len(printed.as_tuple().digits) > COMMITTED_DIGITS


def _decimals(column: TableColumn) -> list[Decimal | None]:
    """Each value with twelve digits; None where it is no number."""
    return [_TWELVE.plus(value) if value.is_finite() else None for value in _exact(column)]
