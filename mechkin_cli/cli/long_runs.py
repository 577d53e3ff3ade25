"""What `mechkin analyze` does with runs whose rows are not held: each part of them is written
and summed up, and forgotten. A thread writes while the next part is solved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from queue import SimpleQueue
from threading import Semaphore, Thread
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.analysis import stream_run
from mechkin_cli.cli.messages import put, say
from mechkin_cli.cli.progress import clock
from mechkin_cli.cli.show import shown_ends, shown_summary, streamed_summary
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.kernel import _kernel
from mechkin_cli.mechanism import LongRun
from mechkin_cli.record import replace
from mechkin_cli.tables import (
    STREAM_FORMATS,
    Columns,
    CsvStyle,
    OutputFolder,
    RunningSummary,
    TableWriter,
    TextRoom,
    chosen,
    heading_of,
    joined_column,
    rows_table,
    stream_of,
    summary_table,
    write_table,
)
from mechkin_cli.tolerances import FREED_MEGABYTES, LONG_RUN
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from types import TracebackType

    from mechkin_cli.analysis import PartRows, Stream
    from mechkin_cli.cli.analyze_options import AnalyzeCommand
    from mechkin_cli.cli.progress import Tell
    from mechkin_cli.model import Model
    from mechkin_cli.tables import OutputFile, Summary, TableHeading, TableLayout

USUAL_WORDS = ("max", "min")
"""What is found of a table whose rows are not written, where it does not say."""


def streamed_runs(model: Model, command: AnalyzeCommand) -> list[str]:
    """The runs of the model whose rows are not held: they are not wanted, or many, and nothing is
    asked for that needs them all at once.

    Raises:
        UsageError: they are not to be written, but something that needs them is asked for.
    """
    needing = [
        option
        for option, given in (
            ("--certify", command.certify),
            ("--errors", command.errors),
            ("--view", command.view),
            ("--explain", command.explain),
            ("--json", command.json),
            *((f"--format {name}", name not in STREAM_FORMATS) for name in command.asked_formats),
        )
        if given
    ]
    if command.summary_only:
        if needing:
            raise UsageError(f"--summary-only keeps no rows, and {needing[0]} needs them")
        # equilibria are found at once, and are few
        return [run for run in _wanted_runs(model, command) if not _rests(model, run)]
    if needing or not command.asked_formats:
        return []
    return [run for run in _wanted_runs(model, command) if is_long(model, run)]


def _wanted_runs(model: Model, command: AnalyzeCommand) -> list[str]:
    """The runs that have a table which is wanted; all, where none is named."""
    if command.table is None:
        return list(model.runs)
    wanted = {table.run for table in chosen(tuple(model.tables), command.table)}
    wanted |= {SWEEP for _ in chosen(model.built.coefficients, command.table)}
    return [run for run in model.runs if run in wanted]


def _rests(model: Model, run: str) -> bool:
    return run != SWEEP and model.design.response(run).search is not None


def is_long(model: Model, run: str) -> bool:
    """Whether the rows of a run are many, and may be taken block by block."""
    if _rests(model, run):
        return False
    if run != SWEEP:
        rows = model.design.response(run).rows
        return rows > LONG_RUN and stream_run(model, run, None, 1, [], None, 0, 0).in_blocks
    return isinstance(model.problem.motion, LongRun)


class StreamedRun:
    """A run whose rows were not held: what is said of it afterwards."""

    def __init__(self, stream: Stream, tables: Sequence[_Table], *, summary_only: bool) -> None:
        self.stream = stream
        self.diagnostics = stream.diagnostics
        self._tables, self._summary_only = tables, summary_only

    def is_enough(self, *, strict: bool) -> bool:
        """Whether every row has a solution, and where that is asked for is `ok`."""
        return self.stream.complete and (self.stream.verdicts.sound or not strict)

    def report(self, file: str, folder: Path) -> None:
        """Prints the first and the last rows of the tables, and what stands below them."""
        for table in self._tables:
            put(table.shown(self.stream, folder, rows=not self._summary_only))
        for line in streamed_summary(file, self.stream):
            say(line)


def stream_to(
    model: Model, run: str, command: AnalyzeCommand, output: OutputFolder, tell: Tell
) -> StreamedRun:
    """Makes a run of a model, and writes its tables and the verdicts on its rows part by part.

    Raises:
        UsageError: a file cannot be written, or a quantity needs all rows at once.
    """
    _kernel.keep_freed_memory(FREED_MEGABYTES)
    packing = command.lanes, command.threads
    names = [each.name for each in chosen(tuple(model.tables), command.table) if each.run == run]
    wanted = None if command.table is None else names
    if wanted is not None and run == SWEEP and not command.summary_only:
        wanted += [one.name for one in chosen(model.built.coefficients, command.table)]
    if run != SWEEP:
        tell(f"integrating {run}")
    # of a response, with the verdicts on its rows
    measured = () if command.summary_only or run == SWEEP else ("row.energy_error",)
    stream = stream_run(model, run, measured, 1, wanted, command.mode, *packing)
    tables = [_Table(layout, command, stream) for layout in stream.layouts]
    style = CsvStyle(
        threads=command.threads, units=command.units, decimal_comma=command.decimal_comma
    )
    files = _Files(() if command.summary_only else command.formats, output, style)
    progress = _progress(tell, stream.run_rows)
    with files:
        for part, own in stream.parts():
            rows: list[tuple[Columns, Sequence[str]]] = [
                (table.add(part, own, place), ()) for place, table in enumerate(tables)
            ]
            if not command.summary_only:
                rows.append((_verdicts(part, own, run), ("row",)))
                files.write(rows)
            span = part.analysis.result.row_states.span
            progress(span.first + span.rows)
            del part, rows
    others = [] if command.summary_only else [*stream.coefficients]
    others += stream.balance_tables
    if not command.summary_only and stream.impacts is not None:
        others.append(stream.impacts)
    for table in tables:
        summary = table.summary(stream)
        if summary is not None:
            others.append(summary_table(table.layout.name, table.layout.title, summary))
    for other in others:
        for name in command.formats:
            with output.begin(f"{other.name}.{name}") as file:
                write_table(stream_of(other), name, file, style)
    return StreamedRun(stream, tables, summary_only=command.summary_only)


def _progress(tell: Tell, rows: int) -> Callable[[int], None]:
    """Tells how many rows are done, how fast, and how long the others take."""
    begun = monotonic()

    def told(done: int) -> None:
        seconds = monotonic() - begun
        rate = done / seconds if seconds > 0.0 else 0.0
        left = f", {rate:,.0f} a second, {clock((rows - done) / rate)} left" if rate else ""
        tell(f"{done:,} of {rows:,} rows{left}")

    return told


def _verdicts(part: PartRows, own: slice, run: str) -> Columns:
    """The part's own rows of the table of verdicts."""
    result = part.analysis.result
    table = rows_table(result, run)
    first, *others = (column.between(own) for column in table.columns)
    numbers = first.with_values(np.asarray(first.values) + result.row_states.span.first)
    return Columns(table.name, table.title, (numbers, *others))


