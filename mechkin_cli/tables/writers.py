"""Results of runs as files: a format is a name, as `--format` takes it, and what makes its files.

A new format is a function here and its line in `WRITERS`; the command's help and the checks read
the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from mechkin_cli import tables
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.columns import Columns, TableSource
from mechkin_cli.verdict import SWEEP, versions

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.tables.errors import ColumnErrors


class Results(NamedTuple):
    """The results of one run of a mechanism.

    Attributes:
        threads: that write; 0: as many as a table is worth.
        errors: of all columns; None where they were not asked for.
        units: whether headers of CSV have them.
    """

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
        return tables.csv_bytes(table, threads=self.threads, units=self.units)


File = tuple[str, bytes]
"""A file's name and content."""


def _csv(runs: Sequence[Results]) -> Iterator[File]:
    for results in runs:
        for table in results.tables:
            yield f"{table.name}.csv", results.csv(table)
            if table.summary is not None:
                below = tables.summary_table(table.name, table.title, table.summary)
                yield f"{below.name}.csv", results.csv(below)


def _markdown(runs: Sequence[Results]) -> Iterator[File]:
    for results in runs:
        written = list(results.tables)
        if results.errors is not None:
            written.append(tables.worst_table(results.errors, results.run))
        for table in written:
            content = tables.markdown_bytes(table, results.source, results.threads)
            yield f"{table.name}.md", content


def _json(runs: Sequence[Results]) -> Iterator[File]:
    yield "analysis.json", tables.json_bytes(versions() | tables.runs_record(runs))


def _latex(runs: Sequence[Results]) -> Iterator[File]:
    for results in runs:
        for table in results.tables:
            yield f"{table.name}.tex", tables.latex_bytes(table, results.source)


WRITERS: Mapping[str, Callable[[Sequence[Results]], Iterator[File]]] = {
    "csv": _csv,
    "md": _markdown,
    "json": _json,
    "tex": _latex,
}
"""Format -> its files, in the order that help and messages list them."""

USUAL_FORMATS = ("csv", "md")


def written_files(runs: Sequence[Results], formats: Iterable[str]) -> dict[str, bytes]:
    """All files of the formats by name, and `rows.csv`, of a response `NAME.rows.csv`; where errors
    were asked for, `errors.csv` and of a response `NAME.errors.csv`."""
    files = dict(file for name in formats for file in WRITERS[name](runs))
    for results in runs:
        details = [tables.rows_table(results.source, results.run)]
        if results.errors is not None:
            details.append(tables.cells_table(results.errors, results.run))
        files |= {f"{table.name}.csv": results.csv(table) for table in details}
    return files
