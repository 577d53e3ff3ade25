"""What pictures are drawn of: columns by label, quantities and expressions, with their units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.columns import Column, Words
from mechkin_cli.tables.layout import row_texts
from mechkin_cli.tables.run_parameter import run_parameter

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.view.readable import Readable


class Curve(NamedTuple):
    """Values over the rows (rows,), of a vector (rows, components), nan where there is none."""

    label: str
    unit: str
    values: Floats

    @property
    def is_vector(self) -> bool:
        """Whether it has components."""
        return self.values.ndim > 1

    @property
    def words(self) -> str:
        """Label and unit."""
        return f"{self.label} [{self.unit}]" if self.unit else self.label


def curve_of(analysis: Readable, name: str) -> Curve:
    """A column of the run's tables by its label, or else a quantity or an expression.

    Raises:
        UsageError: what is named is words.
        ExpressionError: neither a label nor an expression of quantities.
    """
    columns = (column for table in analysis.tables for column in table.columns)
    column = next((one for one in columns if one.label == name), None)
    if column is not None:
        return column_curve(column)
    if name in row_texts(analysis.run):
        raise _words(name)
    result = analysis.result
    found = result.problem.definitions.parse(name).evaluate(result.quantity, result.units)
    return Curve(name, result.units.label(found.dimension), analysis[name])


def column_curve(column: Column) -> Curve:
    """A column of a table.

    Raises:
        UsageError: its cells are words.
    """
    if isinstance(column.values, Words):
        raise _words(column.label)
    return Curve(column.label, column.unit, column.values)


def numbers_of(columns: Sequence[Column]) -> list[Curve]:
    """The columns whose cells are numbers."""
    return [column_curve(column) for column in columns if not isinstance(column.values, Words)]


def parameter_curve(analysis: Readable) -> Curve:
    """What the run goes along; where nothing moves, the numbers of the rows."""
    along = run_parameter(analysis.result)
    if along is None:
        return Curve("row", "", np.arange(1.0, analysis.rows + 1))
    return Curve(along.name, along.unit, along.values)


def _words(name: str) -> UsageError:
    return UsageError(f"{name} is words, which cannot be drawn; take a column of numbers")
