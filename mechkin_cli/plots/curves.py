"""Curves and pictures as plain data: which curves stand against what, and what is marked.

A curve is a column by its label, a quantity or an expression, with its unit. Numbers stand over one
column, a panel for each unit. Vectors are drawn in a plane with equal axes instead: a position
gives the curve of its point, a force its polar diagram about the origin. Two columns of the same
unit of length or force are drawn in such a plane, too.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables import Columns, TableColumn, TableLayout, Words, row_texts, run_parameter
from mechkin_cli.units import FORCE, LENGTH, MOMENT
from mechkin_cli.verdict import Status
from mechkin_cli.view import run_marks

if TYPE_CHECKING:
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.sweep import Readable
    from mechkin_cli.tables import Columns, TableLayout


class PlotCurve(NamedTuple):
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


def curve_of(analysis: Readable, name: str) -> PlotCurve:
    """A column of the run's tables by its label, or else a quantity or an expression.

    Raises:
        UsageError: what is named is words.
        ExpressionError: neither a label nor an expression of quantities.
    """
    columns = (column for table in analysis.tables for column in table.columns)
    column = next((one for one in columns if one.label == name), None)
    if column is not None:
        return _column_curve(column)
    if name in row_texts(analysis.run):
        raise _not_numbers(name)
    result = analysis.result
    quantity = result.problem.definitions.parse(name).evaluate(result.quantity, result.units)
    return PlotCurve(name, result.units.label(quantity.dimension), analysis[name])


def _column_curve(column: TableColumn) -> PlotCurve:
    if isinstance(column.values, Words):
        raise _not_numbers(column.label)
    return PlotCurve(column.label, column.unit, column.values)


def parameter_curve(analysis: Readable) -> PlotCurve:
    """What the run goes along; where nothing moves, the numbers of the rows."""
    along = run_parameter(analysis.result)
    if along is None:
        return PlotCurve("row", "", np.arange(1.0, analysis.rows + 1))
    return PlotCurve(along.name, along.unit, along.values)


def _not_numbers(name: str) -> UsageError:
    return UsageError(f"{name} is words, which cannot be drawn; take a column of numbers")


COMPONENTS = "xyz"


class Panel(NamedTuple):
    """Curves of one unit."""

    unit: str
    curves: tuple[PlotCurve, ...]


class Picture(NamedTuple):
    """What is drawn.

    Attributes:
        title: above it.
        x: against which the curves of all panels stand; in a plane one for each curve.
        panels: from top to bottom; in a plane one.
        is_plane: both axes are of one unit and drawn to one scale.
        parameter: what the run goes along.
        marks: dead centres, branch points and events: where, by that parameter, and in words.
        solved: rows with a position (rows,).
        doubtful: verdicts other than ok of rows that have one: words and rows (rows,).
    """

    title: str
    x: tuple[PlotCurve, ...]
    panels: tuple[Panel, ...]
    is_plane: bool
    parameter: PlotCurve
    marks: tuple[tuple[float, str], ...]
    solved: Bools
    doubtful: tuple[tuple[str, Bools], ...]

    def __repr__(self) -> str:
        curves = ", ".join(curve.words for panel in self.panels for curve in panel.curves)
        return f"Picture of {curves} over {', '.join(dict.fromkeys(c.words for c in self.x))}"


def picture(
    analysis: Readable, title: str, y: Sequence[str | PlotCurve], x: str | PlotCurve | None = None
) -> Picture:
    """The picture of some columns, quantities or expressions, in the file's units.

    Args:
        analysis: of the run.
        title: above the picture.
        y: what is drawn; vectors alone, or numbers alone.
        x: against what; None: the run's parameter.

    Raises:
        UsageError: nothing to draw, words, or what cannot stand in one picture.
        ExpressionError: an unknown name, or dimensions that do not fit.
    """
    drawn = [one if isinstance(one, PlotCurve) else curve_of(analysis, one) for one in y]
    if not drawn:
        raise UsageError(f"{title} has nothing to draw; name what to draw, with --y A.effort")
    along = parameter_curve(analysis)
    against = curve_of(analysis, x) if isinstance(x, str) else x
    if any(curve.is_vector for curve in drawn):
        xs, ys = _in_plane(drawn, against)
        return _picture(analysis, title, xs, (Panel(ys[0].unit, ys),), along, is_plane=True)
    against = against or along
    if against.is_vector:
        raise UsageError(f"{against.label} is a vector; draw over a number, such as its .x")
    units = dict.fromkeys(curve.unit for curve in drawn)
    panels = tuple(Panel(u, tuple(c for c in drawn if c.unit == u)) for u in units)
    label = analysis.result.units.label
    is_plane = against.label != along.label and set(units) == {against.unit}
    is_plane &= against.unit in {label(LENGTH), label(FORCE), label(MOMENT)}
    xs = len(drawn) * (against,) if is_plane else (against,)
    return _picture(analysis, title, xs, panels, along, is_plane=is_plane)


def _picture(
    analysis: Readable,
    title: str,
    x: tuple[PlotCurve, ...],
    panels: tuple[Panel, ...],
    along: PlotCurve,
    *,
    is_plane: bool,
) -> Picture:
    result = analysis.result
    marks = tuple(
        (float(str(mark["x"])), str(mark["text"]))
        for mark in run_marks(analysis, along.label, along.values)
    )
    doubtful = tuple(
        (status.label, result.status == status)
        for status in Status
        if status not in (Status.ok, Status.dead_centre)  # the latter is a mark
        and status.has_solution
        and bool((result.status == status).any())
    )
    return Picture(title, x, panels, is_plane, along, marks, result.solved, doubtful)


def _in_plane(
    drawn: Sequence[PlotCurve], against: PlotCurve | None
) -> tuple[tuple[PlotCurve, ...], tuple[PlotCurve, ...]]:
    """Vectors by the two components in which they spread most, all by the same."""
    numbers = [curve.label for curve in drawn if not curve.is_vector]
    if numbers or against is not None:
        other = numbers[0] if numbers or against is None else against.label
        vector = next(curve.label for curve in drawn if curve.is_vector)
        raise UsageError(
            f"{vector} is a vector, which is drawn in a plane of its own, without {other}; "
            "for curves over a column write its components: .x, .y or .z"
        )
    units = {curve.unit for curve in drawn}
    if len(units) > 1:
        listed = " and ".join(sorted(units))
        raise UsageError(f"vectors in {listed} do not go into one plane; draw them one by one")
    # a vector of a plane has two components; those without a number come last
    spreads = [_spread(values) for values in np.concatenate([c.values for c in drawn]).T]
    first, second = sorted(sorted(range(len(spreads)), key=lambda k: -spreads[k])[:2])

    def components(k: int) -> tuple[PlotCurve, ...]:
        return tuple(
            PlotCurve(f"{curve.label}.{COMPONENTS[k]}", curve.unit, curve.values[:, k])
            for curve in drawn
        )

    return components(first), components(second)


def _spread(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.ptp(known)) if known.size else -1.0


def table_picture(
    analysis: Readable, layout: TableLayout, table: Columns, x: str | None = None
) -> Picture:
    """The picture of a table: as its `plot:` says, else all its numbers over the run's parameter.

    Args:
        x: a label or an expression that takes the place of the one in `plot:`.

    Raises:
        UsageError: it has no numbers, or names a column of words.
        ExpressionError: `x` is an unknown name.
    """
    x = layout.plot_x if x is None else x
    if layout.plot_y:
        by_label = {column.label: column for column in table.columns}
        drawn = [_column_curve(by_label[label]) for label in layout.plot_y]
    else:
        inputs = analysis.result.inputs
        left_out = {c.label for c in layout.columns if c.expression.text.strip() in inputs}
        left_out.add(parameter_curve(analysis).label if x is None else x)
        drawn = [
            _column_curve(column)
            for column in table.columns
            if column.label not in left_out and not isinstance(column.values, Words)
        ]
    return picture(analysis, table.title or table.name, drawn, x)