class _Files:
    """The files of some tables in some formats, which are begun with their first rows.

    A thread writes them in the order in which they are given, while the caller solves the rows of
    the next part; it waits where those before are not written yet, so that two parts are held.
    """

    def __init__(self, formats: Sequence[str], output: OutputFolder, style: CsvStyle) -> None:
        self._formats, self._output, self._style = formats, output, style
        self._room = TextRoom()
        self._writers: dict[str, list[tuple[TableWriter, OutputFile]]] = {}
        self._waiting: SimpleQueue[list[tuple[Columns, Sequence[str]]] | None] = SimpleQueue()
        self._free = Semaphore(1)
        self._error: BaseException | None = None
        # an interrupt ends the process without it
        self._thread = Thread(target=self._write_all, name="tables", daemon=True)

    def write(self, tables: list[tuple[Columns, Sequence[str]]]) -> None:
        """Adds rows of a part to the files of tables; columns of the labels beside a table hold
        whole numbers.

        Raises:
            UsageError: a file cannot be written, now or of the part before.
        """
        self._free.acquire()
        if self._error is not None:
            raise self._error
        if not self._thread.ident:
            self._thread.start()
        self._waiting.put(tables)

    def _write_all(self) -> None:
        while (tables := self._waiting.get()) is not None:
            try:
                for table, whole in tables if self._error is None else ():
                    self._write(table, whole)
            except BaseException as error:  # raised where rows are given
                self._error = error
            del tables
            self._free.release()

    def _write(self, table: Columns, whole: Sequence[str]) -> None:
        if table.name not in self._writers:
            heading = heading_of(table, whole)
            self._writers[table.name] = [self._begun(heading, name) for name in self._formats]
        for writer, _ in self._writers[table.name]:
            writer.write(table.columns)

    def _begun(self, heading: TableHeading, format: str) -> tuple[TableWriter, OutputFile]:
        file = self._output.begin(f"{heading.name}.{format}")
        return TableWriter(heading, format, file, self._style, self._room), file

    def __enter__(self) -> _Files:
        """The files, to be ended or dropped together."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._thread.ident:
            self._waiting.put(None)
            self._thread.join()
        failed = self._error if kind is None else None
        if failed is not None:
            kind, error, trace = type(failed), failed, failed.__traceback__
        begun = [each for writers in self._writers.values() for each in writers]
        try:
            for writer, _ in () if kind is not None else begun:
                writer.end()
        finally:
            for _, file in begun:
                file.__exit__(kind, error, trace)
        if failed is not None:
            raise failed


ENDS = 30
"""Rows at the beginning of a table, and as many at its end, that are printed."""


class _Table:
    """A table while its rows pass by: its sums, its first and its last rows."""

    def __init__(self, layout: TableLayout, command: AnalyzeCommand, stream: Stream) -> None:
        self.layout, self._stream, self._labels = layout, stream, command.columns
        words = layout.summary or (USUAL_WORDS if command.summary_only else ())
        self._sums: RunningSummary | None = None
        if words:
            self._sums = RunningSummary(words, layout.columns, stream.along, stream.inputs)
        self._shows_rows = not command.summary_only
        self._first: Columns | None = None
        self._last: Columns | None = None

    def add(self, part: PartRows, own: slice, place: int) -> Columns:
        """The part's own rows of the table."""
        numbers = range(len(self.layout.columns))
        columns = tuple(part.column(place, number).between(own) for number in numbers)
        if self._sums is not None:
            self._sums.add(columns, self._stream.places(part)[own])
        table = Columns(self.layout.name, self.layout.title, columns)
        table = table if self._labels is None else table.chosen(self._labels)
        if not self._shows_rows:
            return table
        if self._first is None:
            self._first = _copied(table, slice(0, ENDS))
        self._last = _last_of(self._last, _copied(table, slice(-ENDS, None)))
        return table

    def shown(self, stream: Stream, folder: Path, *, rows: bool) -> str:
        """The first rows of the table and the last ones, and what stands below it, as text."""
        summary = self.summary(stream)
        if not rows:
            if summary is None:
                return ""
            return shown_summary(self.layout.name, self.layout.title, summary)
        assert self._first is not None
        assert self._last is not None
        last = replace(self._last, summary=summary)
        return shown_ends(self._first, last, stream.run_rows, folder)

    def summary(self, stream: Stream) -> Summary | None:
        """What stands below the table."""
        if self._sums is None:
            return None
        found = self._sums.found(stream.run_rows, stream.verdicts.counts)
        if self._labels is None:
            return found
        own = [
            label for label in self._labels if label in {each.label for each in self.layout.columns}
        ]
        columns = {column.label: column for column in found.columns}
        below = [columns[one]._replace(number=k) for k, one in enumerate(own) if one in columns]
        return found._replace(columns=tuple(below)) if below else None


def _copied(table: Columns, rows: slice) -> Columns:
    """Some rows of a table, apart from the others, which may be forgotten."""
    chosen_rows = np.arange(table.columns[0].rows)[rows]
    return replace(table, columns=tuple(column.part(chosen_rows) for column in table.columns))


def _last_of(before: Columns | None, behind: Columns) -> Columns:
    """The last rows of a table, of which the last part may have few."""
    if before is None:
        return behind
    both = zip(before.columns, behind.columns, strict=True)
    joined = replace(behind, columns=tuple(joined_column(pair) for pair in both))
    return _copied(joined, slice(-ENDS, None))
