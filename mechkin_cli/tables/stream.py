"""Tables as streams: a heading, and then blocks of rows, written as they come.

Memory is that of a block, and a file does not depend on how its rows were cut into blocks. A table
that is evaluated whole is a stream of one block. CSV and lines of JSON may be packed; Parquet and
Arrow are written by pyarrow (`tables/arrow.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import RawIOBase
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.tables.columns import TableColumn, Words, number_column
from mechkin_cli.tables.csv import (
    PLAIN_CSV,
    CsvStyle,
    TextRoom,
    csv_header,
    csv_lines,
    threads_for,
    word_column,
)
from mechkin_cli.tables.file_set import refused
from mechkin_cli.tables.folder import OutputFile
from mechkin_cli.tables.table import Columns, Heading, Sink
from mechkin_cli.tolerances import PACKED_PART

if TYPE_CHECKING:
    from mechkin_cli.tables.arrow import ArrowTable

Block = Sequence[TableColumn]
"""Some rows of all columns of a table, in their order."""


class TableHeading(NamedTuple):
    """What is known of a table before its rows: the stem of its files, its title, its columns."""

    name: str
    title: str
    columns: tuple[Heading, ...]


class TableStream(NamedTuple):
    """A table as a heading and the blocks of its rows."""

    heading: TableHeading
    blocks: Iterable[Block]


def stream_of(table: Columns, whole: Iterable[str] = ()) -> TableStream:
    """An evaluated table as a stream of one block; columns of the labels `whole` hold whole
    numbers."""
    return TableStream(heading_of(table, whole), (table.columns,))


def heading_of(table: Columns, whole: Iterable[str] = ()) -> TableHeading:
    """The heading of an evaluated table."""
    headings = []
    for column in table.columns:
        if isinstance(column.values, Words):
            texts = tuple(dict.fromkeys(column.values.words))
            headings.append(Heading(column.label, column.unit, "text", texts))
        else:
            kind = "whole" if column.label in whole else "number"
            headings.append(Heading(column.label, column.unit, kind))
    return TableHeading(table.name, table.title, tuple(headings))


class TableFile(Protocol):
    """A table that is being written."""

    def write(self, block: Block) -> None:
        """Adds rows."""

    def end(self) -> None:
        """Writes what stands at the end; the file itself stays open."""


class _CsvFile:
    def __init__(self, heading: TableHeading, file: Sink, style: CsvStyle, room: TextRoom) -> None:
        self._file, self._style, self._room = file, style, room
        file.write(csv_header(((one.label, one.unit) for one in heading.columns), style))

    def write(self, block: Block) -> None:
        for piece in csv_lines(block, self._room, self._style):
            self._file.write(piece)

    def end(self) -> None:
        pass


class _JsonLinesFile:
    """An object a row; null is an empty cell, and one that is infinite, as JSON has no word for it.
    Numbers end in `.0` where they are whole, since readers guess the kind of a column by its first
    rows; only columns of whole numbers have none."""

    def __init__(self, heading: TableHeading, file: Sink, style: CsvStyle, room: TextRoom) -> None:
        from mechkin_cli.tables.json import one_line_json

        self._file, self._room, self._threads = file, room, style.threads
        self._text = one_line_json
        self._keys = [one_line_json(one.label) for one in heading.columns]
        self._whole = [one.kind == "whole" for one in heading.columns]

    def write(self, block: Block) -> None:
        cells = [
            word_column(column.values, self._text)
            if isinstance(column.values, Words)
            else number_column(column.values)
            for column in block
        ]
        threads = threads_for(block, self._threads)

        def lines(first: int, memory: Any) -> tuple[int, list[tuple[int, int]]]:
            return _kernel.json_lines(self._keys, cells, first, memory, self._whole, threads)

        for piece in self._room.pieces(block[0].rows if block else 0, lines, threads):
            self._file.write(piece)

    def end(self) -> None:
        pass


def _parquet(heading: TableHeading, file: Sink, _: CsvStyle, __: TextRoom) -> ArrowTable:
    from mechkin_cli.tables.arrow import ArrowTable

    return ArrowTable("parquet", heading.columns, file, metadata_of(heading))


def _arrow(heading: TableHeading, file: Sink, _: CsvStyle, __: TextRoom) -> ArrowTable:
    from mechkin_cli.tables.arrow import ArrowTable

    return ArrowTable("arrow", heading.columns, file, metadata_of(heading))


def metadata_of(heading: TableHeading) -> dict[str, str]:
    """What Parquet and Arrow keep of a whole table: its name, its title, its units as JSON."""
    from mechkin_cli.tables.json import one_line_json

    units = {one.label: one.unit for one in heading.columns if one.unit}
    return {"name": heading.name, "title": heading.title, "units": one_line_json(units)}


_KINDS: Mapping[str, Callable[[TableHeading, Sink, CsvStyle, TextRoom], TableFile]] = {
    "csv": _CsvFile,
    "jsonl": _JsonLinesFile,
    "parquet": _parquet,
    "arrow": _arrow,
}
"""What stands before the point in the name of a format -> what begins a table."""

GZIP_LEVEL = 1
"""The next ones that pack digits better take two to six times as long, for a twentieth less."""


class _Packed:
    """What is written to it goes on packed, in parts of one size."""

    def __init__(self, packing: str, file: Sink) -> None:
        self._held = bytearray()
        if packing == "gz":
            from gzip import GzipFile

            # without a name and a date, so that the same table gives the same bytes
            self._packer: Any = GzipFile("", "wb", GZIP_LEVEL, file, mtime=0)
        else:
            from mechkin_cli.tables.arrow import zstd_packer

            self._packer = zstd_packer(file)

    def write(self, piece: bytes | memoryview) -> int:
        self._held += piece
        if len(self._held) >= PACKED_PART:
            whole = len(self._held) // PACKED_PART * PACKED_PART
            with memoryview(self._held) as held:
                for start in range(0, whole, PACKED_PART):
                    self._packer.write(held[start : start + PACKED_PART])
            del self._held[:whole]
        return len(piece)

    def end(self) -> None:
        if self._held:
            self._packer.write(bytes(self._held))
        self._packer.close()


class TableWriter:
    """Writes one table in one format, block by block; to be ended by `end`."""

    def __init__(
        self,
        heading: TableHeading,
        format: str,
        file: Sink,
        style: CsvStyle = PLAIN_CSV,
        room: TextRoom | None = None,
    ) -> None:
        """Begins the file.

        Args:
            heading: of the table.
            format: one of `writers.STREAM_FORMATS`: csv, jsonl, parquet or arrow; text may be
                packed, as csv.gz or csv.zst.
            file: it is written to, and stays open.
            style: of CSV; its threads write other text, too.
            room: what several tables of a run write their text into.

        Raises:
            UsageError: the format needs pyarrow, and it is not installed.
        """
        kind, _, packing = format.partition(".")
        self.rows = 0
        self._heading, self._file = heading, file
        self._room, self._gate = room or TextRoom(), _Gate(file)
        with self._writing():
            self._packed = _Packed(packing, self._gate) if packing else None
            target: Any = self._packed or self._gate
            self._table = _KINDS[kind](heading, target, style, self._room)

    def write(self, block: Block) -> None:
        """Adds rows.

        Raises:
            UsageError: the file of a run's folder cannot be written; the rows before are told.
            ValueError: the columns are not those of the heading.
        """
        columns = [
            _checked(one, column) for one, column in zip(self._heading.columns, block, strict=True)
        ]
        if columns and columns[0].rows:
            with self._writing():
                self._table.write(columns)
            self.rows += columns[0].rows
            if isinstance(self._file, OutputFile):
                self._file.rows = self.rows

    def end(self) -> None:
        """Writes what stands at the end.

        Raises:
            UsageError: as `write`.
        """
        with self._writing():
            self._table.end()
            if self._packed is not None:
                self._packed.end()

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Inside, the file is written to; an error counts the rows of the block under way, too."""
        self._room.rows_done = 0
        self._gate.is_open = True
        try:
            with refusal_of(self._file, lambda: self.rows + self._room.rows_done):
                yield
        finally:
            self._gate.is_open = False


