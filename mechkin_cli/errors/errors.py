"""The true errors of an analysis: how far its cells are from exact numbers.

A column is evaluated in double-double as its cells are, with every number of its text taken
exactly, and converted by the exact factor of its unit; `doubts` are how far these true values may
be off themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.arguments import a_text, texts
from mechkin_cli.building import used_quantities
from mechkin_cli.diagnostics import LONGEST_NAME, UsageError, nearest_hint
from mechkin_cli.errors.motion import FINE
from mechkin_cli.errors.response import RepeatedResponse, ResponseRows
from mechkin_cli.errors.rest import EquilibriumRows, RepeatedEquilibria, RestRows
from mechkin_cli.errors.rows import (
    BALANCE,
    CROSSED,
    DENSE,
    IMPACTS,
    SUMMARY,
    WORDS,
    NotRepeated,
    Repeated,
    reason_of,
    sticking,
    wide_run,
)
from mechkin_cli.expressions import Expression, NumberNode, Quantity, Vector, exact_literal
from mechkin_cli.mechanism import read_for
from mechkin_cli.record import replace
from mechkin_cli.response import ResponseResult
from mechkin_cli.show import Listed, Listing
from mechkin_cli.statics import EquilibriumResult, UnsolvedText
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
from mechkin_cli.tape import DoubleDoubles, TraceLost, bounded, exactly
from mechkin_cli.tolerances import NO_DOUBT
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.sweep import Readable, Result
    from mechkin_cli.tables import FloatArray, TableColumn
    from mechkin_cli.units import UnitSystem


class TrueSource(Protocol):
    """The rows of a run in double-double (`rows.Repeated`)."""

    @property
    def rows(self) -> int:
        """Number of rows."""
        ...

    @property
    def units(self) -> UnitSystem:
        """Units of the mechanism file."""
        ...

    @property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """Time and inputs of the rows, in the file's units."""
        ...

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by its dotted name, in SI."""
        ...


def repetition(result: Result) -> Repeated:
    """A run in double-double.

    Raises:
        NotRepeated: why it is not repeated.
    """
    text = result.session.text
    try:
        if isinstance(result, EquilibriumResult):
            rows = EquilibriumRows(result, result.chosen.precise)
            return RepeatedEquilibria(result, rows)
        if isinstance(text, UnsolvedText):
            return Repeated(result, RestRows(result, text.session))
        if not isinstance(result, ResponseResult):
            return Repeated(result, wide_run(result))
        if result.problem.mechanism.frictions:
            raise NotRepeated(sticking(result.problem))
        if result.impacts:
            raise NotRepeated(IMPACTS)
        if result.report is not None and result.report.crossings:
            raise NotRepeated(CROSSED)
        return RepeatedResponse(result, ResponseRows(result, result.chosen.precise, FINE))
    except (TraceLost, LookupError, ValueError) as lost:
        raise NotRepeated(str(lost)) from None


def true_values(expression: Expression, source: TrueSource) -> list[DoubleDoubles]:
    """The true values of an expression in file units, (rows,) each: one, of a vector three."""
    written = source.written.get(expression.text.strip())
    if written is not None:
        return [written]
    return _evaluated(expression, source, exact_literal)


def doubts(
    expression: Expression, source: TrueSource, true: Sequence[DoubleDoubles]
) -> list[FloatArray]:
    """How far true values may be off (rows,): by their own rounding, which is nearly all of them
    where terms cancel or a product underflows; and by that of what they are computed of, which is
    what they change by where every number is `OFF` in parts of the largest of its rows. Where the
    text divides by zero that is as much as the value itself."""
    symbols = {getattr(node, "symbol", "") for node in expression.nodes} - {""}
    if not symbols:
        return [np.zeros(source.rows) for _ in true]
    bounds, largest = _bounds(expression, source)
    nothing = NO_DOUBT * largest
    for k, (number, bound) in enumerate(zip(true, bounds, strict=True)):
        # none where a column is zero beside what it is computed of, and so is the bound
        is_zero = np.abs(number.high[np.isfinite(number.high)]).max(initial=0.0) <= nothing
        bounds[k] = np.where(is_zero & (bound <= nothing), 0.0, bound)
    if symbols & _WITH_POLES:
        off = _evaluated(expression, _Off(source), _off_literal)
        with np.errstate(invalid="ignore"):
            apart = [np.abs((one - other).high) for one, other in zip(true, off, strict=True)]
        bounds = [np.fmax(one, other) for one, other in zip(bounds, apart, strict=True)]
    return bounds


def _bounds(expression: Expression, source: TrueSource) -> tuple[list[FloatArray], float]:
    """Of the rounding of the operations, in the file's units, infinite where nothing is known; and
    the largest number that rows have in them."""
    rows = _Bounding(source)
    value = expression.evaluate(
        rows.quantity, source.units, lambda number: _each(exact_literal(number), bounded)
    )
    factor = float(source.units.unit(value.dimension).factor)
    bounds = [np.broadcast_to(bounded(part).bound, (source.rows,)) for part in _parts(value)]
    known = [np.where(np.isnan(bound), np.inf, bound) / factor for bound in bounds]
    return known, rows.largest / factor


def _evaluated(
    expression: Expression, source: TrueSource, literal: Callable[[NumberNode], Quantity]
) -> list[DoubleDoubles]:
    value = expression.evaluate(source.quantity, source.units, literal)
    factor, rows = source.units.unit(value.dimension).factor, np.zeros(source.rows)
    parts = [exactly(part) + rows for part in _parts(value)]
    return parts if factor == 1 else [part / DoubleDoubles.of_fraction(factor) for part in parts]


_WITH_POLES = {"/", "^", "pow", "tan", "log", "mod", "atanh", "unit_vector", "angle_between"}
"""Operations that may make any number of a rounding."""

OFF = float.fromhex("0x1p-98")
"""What numbers are changed by to estimate how far a column is off: above the rounding of
double-double, 2^-105, times a condition of a hundred, and far below that of doubles."""


class _Off:
    """The rows with every number off, each by another part."""

    def __init__(self, source: TrueSource) -> None:
        self.source = source
        self.rows, self.units, self.written = source.rows, source.units, source.written

    def quantity(self, name: str) -> Quantity:
        """As `TrueSource.quantity`."""
        part = OFF * (1.0 + sum(name.encode()) % 7 / 7.0)

        def moved(value: Any) -> Any:
            number = exactly(value)
            sizes = np.abs(number.high)
            return number + part * float(sizes[np.isfinite(sizes)].max(initial=0.0))

        return _each(self.source.quantity(name), moved)


class _Bounding:
    """The rows with numbers that know how far operations on them are off."""

    def __init__(self, source: TrueSource) -> None:
        self.source = source
        self.largest = 0.0

    def quantity(self, name: str) -> Quantity:
        """As `TrueSource.quantity`."""
        quantity = self.source.quantity(name)
        for part in _parts(quantity):
            sizes = np.abs(exactly(part).high)
            self.largest = max(self.largest, float(sizes[np.isfinite(sizes)].max(initial=0.0)))
        return _each(quantity, bounded)


def _parts(quantity: Quantity) -> list[Any]:
    """The value of a quantity, of a vector its components."""
    value: Any = quantity.value
    return list(value.components) if hasattr(value, "components") else [value]


def _each(quantity: Quantity, change: Callable[[Any], Any]) -> Quantity:
    """The quantity with each of its numbers changed."""
    parts = [change(part) for part in _parts(quantity)]
    value: Any = Vector(*parts) if hasattr(quantity.value, "components") else parts[0]
    rest = None if quantity.rest is None else change(quantity.rest)
    return Quantity(value, quantity.dimension, rest)


def _off_literal(number: NumberNode) -> Quantity:
    quantity = exact_literal(number)
    if number.unit is None and number.value == int(number.value):
        return quantity  # whole numbers are what they are: exponents, counts
    value: Any = exactly(quantity.value)
    return Quantity(value + OFF * value, quantity.dimension)


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
        columns = [
            self._of_column(own.expression, table.name, column)
            for layout, table in zip(analysis.layouts, analysis.tables, strict=True)
            for own, column in zip(layout.columns, table.columns, strict=True)
        ]
        others = [(table.name, DENSE) for table in analysis.coefficients]
        others += [(table.name, BALANCE) for table in analysis.balance_tables]
        others += [(f"{t.name}.summary", SUMMARY) for t in analysis.tables if t.summary is not None]
        columns += [not_repeated(name, ALL_COLUMNS, "", 0, why) for name, why in others]
        self.columns: tuple[ColumnErrors, ...] = tuple(columns)

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
            cells = ("", "", "", column.why)
            if row >= 0:
                error, relative = column.error[row], column.relative[row]
                cells = (f"{error:.1e} {column.unit}", f"{relative:.1e}", str(row + 1), "")
            rows.append((column.table, column.label, *cells))
        labels = ("table", "column", "worst error", "relative", "row", "why not")
        return Listing(f"True errors of {self._analysis.model.name}: {digits}", labels, tuple(rows))

    @cached_property
    def repeated(self) -> Repeated:
        """The rows in double-double."""
        return self._read(repetition(self._analysis.result))

    @cached_property
    def _rough(self) -> Repeated | None:
        """The rows of a response once more, less finely: the repetition is known to the difference
        of both. None of a sweep."""
        rough = self.repeated.rough
        return None if rough is None else self._read(rough)

    def _read(self, repeated: Repeated) -> Repeated:
        """Repeats what the tables read, as far as it can be."""
        problem = self._analysis.result.problem
        known = problem.quantities()
        names = read_for(used_quantities(self._analysis.layouts, known), known)
        # a column that cannot be repeated has its own reason
        with suppress(NotRepeated):
            repeated.read([known[name] for name in names if not reason_of(problem, known[name])])
        return repeated

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
        with np.errstate(invalid="ignore"):
            off = (self.repeated.wide.states - self._analysis.result.row_states.states).high
        return np.asarray(np.max(np.abs(off), axis=0, initial=0.0))

    def __getitem__(self, name: str | tuple[str, str]) -> NDArray[Any]:
        """The errors of a column, or of an expression.

        Raises:
            UsageError: several tables have other columns of this label, or it is not repeated.
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
        name = f"{table[:LONGEST_NAME]}.{label[:LONGEST_NAME]}"
        some = ", ".join(known[:MOST_LISTED]) or "none"
        raise UsageError(
            f"there is no column {name}; {nearest_hint(name, known) or f'columns are {some}'}"
        )

    def _of_expression(self, text: str) -> NDArray[Any]:
        if text in row_texts(self._analysis.run):
            raise UsageError(f"{text} is words, which have no error; name numbers")
        values = self._analysis[text]
        parts = values.T if values.ndim > 1 else values[None]
        try:
            true = self._true(self._analysis.result.problem.definitions.parse(text))
        except NotRepeated as reason:
            raise UsageError(f"{text} is not repeated in double-double: {reason}") from None
        errors = [
            column_errors("", text, "", cells, *exact).error
            for cells, exact in zip(parts, true, strict=True)
        ]
        return np.stack(errors, axis=1) if len(errors) > 1 else errors[0]

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

    def _of_column(self, expression: Expression, table: str, column: TableColumn) -> ColumnErrors:
        values = column.values
        if isinstance(values, Words):
            return not_repeated(table, column.label, column.unit, column.rows, WORDS)
        if expression.text.strip() in row_texts(self._analysis.run):
            return not_repeated(table, column.label, column.unit, values, WORDS)
        try:
            ((true, doubt),) = self._true(expression)
        except NotRepeated as reason:
            return not_repeated(table, column.label, column.unit, values, str(reason))
        lost = self.repeated.lost_why or LOST
        errors = column_errors(table, column.label, column.unit, values, true, doubt, lost)
        there = self._analysis.result.status == Status.dead_centre
        return replace(errors, dead_centres=there) if there.any() else errors
