"""The true errors of an analysis: how far its cells are from exact numbers."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.arguments import a_text, texts
from mechkin_cli.building import used_quantities
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.errors.cells import doubts, true_values
from mechkin_cli.errors.repeat import repetition
from mechkin_cli.errors.rows import BALANCE, DENSE, SUMMARY, WORDS, NotRepeated, Repeated, reason_of
from mechkin_cli.mechanism import read_for
from mechkin_cli.show import Listed, Listing
from mechkin_cli.tables import (
    ALL_COLUMNS,
    LOST,
    ColumnErrors,
    Words,
    column_errors,
    least_digits,
    not_repeated,
    row_texts,
    worst_column,
)
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.expressions import Expression
    from mechkin_cli.mechanism import Wanted
    from mechkin_cli.sweep import Readable
    from mechkin_cli.tables import ColumnLayout, Columns, TableColumn
    from mechkin_cli.tape import DoubleDoubles


MOST_LISTED = 10
"""Columns that a message lists."""


class Errors(Listed):
    """True errors of the cells of an analysis, in the file's units.

    `errors["theta4"]` is |cell - true value| over the rows, of a column by its label, of a column
    of a table by `errors["table_03", "theta4"]`, or of any expression of quantities; nan where
    there is no number, or where it is not repeated (`why`).

    Attributes:
        columns: the errors of every column of every table, in order.
    """

    def __init__(self, analysis: Readable) -> None:
        self._analysis = analysis
        self.columns: tuple[ColumnErrors, ...] = tuple(
            found
            for layout, table in zip(analysis.layouts, analysis.tables, strict=True)
            for found in self._of_table(layout.columns, table)
        ) + tuple(
            not_repeated(table.name, ALL_COLUMNS, "", 0, why)
            for tables, why in ((analysis.coefficients, DENSE), (analysis.balance_tables, BALANCE))
            for table in tables
        )
        self.columns += tuple(
            not_repeated(f"{table.name}.summary", ALL_COLUMNS, "", 0, SUMMARY)
            for table in analysis.tables
            if table.summary is not None
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied as the analysis, whose rows are repeated once more."""
        return Errors, (self._analysis,)

    @property
    def listing(self) -> Listing:
        """The worst cell of each column, or why there is none."""
        digits = "nothing was repeated" if self.digits is None else f"right to {self.digits} digits"
        rows = []
        for column in self.columns:
            row = column.worst
            told = [column.why, "", "", ""]
            if row >= 0:
                error, relative = column.error[row], column.relative[row]
                told = ["", f"{error:.1e} {column.unit}", f"{relative:.1e}", str(row + 1)]
            rows.append((column.table, column.label, told[1], told[2], told[3], told[0]))
        labels = ("table", "column", "worst error", "relative", "row", "why not")
        return Listing(f"True errors of {self._analysis.model.name}: {digits}", labels, tuple(rows))

    @cached_property
    def repeated(self) -> Repeated:
        """The rows in double-double."""
        return self._read(repetition(self._analysis.result))

    @cached_property
    def _rough(self) -> Repeated | None:
        """The rows of a response once more, less finely: what both differ by is what the repetition
        is known to. None of a sweep."""
        rough = self.repeated.rough
        return None if rough is None else self._read(rough)

    def _read(self, repeated: Repeated) -> Repeated:
        # what cannot be repeated says so at its own column
        with suppress(NotRepeated):
            repeated.read(self._readable())
        return repeated

    def _readable(self) -> list[Wanted]:
        """What the tables read, as far as it is repeated."""
        problem = self._analysis.result.problem
        known = problem.quantities()
        names = read_for(used_quantities(self._analysis.layouts, known), known)
        return [known[name] for name in names if not reason_of(problem, known[name])]

    @property
    def digits(self) -> int | None:
        """Digits to which every cell is right, in parts of its column's largest; None where nothing
        was repeated."""
        return least_digits(self.columns)

    @property
    def worst(self) -> ColumnErrors | None:
        """The column with the largest error in parts of its largest number."""
        return worst_column(self.columns)

    @property
    def why(self) -> dict[str, str]:
        """Columns, as TABLE.LABEL, that were not repeated, and why."""
        return {f"{c.table}.{c.label}": c.why for c in self.columns if c.why}

    @cached_property
    def states(self) -> NDArray[np.float64]:
        """The largest error of any state in every row (rows,), in rad or in parts of the length
        unit of the mechanism's size: what `row.error_bound` bounds."""
        wide = self.repeated.wide
        known = wide.states
        with np.errstate(invalid="ignore"):
            off = np.abs((known - self._analysis.result.row_states.states).high)
        found: NDArray[np.float64] = np.max(off, axis=0, initial=0.0)
        return found

    def __getitem__(self, name: str | tuple[str, str]) -> NDArray[Any]:
        """The errors of a column, or of an expression.

        Raises:
            UsageError: several tables have other columns of this label, or what it says is not
                repeated.
            ExpressionError: neither a label nor an expression of quantities.
        """
        if isinstance(name, tuple):
            pair = texts("table and label", name, '["table_03", "theta4"]')
            if len(pair) != 2:
                raise UsageError(f"expected a table and a label, not {len(pair)} texts")
            return self._of(*pair).error.copy()
        a_text("a label or expression", name, '"theta4"')
        known = [column for column in self.columns if column.label == name]
        if not known:
            return self._of_expression(name)
        first, *others = known
        if any(not np.array_equal(c.error, first.error, equal_nan=True) for c in others):
            tables = ", ".join(column.table for column in known)
            raise UsageError(
                f"{name} is a column of {tables}; ask for one of them: "
                f'errors["{first.table}", "{name}"]'
            )
        return first.error.copy()

    def _of(self, table: str, label: str) -> ColumnErrors:
        for column in self.columns:
            if (column.table, column.label) == (table, label):
                return column
        known = list(dict.fromkeys(f"{c.table}.{c.label}" for c in self.columns))
        asked = f"{table[:LONGEST_NAME]}.{label[:LONGEST_NAME]}"
        hint = (
            nearest_hint(asked, known) or f"columns are {', '.join(known[:MOST_LISTED]) or 'none'}"
        )
        raise UsageError(f"there is no column {asked}; {hint}")

    def _of_expression(self, text: str) -> NDArray[Any]:
        if text in row_texts(self._analysis.run):
            raise UsageError(f"{text} is words, which have no error; name numbers")
        values = self._analysis[text]
        parts = values.T if values.ndim > 1 else values[None]
        try:
            true = self._true(self._analysis.result.problem.definitions.parse(text))
        except NotRepeated as reason:
            raise UsageError(f"{text} is not repeated in double-double: {reason}") from None
        found = [
            column_errors("", text, "", cells, *exact).error
            for cells, exact in zip(parts, true, strict=True)
        ]
        return np.stack(found, axis=1) if len(found) > 1 else found[0]

    def _true(self, expression: Expression) -> list[tuple[DoubleDoubles, NDArray[Any]]]:
        """The true values of an expression, and how far they may be off.

        Raises:
            NotRepeated: they are not known.
        """
        true = true_values(expression, self.repeated)
        doubt = doubts(expression, self.repeated, true)
        if self._rough is not None:
            other = true_values(expression, self._rough)
            with np.errstate(invalid="ignore"):
                apart = [np.abs((a - b).high) for a, b in zip(true, other, strict=True)]
            doubt = [np.fmax(a, b) for a, b in zip(doubt, apart, strict=True)]
        return list(zip(true, doubt, strict=True))

    def _of_table(self, layouts: tuple[ColumnLayout, ...], table: Columns) -> list[ColumnErrors]:
        return [
            self._of_column(layout.expression, table.name, column)
            for layout, column in zip(layouts, table.columns, strict=True)
        ]

    def _of_column(self, expression: Expression, table: str, column: TableColumn) -> ColumnErrors:
        values = column.values
        is_text = expression.text.strip() in row_texts(self._analysis.run)
        if is_text or isinstance(values, Words):
            return not_repeated(table, column.label, column.unit, _values(column), WORDS)
        try:
            ((true, doubt),) = self._true(expression)
        except NotRepeated as reason:
            return not_repeated(table, column.label, column.unit, values, str(reason))
        lost = self.repeated.lost_why or LOST
        found = column_errors(table, column.label, column.unit, values, true, doubt, lost)
        there = self._analysis.result.status == Status.dead_centre
        return replace(found, there=there) if there.any() else found


def _values(column: TableColumn) -> Any:
    return column.rows if isinstance(column.values, Words) else column.values
