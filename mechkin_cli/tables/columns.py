"""Column values of a table: expressions evaluated over all rows, in the units of the file.

Values are float64 arrays of shape (rows,), nan where a cell stays empty. In a row without solution
only inputs, `row.mode`, `row.status` and `row.proof` keep their cells.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.expressions import ExpressionError, Quantity, Vector
from mechkin_cli.proof import Proof
from mechkin_cli.status import Status, has_solution
from mechkin_cli.tables.layout import ROW_EVENT, ROW_NUMBERS, ROW_PROOF, ColumnLayout, TableLayout
from mechkin_cli.tables.source import FloatArray, Source
from mechkin_cli.uniqueness import unique_cells
from mechkin_cli.units import DIMENSIONLESS

if TYPE_CHECKING:
    from mechkin_cli.tables.summary import Summary


INFINITE = "inf"


@dataclass(frozen=True, slots=True, eq=False)
class Words:
    """A text per row: `words[codes[i]]`."""

    codes: NDArray[np.int32]
    words: tuple[str, ...]

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.codes.size

    def texts(self, rows: Sequence[int]) -> list[str]:
        """The texts of some rows."""
        return [self.words[self.codes[row]] for row in rows]

    def array(self) -> NDArray[np.str_]:
        """The text of every row, shape (rows,)."""
        return np.array(self.words)[self.codes]


def words_of(texts: Sequence[str]) -> Words:
    """Texts row by row."""
    places = {text: place for place, text in enumerate(dict.fromkeys(texts))}
    return Words(np.array([places[text] for text in texts], np.int32), tuple(places))


@dataclass(frozen=True, slots=True, eq=False)
class Column:
    """One evaluated column: `values` in the unit that `unit` names, shape (rows,).

    `unbounded` (rows,) is infinite with its sign in rows at a dead centre towards which the column
    grows without bound, else zero; None where it does in no row.
    """

    label: str
    unit: str
    values: FloatArray | Words
    decimals: int | None = None
    unbounded: FloatArray | None = None

    @property
    def numbers(self) -> FloatArray:
        """The values of a column that is no words, with what is infinite."""
        assert not isinstance(self.values, Words)
        if self.unbounded is None:
            return self.values
        return np.where(self.unbounded == 0.0, self.values, self.unbounded)

    def texts(self, texts: Sequence[str]) -> list[str]:
        """The texts of the values, with words for what is infinite."""
        if self.unbounded is None:
            return list(texts)
        words = np.where(self.unbounded > 0.0, INFINITE, f"-{INFINITE}").tolist()
        is_infinite = (self.unbounded != 0.0).tolist()
        return [w if i else t for t, w, i in zip(texts, words, is_infinite, strict=True)]

    def part(self, rows: NDArray[np.intp] | Sequence[int]) -> Column:
        """Some of the rows."""
        rows, values = np.asarray(rows, dtype=np.intp), self.values
        if isinstance(values, Words):
            return replace(self, values=Words(values.codes[rows], values.words))
        unbounded = None if self.unbounded is None else self.unbounded[rows]
        return replace(self, values=values[rows], unbounded=unbounded)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.values.rows if isinstance(self.values, Words) else self.values.size


def column_of_numbers(
    label: str, unit: str, numbers: FloatArray, decimals: int | None = None
) -> Column:
    """A column of numbers (rows,), of which some may be infinite."""
    infinite = np.isinf(numbers)
    if not infinite.any():
        return Column(label, unit, numbers, decimals)
    unbounded = np.where(infinite, numbers, 0.0)
    return Column(label, unit, np.where(infinite, np.nan, numbers), decimals, unbounded)


@dataclass(frozen=True, slots=True, eq=False)
class Columns:
    """One evaluated table; `of_rows` says that its rows are those of the run, `summary` what stands
    below it."""

    name: str
    title: str
    columns: tuple[Column, ...]
    of_rows: bool = True
    summary: Summary | None = None


def evaluate(table: TableLayout, source: Source) -> Columns:
    """All columns of a table, in file units.

    Raises:
        ExpressionError: a column is no number per row, or names what the source does not have.
    """
    columns = tuple(column_of(layout, source) for layout in table.columns)
    summary = None
    if table.summary:
        from mechkin_cli.tables.summary import summary_of

        summary = summary_of(table.summary, table.columns, columns, source)
    return Columns(table.name, table.title, columns, summary=summary)


def status_words(source: Source) -> Words:
    """The status label of every row."""
    codes = source.status.astype(np.int32)
    return Words(codes, tuple(status.label for status in Status))


def proof_words(source: Source) -> Words:
    """What is proven of every row of a sweep."""
    return Words(source.proof.astype(np.int32), tuple(proof.label for proof in Proof))


def mode_words(source: Source) -> Words:
    """The letter of every row's assembly mode."""
    return Words(np.zeros(source.rows, dtype=np.int32), (source.letter,))


