"""Apache Parquet, files of Arrow and zstd, by pyarrow: the one place that loads it.

A missing number is null, and what is infinite stays so. Units stand in the metadata of the fields.
Texts of which all are known are coded by a dictionary, others are texts. Groups of rows have the
same size whatever blocks they came in, so the bytes depend on the table alone (and on the version
of pyarrow).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.columns import TableColumn, Words
from mechkin_cli.tables.table import Heading, Sink
from mechkin_cli.tolerances import ROW_GROUP

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

NEEDS_PYARROW = "needs pyarrow: pip install 'mechkin[parquet]'"


def pyarrow_for(what: str) -> Any:
    """The library.

    Raises:
        UsageError: it is not installed.
    """
    try:
        import pyarrow
    except ImportError:
        raise UsageError(f"{what} {NEEDS_PYARROW}") from None
    return pyarrow


def zstd_packer(file: Sink) -> Any:
    """Packs what is written to it into a file, which stays open until the packer is closed."""
    arrow = pyarrow_for("zstd")
    return arrow.CompressedOutputStream(arrow.PythonFile(_KeptOpen(file), "w"), "zstd")


class _KeptOpen:
    """A file that pyarrow may write to, and not close."""

    closed = False

    def __init__(self, file: Sink) -> None:
        self.write, self.flush = file.write, file.flush

    def close(self) -> None:
        pass


class ArrowTable:
    """A table that is being written to a file, as Parquet (packed by zstd) or as a file of Arrow
    (not packed, so that it can be mapped into memory)."""

    def __init__(
        self,
        format: str,
        headings: Sequence[Heading],
        file: Sink,
        metadata: Mapping[str, str] | None = None,
    ) -> None:
        """Begins the file.

        Args:
            format: "parquet" or "arrow".
            headings: of the columns.
            file: it is written to, and stays open.
            metadata: of the whole table.

        Raises:
            UsageError: pyarrow is not installed.
        """
        self._arrow = pyarrow_for("Parquet" if format == "parquet" else "Arrow")
        fields = [self._field(heading) for heading in headings]
        self._schema = self._arrow.schema(fields, metadata=dict(metadata or {}) or None)
        self._columns = [_held_column(heading) for heading in headings]
        self._rows = 0
        begin = self._parquet if format == "parquet" else self._arrow_file
        self._writer = begin(headings, file)

    def write(self, block: Sequence[TableColumn]) -> None:
        """Adds rows."""
        rows, start = block[0].rows if block else 0, 0
        while start < rows:
            count = min(rows - start, ROW_GROUP - self._rows)
            for held, column in zip(self._columns, block, strict=True):
                held.take(column, start, self._rows, count)
            self._rows += count
            start += count
            if self._rows == ROW_GROUP:
                self._write_group()

    def end(self) -> None:
        """Writes the last rows and what stands at the end."""
        if self._rows:
            self._write_group()
        self._writer.close()

    def _write_group(self) -> None:
        arrays = [
            held.array(self._arrow, self._rows, field.type)
            for held, field in zip(self._columns, self._schema, strict=True)
        ]
        self._writer.write_batch(self._arrow.record_batch(arrays, schema=self._schema))
        self._rows = 0

    def _field(self, heading: Heading) -> Any:
        arrow = self._arrow
        kinds = {"number": arrow.float64(), "whole": arrow.int64(), "text": arrow.string()}
        kind = kinds[heading.kind]
        if heading.texts:
            kind = arrow.dictionary(arrow.int32(), kind)
        return arrow.field(
            heading.label, kind, metadata={"unit": heading.unit} if heading.unit else None
        )

    def _parquet(self, headings: Sequence[Heading], file: Sink) -> Any:
        from pyarrow import parquet

        # a dictionary of doubles is given up after a third of the time; bytes of the same place
        # side by side are packed to three quarters of the size
        return parquet.ParquetWriter(
            self._arrow.PythonFile(_KeptOpen(file), "w"),
            self._schema,
            compression="zstd",
            use_dictionary=[one.label for one in headings if one.kind == "text"],
            column_encoding={
                one.label: "BYTE_STREAM_SPLIT" for one in headings if one.kind == "number"
            }
            or None,
        )

    def _arrow_file(self, _: Sequence[Heading], file: Sink) -> Any:
        from pyarrow import ipc

        return ipc.new_file(self._arrow.PythonFile(_KeptOpen(file), "w"), self._schema)


class _Numbers:
    """Rows of a column of numbers, until there are enough for a group."""

    def __init__(self, is_whole: bool) -> None:
        self._held, self._is_whole = np.empty(ROW_GROUP), is_whole

    def take(self, column: TableColumn, start: int, at: int, count: int) -> None:
        values, unbounded = column.values, column.unbounded
        assert not isinstance(values, Words)
        held = self._held[at : at + count]
        held[:] = values[start : start + count]
        if unbounded is not None:
            infinite = unbounded[start : start + count]
            np.copyto(held, infinite, where=infinite != 0.0)

    def array(self, arrow: Any, rows: int, kind: Any) -> Any:
        held = self._held[:rows]
        missing: NDArray[np.bool_] | None = np.isnan(held)
        if missing is not None and missing.any():
            held[missing] = 0.0  # in place of bits that differ from machine to machine
        else:
            missing = None
        valid = None if missing is None else np.packbits(~missing, bitorder="little")
        return _array(arrow, kind, rows, valid, held.astype(np.int64) if self._is_whole else held)


class _KnownTexts:
    """Rows of a column of texts that are all known."""

    def __init__(self, texts: Sequence[str]) -> None:
        self._held = np.empty(ROW_GROUP, np.int32)
        self._texts = list(texts)

    def take(self, column: TableColumn, start: int, at: int, count: int) -> None:
        assert isinstance(column.values, Words)
        self._held[at : at + count] = column.values.codes[start : start + count]

    def array(self, arrow: Any, rows: int, kind: Any) -> Any:
        return _coded(arrow, self._held[:rows], self._texts, kind.value_type)


class _Texts:
    """Rows of a column of any texts."""

    def __init__(self) -> None:
        self._held = np.empty(ROW_GROUP, np.int32)
        self._places: dict[str, int] = {}

    def take(self, column: TableColumn, start: int, at: int, count: int) -> None:
        assert isinstance(column.values, Words)
        places, words = self._places, column.values.words
        codes = column.values.codes[start : start + count]
        known: NDArray[np.int32] = np.zeros(len(words), np.int32)
        for code in np.unique(codes).tolist():
            known[code] = places.setdefault(words[code], len(places))
        self._held[at : at + count] = known[codes]

    def array(self, arrow: Any, rows: int, kind: Any) -> Any:
        texts, self._places = list(self._places), {}
        return _coded(arrow, self._held[:rows], texts, kind).dictionary_decode()


def _array(arrow: Any, kind: Any, rows: int, *parts: NDArray[Any] | bytes | None) -> Any:
    """An array of the parts of its memory; what pyarrow makes of a list or an array of numpy begins
    with loading pandas, where that is installed."""
    buffers = [None if part is None else arrow.py_buffer(part) for part in parts]
    return arrow.Array.from_buffers(kind, rows, buffers)


def _coded(arrow: Any, codes: NDArray[np.int32], texts: Sequence[str], kind: Any) -> Any:
    """A text for each code."""
    words = [text.encode() for text in texts]
    ends = np.cumsum([0, *map(len, words)], dtype=np.int32)
    known = _array(arrow, kind, len(words), None, ends, b"".join(words))
    of_rows = _array(arrow, arrow.int32(), codes.size, None, codes)
    return arrow.DictionaryArray.from_arrays(of_rows, known)


def _held_column(heading: Heading) -> _Numbers | _KnownTexts | _Texts:
    if heading.kind != "text":
        return _Numbers(heading.kind == "whole")
    return _KnownTexts(heading.texts) if heading.texts else _Texts()


def parquet_bytes(
    headings: Sequence[Heading],
    block: Sequence[TableColumn],
    metadata: Mapping[str, str] | None = None,
) -> bytes:
    """A small table as a whole file of Parquet. Raises as `ArrowTable`."""
    file = BytesIO()
    table = ArrowTable("parquet", headings, file, metadata)
    table.write(block)
    table.end()
    return file.getvalue()


def parquet_blocks(
    path: Path, headings: Sequence[Heading], rows: int
) -> Iterator[tuple[TableColumn, ...]]:
    """The rows of a file of Parquet with these columns, `rows` of them at a time.

    Raises:
        ValueError: it is not what was written.
        UsageError: pyarrow is not installed.
    """
    pyarrow_for("Parquet")
    from pyarrow import parquet

    with parquet.ParquetFile(path) as file:
        for batch in file.iter_batches(batch_size=rows):
            yield tuple(
                TableColumn(one.label, one.unit, _values(one.kind, batch.column(one.label)))
                for one in headings
            )


def _values(kind: str, column: Any) -> NDArray[np.float64] | Words:
    if kind != "text":
        return np.asarray(column.to_numpy(zero_copy_only=False), dtype=np.float64)
    coded = column if hasattr(column, "dictionary") else column.dictionary_encode()
    codes = np.asarray(coded.indices.to_numpy(zero_copy_only=False), np.int32)
    return Words(codes, tuple(coded.dictionary.to_pylist()))
