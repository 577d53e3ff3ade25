"""Results of runs as files: a format is a name, as `--format` takes it, and what makes its files.

A new format is a function here and its line in `WRITERS`; the command's help and the checks read
the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mechkin_cli.tables.results import Results


File = tuple[str, bytes]
"""A file's name and content."""


def _csv(runs: Sequence[Results]) -> Iterator[File]:
    from mechkin_cli.tables.table import summary_table

    for results in runs:
        for table in results.tables:
            yield f"{table.name}.csv", results.csv(table)
            if table.summary is not None:
                below = summary_table(table.name, table.title, table.summary)
                yield f"{below.name}.csv", results.csv(below)


def _markdown(runs: Sequence[Results]) -> Iterator[File]:
    from mechkin_cli.tables.errors import worst_table
    from mechkin_cli.tables.markup import markdown_bytes

    for results in runs:
        written = list(results.tables)
        if results.errors is not None:
            written.append(worst_table(results.errors, results.run))
        for table in written:
            content = markdown_bytes(table, results.source, results.threads, results.decimal_comma)
            yield f"{table.name}.md", content


def _json(runs: Sequence[Results]) -> Iterator[File]:
    from mechkin_cli.tables.json import json_bytes, runs_record
    from mechkin_cli.verdict import versions

    yield "analysis.json", json_bytes(versions() | runs_record(runs))


def _latex(runs: Sequence[Results]) -> Iterator[File]:
    from mechkin_cli.tables.markup import latex_bytes

    for results in runs:
        for table in results.tables:
            yield f"{table.name}.tex", latex_bytes(table, results.source, results.decimal_comma)


def _workbook(runs: Sequence[Results]) -> Iterator[File]:
    from mechkin_cli.tables.workbook import workbook_bytes

    yield "analysis.xlsx", workbook_bytes(runs)


WRITERS: Mapping[str, Callable[[Sequence[Results]], Iterator[File]]] = {
    "csv": _csv,
    "md": _markdown,
    "json": _json,
    "tex": _latex,
    "xlsx": _workbook,
}
"""Format -> its files, in the order that help and messages list them."""

USUAL_FORMATS = ("csv", "md")


def written_files(runs: Sequence[Results], formats: Iterable[str]) -> dict[str, bytes]:
    """All files of the formats by name, and `rows.csv`, of a response `NAME.rows.csv` and, with
    impacts, `NAME.impacts.csv`; where errors were asked for, `errors.csv` and of a response
    `NAME.errors.csv`."""
    from mechkin_cli.tables.errors import cells_table
    from mechkin_cli.tables.markup import rows_table

    files = dict(file for name in formats for file in WRITERS[name](runs))
    for results in runs:
        details = [rows_table(results.source, results.run)]
        if results.impacts is not None:
            details.append(results.impacts)
        if results.errors is not None:
            details.append(cells_table(results.errors, results.run))
        files |= {f"{table.name}.csv": results.csv(table) for table in details}
    return files
