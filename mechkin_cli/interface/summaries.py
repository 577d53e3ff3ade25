"""`Analysis.summary` and `Analysis.peak`: extremes with their places, means and ranges."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, overload

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.interface.arguments import a_text
from mechkin_cli.tables.layout import row_texts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.tables.columns import Columns
    from mechkin_cli.tables.layout import TableLayout
    from mechkin_cli.tables.summary import Extreme, Statistics


class _Rows(Protocol):
    """What is summed up."""

    layouts: tuple[TableLayout, ...]
    result: Result
    run: str

    @property
    def tables(self) -> tuple[Columns, ...]:
        """The tables that were asked for."""
        ...

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity or an expression."""
        ...


class Summarized:
    """The summaries of an analysis."""

    @overload
    def summary(self: _Rows) -> dict[str, dict[str, Statistics]]: ...
    @overload
    def summary(self: _Rows, quantity: str) -> Statistics: ...
    def summary(
        self: _Rows, quantity: str | None = None
    ) -> Statistics | dict[str, dict[str, Statistics]]:
        """Largest, smallest and peak value with their places, mean, RMS and range, in the file's
        units.

        Of a quantity or expression, of a vector by its norm; without one, of every computed column
        of every table: `r.summary()["slider"]["torque"].rms`. Rows without a value do not count:
        `.rows` says how many do. A place is a value of time where the run has one, else of its
        first input that moves; over that way mean and RMS are taken, by the trapezoidal rule. The
        way to a row that is infinite is none of it: `.infinite` says how many are.

        Raises:
            ExpressionError: no such quantity, or dimensions that do not fit.
            UsageError: what is named is words.

        Example:
            >>> from mechkin_cli import load
            >>> r = load("mechanisms/slider_crank.yaml").analyze()
            >>> found = r.summary("A.effort")
            >>> found.peak.place, found.rows
            (260.0, 37)
        """
        from mechkin_cli.tables.columns import solved_rows
        from mechkin_cli.tables.summary import statistics, summary_of

        if quantity is None:
            found = {}
            for layout, table in zip(self.layouts, self.tables, strict=True):
                below = summary_of((), layout.columns, table.columns, self.result)
                found[table.name] = {each.label: each.statistics for each in below.columns}
            return found
        if a_text("a quantity or expression", quantity, '"O4.theta"') in row_texts(self.run):
            raise UsageError(f"{quantity} is words, which have no summary; name numbers")
        values = self[quantity]
        if values.ndim > 1:
            values = self[f"norm({quantity})"]
        return statistics(np.where(solved_rows(self.result), values, np.nan), self.result)

    def peak(self: _Rows, quantity: str) -> Extreme:
        """The largest magnitude of a quantity or expression, and its place, as `summary` has it.

        Example:
            >>> from mechkin_cli import load
            >>> value, place = load("mechanisms/slider_crank.yaml").analyze().peak("A.radial_force")
            >>> round(value, 3), place
            (145.425, 220.0)
        """
        text = a_text("a quantity or expression", quantity, '"O4.theta"')
        return Summarized.summary(self, text).peak
