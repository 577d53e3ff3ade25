"""What other rooms read of an analysis, which is put together above them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.sweep.result import Result
    from mechkin_cli.tables import Columns, TableLayout


class HasName(Protocol):
    """A model, by its name."""

    @property
    def name(self) -> str:
        """The mechanism's name."""
        ...


class Readable(Protocol):
    """An analysis, as the rooms that read one know it."""

    @property
    def model(self) -> HasName:
        """Of the file."""
        ...

    @property
    def run(self) -> str:
        """`sweep`, or the name of a response."""
        ...

    @property
    def rows(self) -> int:
        """Number of rows."""
        ...

    @property
    def result(self) -> Result:
        """States and verdicts of all rows."""
        ...

    @property
    def layouts(self) -> tuple[TableLayout, ...]:
        """Layouts of the tables."""
        ...

    @property
    def tables(self) -> tuple[Columns, ...]:
        """The tables of the run, evaluated in the file's units."""
        ...

    @property
    def coefficients(self) -> tuple[Columns, ...]:
        """The tables of dense systems of reactions."""
        ...

    @property
    def balance_tables(self) -> tuple[Columns, ...]:
        """The balances of the run."""
        ...

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything that the run has to say."""
        ...

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity in the file's units, (rows,), or (rows, 3) of a vector."""
        ...