class _Gate(RawIOBase):
    """A file that takes only what is written while its table is: what packs or frames a table that
    is dropped before its end would write that end into a file that failed or is closed."""

    def __init__(self, file: Sink) -> None:
        self._file, self.is_open = file, False

    def write(self, piece: Any) -> int:
        """Adds bytes, or drops what nobody asked for."""
        if not self.is_open:
            return memoryview(piece).nbytes
        return self._file.write(piece)

    def flush(self) -> None:
        """As `write`."""
        if self.is_open:
            self._file.flush()


@contextmanager
def refusal_of(file: Sink, rows: Callable[[], int | None] = lambda: None) -> Iterator[None]:
    """Inside, an error of the system is told of this file, if it is one of a run.

    Args:
        rows: that were written; None: it is no table.

    Raises:
        UsageError: in its place.
    """
    try:
        yield
    except OSError as error:
        if not isinstance(file, OutputFile):
            raise
        raise refused(file.target, error, rows()) from error


def write_table(
    stream: TableStream,
    format: str,
    file: Sink,
    style: CsvStyle = PLAIN_CSV,
    room: TextRoom | None = None,
) -> int:
    """Writes a stream to its end, as `TableWriter`; returns the number of its rows."""
    writer = TableWriter(stream.heading, format, file, style, room)
    for block in stream.blocks:
        writer.write(block)
    writer.end()
    return writer.rows


def _checked(heading: Heading, column: TableColumn) -> TableColumn:
    """The column with the texts that its heading has.

    Raises:
        ValueError: it is not the heading's, or has other texts.
    """
    is_text = isinstance(column.values, Words)
    if column.label != heading.label or is_text != (heading.kind == "text"):
        raise ValueError(f"a block has {column.label!r} where {heading.label!r} is due")
    if not isinstance(column.values, Words) or not heading.texts:
        return column
    words = column.values.words
    if words == heading.texts:
        return column
    places = {text: place for place, text in enumerate(heading.texts)}
    codes = np.array([places.get(word, -1) for word in words], np.int32)[column.values.codes]
    if (codes < 0).any():
        raise ValueError(f"a block of {heading.label!r} has a text that its heading has not")
    return replace(column, values=Words(codes, heading.texts))
