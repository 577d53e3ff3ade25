"""The results of one run: its tables, and any quantity or expression as an array."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol, overload

import numpy as np

from mechkin_cli import balances, errors, plots, tables, view
from mechkin_cli.arguments import a_path, a_text, texts
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError
from mechkin_cli.expressions import Expression, Vector
from mechkin_cli.show import Listed, Listing, Named, html_table, shortened
from mechkin_cli.tables import (
    ROW_NUMBERS,
    ROW_PROOF,
    CoefficientsLayout,
    Columns,
    TableLayout,
    Words,
    evaluate,
    row_texts,
    row_words,
    unique_cells,
)
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    import pandas
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from mechkin_cli.analysis.certificate import Certificate
    from mechkin_cli.analysis.design import Design
    from mechkin_cli.building import Built, ViewSettings
    from mechkin_cli.errors import Errors
    from mechkin_cli.mechanism import AnyBalance, Problem
    from mechkin_cli.modes import Modes
    from mechkin_cli.plots import Drawing, Picture, PlotCurve
    from mechkin_cli.sweep import Result
    from mechkin_cli.tables import Extreme, Statistics

SHOWN_TABLES = 3
"""Tables that a notebook shows opened or closed; the others are named."""


class Solvable(Protocol):
    """A model as the rooms below it know it: its design, and the runs that it can make."""

    @property
    def design(self) -> Design:
        """The checked file with the values of its parameters."""
        ...

    def of(self, design: Design) -> Solvable:
        """A model of another design."""
        ...

    @property
    def name(self) -> str:
        """The mechanism's name."""
        ...

    @property
    def problem(self) -> Problem:
        """The mechanism, its motion and assembly in SI."""
        ...

    @property
    def built(self) -> Built:
        """The file, checked."""
        ...

    @property
    def runs(self) -> tuple[str, ...]:
        """The file's runs by name."""
        ...

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Warnings of the file."""
        ...

    @property
    def view_settings(self) -> ViewSettings:
        """How the file wants to be shown."""
        ...

    def analyze(
        self,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        closed_at: Sequence[str] | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Analysis:
        """Runs the sweep."""
        ...

    def respond(
        self,
        name: str | None = None,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
        lanes: int = 0,
        threads: int = 0,
    ) -> Analysis:
        """Runs a response."""
        ...

    def run_free(
        self,
        name: str,
        quantities: Iterable[str] | None = None,
        *,
        tables: Sequence[str] | None = None,
        mode: str | None = None,
    ) -> Analysis:
        """Runs a response, or finds equilibria, by name."""
        ...

    def modes(self, *, run: str | None = None) -> Modes:
        """All assembly modes at the first row of a run."""
        ...

    def live_record(self, analysis: Any, data: Any) -> dict[str, Any]:
        """What the page of a run computes it from with other parameters, or `why` it cannot."""
        ...


class Analysis(Listed):
    """Results of a sweep or a response: `r["O2.theta"]` is an array over the rows, in the file's
    units. As a mapping (`"O4.theta" in r`, `list(r)`, `r.keys()`) it holds the names of quantities,
    without their components; `r[...]` also takes any expression.

    Attributes:
        model: of the file.
        layouts: of the tables that were asked for.
        result: states and verdicts of all rows.
        run: `sweep`, or the name of the response.
        asked: quantities that were computed with the rows.
    """

    def __init__(
        self,
        model: Solvable,
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
        self._certificate: Certificate | None = None
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

    @property
    def complete(self) -> bool:
        """Whether every row has a solution, and every balance its cells."""
        return self.result.complete and not self._balanced[1]

    # Quantities and expressions, by name.

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

    def keys(self) -> tuple[str, ...]:
        """Names of all quantities of this run, inputs first."""
        words = (name for name in row_texts(self.run) if name != ROW_PROOF)
        quantities = self.result.problem.told_quantities
        return tuple(dict.fromkeys((*self.result.inputs, *quantities, *words, *ROW_NUMBERS)))

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

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

    # Tables.

    @cached_property
    def tables(self) -> Named[Columns]:
        """The tables that were asked for, evaluated in the file's units: in order, and by name."""
        return Named(evaluate(layout, self.result) for layout in self.layouts)

    @cached_property
    def impacts(self) -> Columns | None:
        """The impacts of a response at limits with a restitution, with the impulses that limits
        give and joints transmit, a line for each, in the file's units; None where there are
        none."""
        return self.result.impact_table

    @cached_property
    def coefficients(self) -> tuple[Columns, ...]:
        """The tables of the dense system of reactions that the file asks for, two for each.

        Raises:
            UsageError: a row has no solution.
        """
        if not self.chosen_coefficients:
            return ()
        found = [balances.coefficient_tables(one, self.result) for one in self.chosen_coefficients]
        return tuple(table for pair in found for table in pair)

    @property
    def balance_tables(self) -> tuple[Columns, ...]:
        """The balances that were asked for, in the file's units; empty cells where the rows are no
        closed cycle, which `diagnostics` says."""
        return self._balanced[0]

    @cached_property
    def balances(self) -> dict[str, dict[str, NDArray[Any]]]:
        """The same by name and label: `r.balances["shaking"]["amplitude"]`; words as texts."""
        return by_label(self.balance_tables)

    @cached_property
    def _balanced(self) -> tuple[tuple[Columns, ...], tuple[Diagnostic, ...]]:
        if not self.chosen_balances:
            return (), ()
        found = [balances.balance_table(balance, self.result) for balance in self.chosen_balances]
        faults = dict.fromkeys(fault for _, own in found for fault in own)
        return tuple(table for table, _ in found), tuple(faults)

    def to_pandas(self, what: str | Sequence[str] | None = None) -> pandas.DataFrame:
        """A table, or quantities over the rows, as a DataFrame of pandas.

        Args:
            what: the name of a table; or quantities and expressions, each component of a vector
                as a column; None: the only table.

        Returns:
            A line for each row, empty cells as nan. `attrs["units"]` has the unit of each column,
            `attrs["name"]` and `attrs["title"]` are those of the table.

        Raises:
            UsageError: pandas is not installed, there is no such table, several to choose from, or
                no list of texts.
            ExpressionError: no such quantity.

        Example:
            >>> from mechkin_cli import load
            >>> r = load("mechanisms/dissertation/rcsr.yaml").analyze()
            >>> r.to_pandas("table_03").attrs["units"]["theta4"]
            'deg'
        """
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas needs pandas: pip install 'mechkin[pandas]'") from None
        if what is None or isinstance(what, str):
            return _table_frame(self._table(what), pandas)
        columns: dict[str, Any] = {}
        units: dict[str, str] = {}
        for text in texts("what", what, '["O4.theta"]'):
            values, unit = self[text], self.unit(text)
            found = {text: values} if values.ndim == 1 else _components(text, values)
            columns |= found
            units |= dict.fromkeys(found, unit)
        frame = pandas.DataFrame(columns)
        frame.attrs |= {"units": units, "name": self.run, "title": self.model.name}
        return frame

    def _table(self, name: str | None) -> Columns:
        if name is not None:
            return self.tables[name]
        if len(self.tables) == 1:
            return self.tables[0]
        names = ", ".join(self.tables.keys()) or "none"
        raise UsageError(f"which table? write to_pandas(NAME); tables are {names}")

    # Errors, proofs, extremes.

    @cached_property
    def errors(self) -> Errors:
        """How far every cell is from its true value: the rows repeated in double-double when this
        is first read; a response from its start, which takes seconds."""
        return errors.Errors(self)

    @property
    def certificate(self) -> Certificate:
        """Proofs of the rows of a sweep, made when they are asked for: `--certify`.

        Raises:
            UsageError: the rows are those of a response.
        """
        if self._certificate is None:
            from mechkin_cli.analysis.certificate import Certificate

            self._certificate = Certificate(self)
        return self._certificate

    @property
    def _unproven(self) -> tuple[Diagnostic, ...]:
        return () if self._certificate is None else self._certificate.diagnostics

    @overload
    def summary(self) -> dict[str, dict[str, Statistics]]: ...
    @overload
    def summary(self, quantity: str) -> Statistics: ...
    def summary(self, quantity: str | None = None) -> Statistics | dict[str, dict[str, Statistics]]:
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
            >>> r = load("mechanisms/plane/slider_crank.yaml").analyze()
            >>> found = r.summary("A.effort")
            >>> found.peak.place, found.rows
            (260.0, 37)
        """
        if quantity is None:
            found = {}
            for layout, table in zip(self.layouts, self.tables, strict=True):
                below = tables.summary_of((), layout.columns, table.columns, self.result)
                found[table.name] = {each.label: each.statistics for each in below.columns}
            return found
        if a_text("a quantity or expression", quantity, '"O4.theta"') in row_texts(self.run):
            raise UsageError(f"{quantity} is words, which have no summary; name numbers")
        values = self[quantity]
        if values.ndim > 1:
            values = self[f"norm({quantity})"]
        return tables.statistics(
            np.where(tables.solved_rows(self.result), values, np.nan), self.result
        )

    def peak(self, quantity: str) -> Extreme:
        """The largest magnitude of a quantity or expression, and its place, as `summary` has it.

        Example:
            >>> from mechkin_cli import load
            >>> r = load("mechanisms/plane/slider_crank.yaml").analyze()
            >>> value, place = r.peak("A.radial_force")
            >>> round(value, 3), place
            (145.425, 220.0)
        """
        text = a_text("a quantity or expression", quantity, '"O4.theta"')
        return self.summary(text).peak

    # Pictures.

    def plot(
        self,
        *y: str,
        x: str | None = None,
        table: str | None = None,
        to: str | Path | None = None,
    ) -> Figure:
        """Draws columns, quantities or expressions with matplotlib (the extra `plot`).

        Numbers stand over `x`, a panel for each unit; vectors are drawn in a plane with equal axes:
        `r.plot("tip.position")` is a coupler curve, `r.plot("A.force")` a polar diagram.

        Args:
            y: labels of columns, quantities or expressions; none: those of a table, as its `plot:`
                says.
            x: against which they stand; None: time where the run has one, else its first input
                that moves.
            table: the table that is drawn where no `y` is given; None: the first.
            to: a file to write it to, .svg, .png or .pdf.

        Raises:
            UsageError: matplotlib is not there, nothing to draw, words, no such table, or what
                cannot stand in one picture.
            ExpressionError: an unknown name, or dimensions that do not fit.

        Example:
            r.plot("O1.effort", "O4.theta")
            r.plot(to="table.svg")
        """
        path = None if to is None else a_path("to", to, 'the path of a picture such as "p.svg"')
        found = self.picture(y, x, table)
        if path is not None:
            tables.write_files(path.parent, {path.name: plots.image(found, plots.format_of(path))})
        return plots.drawn(found)

    def picture(
        self, y: Sequence[str] = (), x: str | None = None, table: str | None = None
    ) -> Picture:
        """What `plot` draws, as plain data; arguments and errors are those of `plot`."""
        return plots.picture(drawing_of(self, y, x, table))

    @overload
    def view(self, path: None = None, *, modes: bool = True) -> view.Page: ...

    @overload
    def view(self, path: str | PathLike[str], *, modes: bool = True) -> Path: ...

    def view(
        self, path: str | PathLike[str] | None = None, *, modes: bool = True
    ) -> view.Page | Path:
        """Makes a page that shows this run in motion, with curves, tables and notes; arguments,
        result and errors as those of `Model.view`."""
        page = view.view_page([self], modes)[0]
        return view.Page(page) if path is None else view.write_view(path, page)

    @property
    def listing(self) -> Listing:
        """The verdicts, the tables, and what the run has to say."""
        result = self.result
        what = "sweep" if self.run == SWEEP else f"response {self.run}"
        solved = int(result.solved.sum())
        head = f"{self.model.name}, {what}: {solved} of {result.rows} rows solved"
        rows = tuple(
            (table.name, table.title, str(len(table.columns)), _labels(table))
            for table in self.tables
        )
        notes = [str(one) for one in self.model.diagnostics]
        notes += [str(one) for one in result.diagnostics if str(one) not in notes]
        return Listing(head, ("table", "title", "columns", "labels"), rows, tuple(notes))

    def _repr_html_(self) -> str:
        listing = self.listing
        shown = self.tables[:SHOWN_TABLES]
        parts = [Listing(listing.head).html(), *map(_folded, shown)]
        if len(self.tables) > len(shown):
            others = listing.rows[len(shown) :]
            parts.append(html_table(listing.labels, others))
        return "".join([*parts, Listing("", notes=listing.notes).html() if listing.notes else ""])


def by_label(tables: Iterable[Columns]) -> dict[str, dict[str, NDArray[Any]]]:
    """The columns of tables by name and label; words as texts."""
    return {
        table.name: {
            c.label: c.values.array() if isinstance(c.values, Words) else c.values
            for c in table.columns
        }
        for table in tables
    }


def _components(text: str, values: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """The columns of a vector (rows, components), by the expressions that give them."""
    names = Vector(*values.T).component_texts(text)
    return dict(zip(names, values.T, strict=True))


def _table_frame(table: Columns, pandas: Any) -> Any:
    frame = pandas.DataFrame(
        {
            c.label: c.values.array() if isinstance(c.values, Words) else c.numbers
            for c in table.columns
        }
    )
    units = {column.label: column.unit for column in table.columns}
    frame.attrs |= {"units": units, "name": table.name, "title": table.title}
    return frame


def _labels(table: Columns) -> str:
    return ", ".join(column.label for column in table.columns)


def _folded(table: Columns) -> str:
    """A table of a notebook, opened by a click."""
    listing = table.listing
    head = Listing(listing.head).html().removeprefix("<div><p>").removesuffix("</p></div>")
    cells = html_table(listing.labels, shortened(listing.rows))
    return f"<details><summary>{head}</summary>{cells}</details>"


def _asked_again(
    model: Solvable, run: str, given: dict[str, Any], closed_at: Sequence[str] | None
) -> Analysis:
    """What a model answers once more."""
    if run != SWEEP:
        return model.run_free(run, **given)
    return model.analyze(closed_at=closed_at, **given)


def drawing_of(
    one: Analysis,
    y: Sequence[str] = (),
    x: str | None = None,
    table: str | None = None,
    places: PlotCurve | None = None,
) -> Drawing:
    """What the picture of some rows is made of; arguments and errors are those of `Analysis.plot`.
    With `places` they are a part of a run, which goes along them."""
    y = texts("y", y, '["O4.theta"]')
    if x is not None:
        a_text("x", x, '"O4.theta"')
    if table is not None:
        a_text("table", table, '"table_03"')
    if y:
        title = one.model.name if one.run == SWEEP else one.run
        return plots.drawing(one, title, y, x, places)
    known = {layout.name: number for number, layout in enumerate(one.layouts)}
    if not known:
        raise UsageError("there is no table to draw; name what to draw")
    name = next(iter(known)) if table is None else table
    if name not in known:
        tables = ", ".join(known)
        raise UsageError(f"there is no table {name[:LONGEST_NAME]}; tables are {tables}")
    number = known[name]
    return plots.table_drawing(one, one.layouts[number], one.tables[number], x, places)
