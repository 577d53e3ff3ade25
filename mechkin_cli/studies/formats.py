"""A study's records, a line for each variant or row, and their files: CSV, or Parquet (extra).

Pieces are written as they are computed, and put together at the end: bytes of the result do not
depend on the pieces.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, Protocol, TypeAlias

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import (
    ArrowTable,
    Columns,
    Heading,
    TableColumn,
    Words,
    column_of_numbers,
    csv_bytes,
    parquet_blocks,
    parquet_bytes,
    pyarrow_for,
    words_of,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats


Values: TypeAlias = "NDArray[np.float64] | NDArray[np.int64] | NDArray[np.object_]"
"""Numbers (lines,), nan where there is none; whole numbers; or texts."""


Records = dict[str, Values]
"""Columns by label."""


def joined(pieces: Sequence[Records]) -> Records:
    """Records one below the other."""
    if len(pieces) == 1:
        return pieces[0]
    return {label: np.concatenate([piece[label] for piece in pieces]) for label in pieces[0]}


class GatheredRecords:
    """Records of a study's tables from stretches of its variants, in whatever order they come:
    columns of a line for each variant are filled, so that nothing is held twice.

    Args:
        variants: how many.
        lines: the table that has a line for each.
    """

    def __init__(self, variants: int, lines: str) -> None:
        self._variants, self._lines = variants, lines
        self._whole: Records = {}
        self._parts: dict[str, dict[int, Records]] = {}

    def put(self, begin: int, end: int, tables: Mapping[str, Records]) -> None:
        """The records of variants `begin` to `end` (without it)."""
        for name, records in tables.items():
            if name != self._lines:
                self._parts.setdefault(name, {})[begin] = records
                continue
            for label, values in records.items():
                if label not in self._whole:
                    own: Any = np.empty(self._variants, dtype=values.dtype)
                    self._whole[label] = own
                self._whole[label][begin:end] = values

    def tables(self) -> dict[str, Records]:
        """All of them, by name of table."""
        parts = {name: [one[k] for k in sorted(one)] for name, one in self._parts.items()}
        return {self._lines: self._whole} | {name: joined(each) for name, each in parts.items()}


def empty_values(kind: str, count: int) -> Values:
    """A column without any value."""
    if kind == "text":
        return np.full(count, "", dtype=object)
    return np.zeros(count, dtype=np.int64) if kind == "whole" else np.full(count, np.nan)


def numbers(values: Values) -> Floats:
    """A column of numbers or whole numbers as doubles."""
    return np.asarray(values, dtype=np.float64)


LINES_AT_ONCE = 65536
"""Lines that are held while a file is read."""


class Format(Protocol):
    """A kind of file."""

    ending: str

    def piece(self, headings: Sequence[Heading], records: Records) -> bytes:
        """A file of its own of some lines."""

    def read(self, path: Path, headings: Sequence[Heading]) -> Iterator[Records]:
        """The lines of a file, so many at a time that memory does not grow with it.

        Raises:
            ValueError: it is not what was written.
        """

    def join(self, pieces: Iterable[Path], headings: Sequence[Heading], file: BinaryIO) -> None:
        """Writes all pieces, one below the other, as one file."""


class Csv:
    """RFC 4180 with LF line ends and the shortest digits that read back as the same double."""

    ending = "csv"

    def piece(self, headings: Sequence[Heading], records: Records) -> bytes:
        """As `Format.piece`."""
        return csv_bytes(Columns("study", "", _columns(headings, records)))

    def read(self, path: Path, headings: Sequence[Heading]) -> Iterator[Records]:
        """As `Format.read`."""
        with path.open(encoding="utf-8", newline="") as stream:
            reader = csv.reader(stream)
            next(reader, None)
            while lines := list(islice(reader, LINES_AT_ONCE)):
                if any(len(line) != len(headings) for line in lines):
                    raise ValueError(f"a line has not the {len(headings)} cells of the others")
                cells = zip(*lines, strict=True)
                yield {h.label: _read(h.kind, c) for h, c in zip(headings, cells, strict=True)}

    def join(self, pieces: Iterable[Path], headings: Sequence[Heading], file: BinaryIO) -> None:
        """As `Format.join`."""
        header = self.piece(headings, {h.label: np.empty(0) for h in headings})
        file.write(header)
        for path in pieces:
            with path.open("rb") as stream:
                stream.seek(len(header))
                while block := stream.read(1 << 20):
                    file.write(block)


def _read(kind: str, cells: Sequence[str]) -> Any:
    if kind == "text":
        return np.array([cell.removeprefix("'") for cell in cells], dtype=object)
    if kind == "whole":
        return np.array([int(float(cell)) for cell in cells], dtype=np.int64)
    return np.array([float(cell) if cell else np.nan for cell in cells], dtype=np.float64)


def _columns(headings: Sequence[Heading], records: Records) -> tuple[TableColumn, ...]:
    return tuple(
        TableColumn(h.label, h.unit, words_of(records[h.label].tolist()))
        if h.kind == "text"
        else column_of_numbers(h.label, h.unit, np.asarray(records[h.label], dtype=np.float64))
        for h in headings
    )


class Parquet:
    """Apache Parquet, as runs are written; texts are not coded, as they are not known before."""

    ending = "parquet"

    def __init__(self) -> None:
        pyarrow_for("Parquet")

    def piece(self, headings: Sequence[Heading], records: Records) -> bytes:
        """As `Format.piece`."""
        return parquet_bytes(headings, _columns(headings, records))

    def read(self, path: Path, headings: Sequence[Heading]) -> Iterator[Records]:
        """As `Format.read`."""
        for block in parquet_blocks(path, headings, LINES_AT_ONCE):
            yield {h.label: _values(h.kind, c) for h, c in zip(headings, block, strict=True)}

    def join(self, pieces: Iterable[Path], headings: Sequence[Heading], file: BinaryIO) -> None:
        """As `Format.join`."""
        table = ArrowTable("parquet", headings, file)
        for path in pieces:
            for block in parquet_blocks(path, headings, LINES_AT_ONCE):
                table.write(block)
        table.end()


def _values(kind: str, column: TableColumn) -> Values:
    if isinstance(column.values, Words):
        return np.array(column.values.words, dtype=object)[column.values.codes]
    return column.values.astype(np.int64) if kind == "whole" else column.values


_FORMATS: dict[str, type[Csv] | type[Parquet]] = {"csv": Csv, "parquet": Parquet}
FORMATS = tuple(_FORMATS)


def format_of(name: str) -> Format:
    """The format of a name.

    Raises:
        UsageError: there is no such format, or what it needs is not installed.
    """
    if name not in _FORMATS:
        names = ", ".join(FORMATS)
        raise UsageError(f"there is no format {name[:60]} of studies; they are {names}")
    return _FORMATS[name]()
