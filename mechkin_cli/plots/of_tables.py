"""The picture of a table: as its `plot:` says, else all its numbers over the run's parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.plots.curves import column_curve, numbers_of, parameter_curve
from mechkin_cli.plots.picture import Picture, picture

if TYPE_CHECKING:
    from mechkin_cli.tables.columns import Columns
    from mechkin_cli.tables.layout import TableLayout
    from mechkin_cli.view.readable import Readable


def table_picture(
    analysis: Readable, layout: TableLayout, table: Columns, x: str | None = None
) -> Picture:
    """A table of a run; `x`, a label or an expression, goes before what its `plot:` says.

    Raises:
        UsageError: it has no numbers, or names a column of words.
        ExpressionError: `x` is an unknown name.
    """
    plot, inputs = layout.plot, analysis.result.inputs
    x = (plot.x if plot else None) if x is None else x
    if plot is not None and plot.y:
        by_label = {column.label: column for column in table.columns}
        drawn = [column_curve(by_label[label]) for label in plot.y]
    else:
        given = {c.label for c in layout.columns if c.expression.text.strip() in inputs}
        given.add(parameter_curve(analysis).label if x is None else x)
        drawn = [curve for curve in numbers_of(table.columns) if curve.label not in given]
    return picture(analysis, table.title or table.name, drawn, x)
