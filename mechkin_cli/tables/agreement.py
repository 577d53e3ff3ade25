"""Agreement of a computed table with the printed one, cell by cell, in exact decimals.

A printed number states a value to within half a unit of its last digit. A cell agrees where the
computed number lies within that half unit, both ends included: the printed number is then the
computed one, rounded; at a tie both neighbours are. Beyond that and up to one and a half units it
is one off in the last digit. Computed numbers are taken with the twelve digits of committed
tables, which the last bits of a double do not reach, so that a tie is a tie.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Context, Decimal

from mechkin_cli.tables.columns import Column, Columns, Words
from mechkin_cli.tables.csv_writer import COMMITTED_DIGITS
from mechkin_cli.tables.printed import PrintedValues

HALF = Decimal("0.5")
ONE_OFF = Decimal("1.5")
_TWELVE = Context(prec=COMMITTED_DIGITS)
_WIDE = Context(prec=700)
"""Holds any difference of a double and a printed number exactly."""


@dataclass(frozen=True, slots=True)
class PrintedCell:
    """One printed number beside the computed one; `key` is the row's printed first cell."""

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
    """All printed cells of a table but those of its first column.

    `without_row` counts printed rows that the table does not have, `without_value` printed cells
    whose computed cell is empty; `other_labels` are printed columns that the table does not have.
    """

    cells: tuple[PrintedCell, ...]
    without_row: int = 0
    without_value: int = 0
    other_labels: tuple[str, ...] = ()

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


def agreement(table: Columns, printed: PrintedValues) -> TableAgreement:
    """The printed cells beside the computed ones; rows are found by their first printed cell.

    Raises:
        ValueError: the table has no column of numbers with the first printed label.
    """
    columns = {c.label: c for c in table.columns if not isinstance(c.values, Words)}
    first, *labels = printed.labels
    if first not in columns:
        raise ValueError(
            f"the first printed column {first!r} finds the rows, and table {table.name} has no "
            f"such column of numbers; its labels are {', '.join(columns)}"
        )
    computed = {label: _decimals(columns[label]) for label in labels if label in columns}
    rows = _Rows(_decimals(columns[first]))
    cells, without_row, without_value = [], 0, 0
    for key, *texts in printed.rows:
        row = rows.take(key)
        if key is None or row is None:
            without_row += 1
            continue
        for label, text in zip(labels, texts, strict=True):
            if text is None or label not in computed:
                continue
            value = computed[label][row]
            if value is None:
                without_value += 1
            else:
                cells.append(PrintedCell(key, label, text, value))
    others = tuple(label for label in labels if label not in computed)
    return TableAgreement(tuple(cells), without_row, without_value, others)


def _decimals(column: Column) -> list[Decimal | None]:
    """Each value with twelve digits; None where it is no number."""
    assert not isinstance(column.values, Words)
    found = (Decimal(value) for value in column.values.tolist())
    return [_TWELVE.plus(value) if value.is_finite() else None for value in found]


class _Rows:
    """Row numbers by a printed value of the first column; each row is found once."""

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
