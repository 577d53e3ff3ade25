"""Results of runs as files: a format is a name, as `--format` takes it, and what makes its files.

A new format is a function here and its line in `WRITERS`, or, where it takes blocks of rows, its
name in `STREAM_FORMATS`; the command's help and the checks read both.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from io import BytesIO
from typing import TYPE_CHECKING

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple

if TYPE_CHECKING:
    from mechkin_cli.tables.csv import CsvStyle
    from mechkin_cli.tables.results import Results
    from mechkin_cli.tables.stream import TableStream
    from mechkin_cli.tables.table import Columns, Sink


STREAM_FORMATS = (
    "csv",
    "jsonl",
    "parquet",
    "arrow",
    "csv.gz",
    "csv.zst",
    "jsonl.gz",
    "jsonl.zst",
)
"""Formats that take a table block by block (`tables/stream.py`): endings of their files, too."""


class Written(NamedTuple):
    """A table that is to be written: as a stream, in a format of these."""

    stream: TableStream
    format: str
    style: CsvStyle


File = tuple[str, "bytes | Written"]
"""A file's name and content."""


def _tables(format: str, runs: Sequence[Results]) -> Iterator[File]:
    """All tables and their summaries as streams."""
    from mechkin_cli.tables.table import summary_table

    for results in runs:
        for table in results.tables:
            yield _streamed(table, format, results)
            if table.summary is not None:
                below = summary_table(table.name, table.title, table.summary)
                yield _streamed(below, format, results)


def _streamed(table: Columns, format: str, results: Results, *whole: str) -> File:
    from mechkin_cli.tables.stream import stream_of

    content = Written(stream_of(table, whole), format, results.style)
    return f"{table.name}.{format}", content


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
    "csv": partial(_tables, "csv"),
    "md": _markdown,
    "json": _json,
    "tex": _latex,
    "xlsx": _workbook,
    **{name: partial(_tables, name) for name in STREAM_FORMATS if name != "csv"},
}
"""Format -> its files, in the order that help and messages list them."""

USUAL_FORMATS = ("csv", "md")


NEEDS: Mapping[str, tuple[str, str]] = {
    "xlsx": ("openpyxl", "xlsx"),
    **dict.fromkeys(("parquet", "arrow", "csv.zst", "jsonl.zst"), ("pyarrow", "parquet")),
}
"""Format -> the library that writes it, and the extra that installs it."""


def refuse_without_library(formats: Iterable[str]) -> None:
    """For before anything is computed.

    Raises:
        UsageError: a format needs a library that is not installed.
    """
    from importlib.util import find_spec

    for name in formats:
        library, extra = NEEDS.get(name, ("", ""))
        if library and find_spec(library) is None:
            raise UsageError(f"--format {name} needs {library}: pip install 'mechkin[{extra}]'")


def write_results(
    runs: Sequence[Results], formats: Iterable[str], begin: Callable[[str], Sink]
) -> None:
    """Writes all files of the formats, and `rows`, of a response `NAME.rows` and, with impacts,
    `NAME.impacts`; where errors were asked for, `errors` and of a response `NAME.errors`. These are
    in the formats that take streams, in CSV where there is none of them.

    Args:
        begin: opens the file of a name.

    Raises:
        UsageError: a format needs a library that is not installed, or a file cannot be written.
    """
    from mechkin_cli.tables.csv import TextRoom
    from mechkin_cli.tables.stream import refusal_of, write_table

    room = TextRoom()
    for name, content in _files(runs, tuple(formats)):
        with begin(name) as file:
            if isinstance(content, bytes):
                with refusal_of(file):
                    file.write(content)
            else:
                write_table(content.stream, content.format, file, content.style, room)


def _files(runs: Sequence[Results], formats: tuple[str, ...]) -> Iterator[File]:
    for name in formats:
        yield from WRITERS[name](runs)
    for name in [name for name in formats if name in STREAM_FORMATS] or ["csv"]:
        for results in runs:
            yield from _details(name, results)


def _details(format: str, results: Results) -> Iterator[File]:
    from mechkin_cli.tables.errors import cells_table
    from mechkin_cli.tables.markup import rows_table

    yield _streamed(rows_table(results.source, results.run), format, results, "row")
    if results.impacts is not None:
        yield _streamed(results.impacts, format, results)
    if results.errors is not None:
        yield _streamed(cells_table(results.errors, results.run), format, results, "row", "digits")


def written_files(runs: Sequence[Results], formats: Iterable[str]) -> dict[str, bytes]:
    """The files of `write_results` by name."""
    files: dict[str, _InMemory] = {}
    write_results(runs, formats, lambda name: files.setdefault(name, _InMemory()))
    return {name: file.content for name, file in files.items()}


class _InMemory(BytesIO):
    """A file whose content stays when it is closed."""

    content = b""

    def close(self) -> None:
        """Ends it."""
        self.content = self.content or self.getvalue()
        super().close()
