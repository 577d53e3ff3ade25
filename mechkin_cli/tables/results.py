"""The results of one run, as the writers of files take them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.columns import TableSource
from mechkin_cli.tables.table import Columns
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.tables.errors import ColumnErrors


class Results(NamedTuple):
    """What there is to write of one run of a mechanism; `threads` 0: as many as a table is
    worth; `errors` of all columns, None where they were not asked for; `units` says that headers of
    CSV have them."""

    name: str
    tables: tuple[Columns, ...]
    source: TableSource
    diagnostics: tuple[Diagnostic, ...] = ()
    threads: int = 0
    run: str = SWEEP
    errors: tuple[ColumnErrors, ...] | None = None
    units: bool = False

    def csv(self, table: Columns) -> bytes:
        """A table of the run as CSV."""
        from mechkin_cli.tables.csv import csv_bytes

        return csv_bytes(table, threads=self.threads, units=self.units)
