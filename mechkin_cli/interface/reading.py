"""How the results of a run are read as a mapping, shown, and handed to pandas."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.interface.arguments import texts
from mechkin_cli.listing import Listed, Listing, html_table
from mechkin_cli.runs import SWEEP
from mechkin_cli.tables.layout import ROW_NUMBERS, ROW_PROOF, row_texts

if TYPE_CHECKING:
    import numpy as np
    import pandas  # type: ignore[import-untyped]
    from numpy.typing import NDArray

    from mechkin_cli.analysis.sweep import Result
    from mechkin_cli.interface.model import Model
    from mechkin_cli.named import Named
    from mechkin_cli.tables.columns import Columns

SHOWN_TABLES = 3
"""Tables that a notebook shows opened or closed; the others are named."""


class Reading(Listed):
    """The names of what a run tells (`"O4.theta" in r`, `list(r)`, `len(r)`, `r.keys()`), its
    looks at the prompt and in notebooks, and `to_pandas`.

    Names are those of quantities, without their components; `r[...]` also takes any expression.
    """

    model: Model
    result: Result
    run: str

    @property
    def tables(self) -> Named[Columns]:
        """The tables that were asked for."""
        raise NotImplementedError

    def __getitem__(self, text: str) -> NDArray[Any]:
        raise NotImplementedError

    def unit(self, text: str) -> str:
        """The unit of a quantity or an expression, as tables write it."""
        raise NotImplementedError

    def keys(self) -> tuple[str, ...]:
        """Names of all quantities that this run tells, inputs first."""
        words = (name for name in row_texts(self.run) if name != ROW_PROOF)
        quantities = self.result.problem.quantities()
        return tuple(dict.fromkeys((*self.result.inputs, *quantities, *words, *ROW_NUMBERS)))

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def __contains__(self, name: object) -> bool:
        return name in self.keys()

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
            >>> r = load("mechanisms/rcsr.yaml").analyze()
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


def _components(text: str, values: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """The columns of a vector (rows, components), by the expressions that give them."""
    from mechkin_cli.tables.columns import component_text

    # a vector of a plane has no z
    return {component_text(text, axis): one for axis, one in zip("xyz", values.T, strict=False)}


def _table_frame(table: Columns, pandas: Any) -> Any:
    from mechkin_cli.tables.columns import Words

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
    from mechkin_cli.listing import MOST_ROWS
    from mechkin_cli.tables.columns import Words
    from mechkin_cli.tables.decimal_text import column_texts

    count = table.columns[0].rows
    half = MOST_ROWS // 2
    chosen = (
        list(range(count)) if count <= MOST_ROWS else [*range(half), *range(count - half, count)]
    )
    cells = [
        c.values.texts(range(len(chosen)))
        if isinstance(c.values, Words)
        else c.texts(column_texts(c.values, c.decimals))
        for c in (column.part(chosen) for column in table.columns)
    ]
    rows = list(zip(*cells, strict=True))
    if count > len(chosen):
        rows.insert(half, ("...",) * len(cells))
    labels = [f"{c.label} [{c.unit}]" if c.unit else c.label for c in table.columns]
    title = Listing(f"{table.name}: {table.title}" if table.title else table.name)
    head = title.html().removeprefix("<div><p>").removesuffix("</p></div>")
    return f"<details><summary>{head}</summary>{html_table(labels, rows)}</details>"