def event_words(source: Source) -> Words:
    """What happened at every row of a response; "" where nothing did."""
    known = tuple(dict.fromkeys(source.events))
    numbers = {text: number for number, text in enumerate(known)}
    return Words(np.array([numbers[text] for text in source.events], dtype=np.int32), known)


_WORDS = {
    "row.mode": mode_words,
    "row.status": status_words,
    ROW_PROOF: proof_words,
    ROW_EVENT: event_words,
}


def row_words(name: str, source: Source) -> Words:
    """A quantity of the rows that is a text, by its name."""
    return _WORDS[name](source)


def solved_rows(source: Source) -> NDArray[np.bool_]:
    """Which rows have a solution, shape (rows,)."""
    return has_solution(source.status)


def column_of(layout: ColumnLayout, source: Source) -> Column:
    """One column in file units; cells that are not unique are nan. Raises as `evaluate`."""
    name = layout.expression.text.strip()
    if name in _WORDS:
        return Column(layout.label, "", row_words(name, source))
    given = source.inputs.get(name, source.input_rates.get(name))
    if given is not None:
        unit = source.units.label(source.quantity(name).dimension)
        return Column(layout.label, unit, given, layout.decimals)
    column = _evaluated(layout, source)
    others = [_evaluated(layout, other).values for other in source.alternatives]
    disturbed = [_evaluated(layout, other).values for other in source.disturbed]
    values = unique_cells(column.values, others, disturbed)  # type: ignore[arg-type]
    return replace(column, values=values)


def _evaluated(layout: ColumnLayout, source: Source) -> Column:
    quantity = layout.expression.evaluate(lambda name: _resolve(name, source))
    value = quantity.value
    if isinstance(value, Vector):
        raise ExpressionError(
            f"column {layout.label!r} is a vector, a column holds one number per row",
            0,
            f"write one component of it: {component_text(layout.expression.text, 'x')}",
        )
    in_si = np.array(np.broadcast_to(value, (source.rows,)), dtype=np.float64)
    # the conversion may hand back the array itself, so it works on the copy
    values = source.units.from_si(in_si, quantity.dimension)
    # infinite is only what grows without bound towards a dead centre at which its row stands
    values[~solved_rows(source) | np.isinf(values) & (source.status != Status.dead_centre)] = np.nan
    unit = source.units.label(quantity.dimension)
    return column_of_numbers(layout.label, unit, values, layout.decimals)


def _resolve(name: str, source: Source) -> Quantity:
    if name in _WORDS:
        raise ExpressionError(
            f"{name} is a text and cannot be computed with", 0, "make it a column of its own"
        )
    if name in ROW_NUMBERS:
        return Quantity(getattr(source, name.removeprefix("row.")), DIMENSIONLESS)
    return source.quantity(name)


def component_text(text: str, axis: str) -> str:
    """The expression of a vector's component, in parentheses where it is a sum or the like.

    >>> component_text("pen.position", "x"), component_text("2*pen.position", "y")
    ('pen.position.x', '(2*pen.position).y')
    """
    text = text.strip()
    bare = text.replace(".", "").replace("_", "").isalnum()
    return f"{text}.{axis}" if bare else f"({text}).{axis}"
