"""The results of a run, as writers take them."""

from __future__ import annotations

from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.columns import TableSource
from mechkin_cli.tables.csv import CsvStyle
from mechkin_cli.tables.errors import ColumnErrors
from mechkin_cli.tables.table import Columns
from mechkin_cli.verdict import SWEEP


class Results(NamedTuple):
    """The results of one run of a mechanism.

    Attributes:
        threads: that write; 0: as many as a table is worth.
        errors: of all columns; None where they were not asked for.
        units: whether headers of CSV have them.
        decimal_comma: whether numbers of CSV, Markdown and LaTeX have a comma, and semicolons part
            the cells of CSV.
        impacts: of a response; None without any.
    """

    name: str
    tables: tuple[Columns, ...]
    source: TableSource
    diagnostics: tuple[Diagnostic, ...] = ()
    threads: int = 0
    run: str = SWEEP
    errors: tuple[ColumnErrors, ...] | None = None
    units: bool = False
    decimal_comma: bool = False
    impacts: Columns | None = None

    @property
    def style(self) -> CsvStyle:
        """How its tables stand in CSV."""
        return CsvStyle(threads=self.threads, units=self.units, decimal_comma=self.decimal_comma)
