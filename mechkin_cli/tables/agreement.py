"""Agreement of a computed table with the printed one, cell by cell, in exact decimals.

A printed number states a value to within half a unit of its last digit. A cell agrees where the
computed number lies within that half unit, both ends included: the printed number is then the
computed one, rounded; at a tie both neighbours are. Beyond that and up to one and a half units it
is one off in the last digit. Computed numbers are taken with the twelve digits of committed
tables, which the last bits of a double do not reach, so that a tie is a tie.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Context, Decimal

from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.csv_writer import COMMITTED_DIGITS
from mechkin_cli.tables.layout import ROW_NUMBER
from mechkin_cli.tables.printed import Cell, PrintedValues

HALF = Decimal("0.5")
ONE_OFF = Decimal("1.5")
_TWELVE = Context(prec=COMMITTED_DIGITS)
_WIDE = Context(prec=700)
"""Holds any difference of a double and a printed number exactly."""


@dataclass(frozen=True, slots=True)
class PrintedCell:
    """One printed number beside the computed one.

    `key` is what found the row, the printed number or its count; `row` counts computed rows from 1.
    """

    row: int
    key: Decimal
    label: str
    printed: Decimal
    computed: Decimal

    @property
    def unit(self) -> Decimal:
        """One unit of the last printed digit."""
        return Decimal(1).scaleb(int(self.printed.as_tuple().exponent))

    @property
    def difference(self) -> Decimal:
        """Printed less computed, in the unit of the column."""
        return _WIDE.subtract(self.printed, self.computed)

    @property
    def units(self) -> Decimal:
        """Printed less computed, in units of the last printed digit."""
        return _WIDE.divide(self.difference, self.unit)

    @property
    def agrees(self) -> bool:
        """Whether the printed number is the computed one, rounded to the printed digits."""
        return abs(self.units) <= HALF

    @property
    def one_off(self) -> bool:
        """Whether the printed number is a neighbour of the rounded one."""
        return HALF < abs(self.units) <= ONE_OFF


@dataclass(frozen=True, slots=True)
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

    @property
    def off(self) -> tuple[PrintedCell, ...]:
        """The cells that do not agree."""
        return tuple(cell for cell in self.cells if not cell.agrees)

    @property
    def agreeing(self) -> int:
        """Number of cells that agree."""
        return sum(cell.agrees for cell in self.cells)

    @property
    def one_off(self) -> int:
        """Number of cells that are one off in the last digit."""
        return sum(cell.one_off for cell in self.cells)

    @property
    def differing(self) -> int:
        """Number of cells that differ by more."""
        return len(self.cells) - self.agreeing - self.one_off


def agreement(table: Columns, printed: PrintedValues, rows_by: str | None = None) -> TableAgreement:
    """The printed cells beside the computed ones.

    Rows are found by the values of the column `rows_by`, None for the first printed one, or one
    after the other where it is `ROW_NUMBER`.

    Raises:
        ValueError: the table or the print has no column of numbers with that label.
    """
    columns = {c.label: c for c in table.columns if not isinstance(c.values, Words)}
    key = printed.labels[0] if rows_by is None else rows_by
    labels = [label for label in printed.labels if label != key]
    computed = {label: _decimals(columns[label]) for label in labels if label in columns}
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
                cells.append(PrintedCell(row + 1, found, label, text, value))
    others = tuple(label for label in labels if label not in computed)
    return TableAgreement(tuple(cells), without_row, without_value, others, key)


def _paired(
    table: Columns, columns: Mapping[str, Column], printed: PrintedValues, key: str
) -> Iterator[tuple[Cell, int | None, Mapping[str, Cell]]]:
    """Of each printed row what finds it, the computed row, and its cells by label."""
    rows = [dict(zip(printed.labels, row, strict=True)) for row in printed.rows]
    if key == ROW_NUMBER:
        count = table.columns[0].rows
        for number, row in enumerate(rows):
            yield Decimal(number + 1), number if number < count else None, row
        return
    for labels, who in ((columns, f"table {table.name}"), (printed.labels, "the print")):
        if key not in labels:
            raise ValueError(
                f"the column {key!r} finds the rows, and {who} has no "
                f"such column of numbers; its labels are {', '.join(labels)}"
            )
    places = _Rows(_decimals(columns[key]))
    for row in rows:
        yield row[key], places.take(row[key]), row


def _decimals(column: Column) -> list[Decimal | None]:
    """Each value with twelve digits; None where it is no number."""
    assert not isinstance(column.values, Words)
    found = (Decimal(value) for value in column.values.tolist())
    return [_TWELVE.plus(value) if value.is_finite() else None for value in found]


class _Rows:
    """Row numbers by a printed value of one column; each row is found once."""

    def __init__(self, values: list[Decimal | None]) -> None:
        self._values = values
        self._by_exponent: dict[int, Mapping[Decimal, list[int]]] = {}

    def take(self, key: Decimal | None) -> int | None:
        if key is None:
            return None
        exponent = int(key.as_tuple().exponent)
        if exponent not in self._by_exponent:
            self._by_exponent[exponent] = self._rounded(Decimal(1).scaleb(exponent))
        rows = self._by_exponent[exponent].get(key)
        return rows.pop(0) if rows else None

    def _rounded(self, unit: Decimal) -> Mapping[Decimal, list[int]]:
        found: dict[Decimal, list[int]] = {}
        for row, value in enumerate(self._values):
            if value is not None:
                rounded = _WIDE.quantize(value, unit)
                found.setdefault(rounded, []).append(row)
        return found
