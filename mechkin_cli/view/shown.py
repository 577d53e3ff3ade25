"""What a page shows: runs, their branches, and what it reads of `model.Analysis`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.sweep import Result
    from mechkin_cli.tables import Columns


class Readable(Protocol):
    """An analysis."""

    @property
    def run(self) -> str:
        """`sweep`, or the name of a response."""

    @property
    def rows(self) -> int:
        """Number of rows."""

    @property
    def result(self) -> Result:
        """States and verdicts of all rows."""

    @property
    def tables(self) -> tuple[Columns, ...]:
        """The tables of the run, evaluated in the file's units."""

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything that the run has to say."""

    def __getitem__(self, text: str) -> NDArray[Any]:
        """A quantity in the file's units, (rows,), or (rows, 3) of a vector."""


class ShownBranch(NamedTuple):
    """A run in one assembly mode; `forces`: whether arrows of forces may be read."""

    name: str
    analysis: Readable
    forces: bool = True


class ShownRun(NamedTuple):
    """A run of the file with its branches, the file's own one first, and its other tables."""

    name: str
    title: str
    branches: tuple[ShownBranch, ...]
    tables: tuple[Columns, ...] = ()
