"""The results of one run: its tables, and any quantity or expression as an array."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import Diagnostic, UsageError
from mechkin_cli.expressions import Expression, Vector
from mechkin_cli.interface.arguments import a_text
from mechkin_cli.interface.plotted import Plotted
from mechkin_cli.interface.reading import Reading
from mechkin_cli.interface.summaries import Summarized
from mechkin_cli.named import Named
from mechkin_cli.runs import SWEEP
from mechkin_cli.tables.columns import Columns, Words, evaluate, row_words
from mechkin_cli.tables.layout import CoefficientsLayout, TableLayout, row_texts
from mechkin_cli.uniqueness import unique_cells

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from numpy.typing import NDArray

    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.interface.certificate import Certificate
    from mechkin_cli.interface.errors import Errors
    from mechkin_cli.interface.model import Model
    from mechkin_cli.mechanism.balance import AnyBalance


class Analysis(Reading, Summarized, Plotted):
    """Results of a sweep or a response: `r["O2.theta"]` is an array over the rows, in the file's
    units.

    Attributes:
        model: of the file.
        layouts: of the tables that were asked for.
        result: states and verdicts of all rows.
        run: `sweep`, or the name of the response.
        asked: quantities that were computed with the rows.
    """

    def __init__(
        self,
        model: Model,
        layouts: tuple[TableLayout, ...],
        result: Result,
        run: str = SWEEP,
        coefficients: tuple[CoefficientsLayout, ...] = (),
        balances: tuple[AnyBalance, ...] = (),
        asked: tuple[str, ...] = (),
    ) -> None:
        self.model = model
        self.layouts = layouts
        self.result = result
        self.run = run
        self.chosen_coefficients = coefficients
        self.chosen_balances = balances
        self.asked = asked

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as what was asked of the model, which is asked again: the rows have the same
        bytes, also where another machine packs them otherwise."""
        session = self.result.session
        named = (*self.layouts, *self.chosen_coefficients, *self.chosen_balances)
        given = {
            "quantities": self.asked,
            "tables": [each.name for each in named],
            "mode": session.problem.assembly.mode,
        }
        return _asked_again, (self.model, self.run, given, session.closed_at)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.result.rows

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything that the run has to say."""
        return (*self.result.diagnostics, *self._balanced[1], *self._unproven)

    @cached_property
    def certificate(self) -> Certificate:
        """Proofs of the rows of a sweep, made when they are asked for: `--certify`.

        Raises:
            UsageError: the rows are those of a response.
        """
        from mechkin_cli.interface.certificate import Certificate

        return Certificate(self)

    @property
    def _unproven(self) -> tuple[Diagnostic, ...]:
        return self.certificate.diagnostics if "certificate" in self.__dict__ else ()

    @property
    def complete(self) -> bool:
        """Whether every row has a solution, and every balance its cells."""
        return self.result.complete and not self._balanced[1]

    @property
    def balance_tables(self) -> tuple[Columns, ...]:
        """The balances that were asked for, in the file's units; empty cells where the rows are no
        closed cycle, which `diagnostics` says."""
        return self._balanced[0]

    @cached_property
    def balances(self) -> dict[str, dict[str, NDArray[Any]]]:
        """The same by name and label: `r.balances["shaking"]["amplitude"]`; words as texts."""
        return {
            table.name: {
                c.label: c.values.array() if isinstance(c.values, Words) else c.values
                for c in table.columns
            }
            for table in self.balance_tables
        }

    @cached_property
    def _balanced(self) -> tuple[tuple[Columns, ...], tuple[Diagnostic, ...]]:
        if not self.chosen_balances:
            return (), ()
        from mechkin_cli.interface.balances import balance_table

        found = [balance_table(balance, self.result) for balance in self.chosen_balances]
        faults = dict.fromkeys(fault for _, own in found for fault in own)
        return tuple(table for table, _ in found), tuple(faults)

    @cached_property
    def errors(self) -> Errors:
        """How far every cell is from its true value: the rows repeated in double-double when this
        is first read; a response from its start, which takes seconds."""
        from mechkin_cli.interface.errors import Errors

        return Errors(self)

    @cached_property
    def tables(self) -> Named[Columns]:
        """The tables that were asked for, evaluated in the file's units: in order, and by name."""
        return Named(evaluate(layout, self.result) for layout in self.layouts)

    @cached_property
    def coefficients(self) -> tuple[Columns, ...]:
        """The tables of the dense system of reactions that the file asks for, two for each.

        Raises:
            UsageError: a row has no solution.
        """
        if not self.chosen_coefficients:
            return ()
        from mechkin_cli.interface.coefficients import coefficient_tables

        found = [coefficient_tables(one, self.result) for one in self.chosen_coefficients]
        return tuple(table for pair in found for table in pair)

    def view(self, path: str | PathLike[str], *, modes: bool = True) -> Path:
        """Writes a page that shows this run in motion, with curves, tables and notes; arguments,
        result and errors as those of `Model.view`."""
        from mechkin_cli.interface.viewing import view_page, write_view

        return write_view(path, view_page([self], modes)[0])

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity or an expression of quantities, in the file's units.

        Returns (rows,), for a vector (rows, 3); nan where a row has no solution; `row.status`,
        `row.mode`, `row.proof` and, of a response, `row.event` are arrays of words. What the run
        did not compute is computed now.

        Raises:
            ExpressionError: no such quantity, or dimensions that do not fit.
            UsageError: it belongs to loops that `follow:` has left out of this run.
        """
        a_text("a quantity or expression", text, '"O4.theta"')
        if text in row_texts(self.run):
            return row_words(text, self.result).array()
        for given in (self.result.inputs, self.result.input_rates):
            if text in given:
                return given[text].copy()
        expression = self.result.problem.definitions.parse(text)
        result = self._readable(expression.names)
        columns = self._columns(expression, result)
        others = [self._columns(expression, other) for other in result.alternatives]
        disturbed = [self._columns(expression, other) for other in result.disturbed]
        settled = [
            unique_cells(column, [o[i] for o in others], [d[i] for d in disturbed])
            for i, column in enumerate(columns)
        ]
        return np.stack(settled, axis=1) if len(settled) > 1 else settled[0]

    def unit(self, text: str) -> str:
        """The unit of a quantity or an expression, as tables write it: `deg`, `N*m`, `` of words
        and pure numbers.

        Raises:
            ExpressionError: no such quantity, or dimensions that do not fit.
        """
        a_text("a quantity or expression", text, '"O4.theta"')
        if text in row_texts(self.run):
            return ""
        expression = self.result.problem.definitions.parse(text)
        result = self._readable(expression.names)
        return result.units.label(expression.evaluate(result.quantity, result.units).dimension)

    def _columns(self, expression: Expression, result: Result) -> list[NDArray[np.float64]]:
        """The value of an expression in the file's units: one column, or those of a vector."""
        found = expression.evaluate(result.quantity, result.units)
        value = found.value
        parts = value.components if isinstance(value, Vector) else [value]
        return [self._column(part, found.dimension) for part in parts]

    def _column(self, value: object, dimension: object) -> NDArray[np.float64]:
        rows = np.array(np.broadcast_to(np.asarray(value, float), (self.rows,)))
        return np.asarray(self.result.units.from_si(rows, dimension), float)  # type: ignore[arg-type]

    def _readable(self, names: Iterable[str]) -> Result:
        """The result, which has all the quantities among some dotted names.

        Raises:
            UsageError: one belongs to loops that `follow:` has left out of this run.
        """
        here = self.result.problem.quantities()
        known = self.model.problem.quantities() if self.run == SWEEP else here
        wanted = [name if name in known else name.rpartition(".")[0] for name in names]
        for name in wanted:
            if name in known and name not in here:
                raise UsageError(
                    f"{name} belongs to loops that this run has left out (follow:); ask for it in "
                    f'analyze(["{name}"]), which then follows them'
                )
        return self.result


def _asked_again(
    model: Model, run: str, given: dict[str, Any], closed_at: Sequence[str] | None
) -> Analysis:
    """What a model answers once more."""
    if run != SWEEP:
        return model.respond(run, **given)
    return model.analyze(closed_at=closed_at, **given)
