"""The formats of results: a name, as `--format` takes it, and what makes the files.

A new format is a function here and its line in `WRITERS`; the command's help and the checks read
the table.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.diagnostics import Diagnostic
    from mechkin_cli.tables.columns import Columns
    from mechkin_cli.tables.source import Source


class Results(NamedTuple):
    """What there is to write of one analysis; `threads` 0: as many as a table is worth."""

    name: str
    tables: tuple[Columns, ...]
    source: Source
    diagnostics: tuple[Diagnostic, ...] = ()
    threads: int = 0


File = tuple[str, bytes]
"""A file's name and content."""


def _csv(results: Results) -> Iterator[File]:
    from mechkin_cli.tables.csv_writer import csv_bytes

    for table in results.tables:
        yield f"{table.name}.csv", csv_bytes(table, threads=results.threads)


def _markdown(results: Results) -> Iterator[File]:
    from mechkin_cli.tables.markdown import markdown_bytes

    for table in results.tables:
        yield f"{table.name}.md", markdown_bytes(table, results.source, results.threads)


def _json(results: Results) -> Iterator[File]:
    from mechkin_cli.tables.json_writer import analysis_record, json_bytes

    record = analysis_record(*results)
    yield "analysis.json", json_bytes(record)


WRITERS: Mapping[str, Callable[[Results], Iterator[File]]] = {
    "csv": _csv,
    "md": _markdown,
    "json": _json,
}
"""Format -> its files, in the order that help and messages list them."""

USUAL_FORMATS = ("csv", "md")


def written_files(results: Results, formats: Iterable[str]) -> dict[str, bytes]:
    """All files of the formats by name, and `rows.csv`."""
    from mechkin_cli.tables.csv_writer import csv_bytes
    from mechkin_cli.tables.rows_table import rows_table

    files = dict(file for name in formats for file in WRITERS[name](results))
    files["rows.csv"] = csv_bytes(rows_table(results.source), threads=results.threads)
    return files
