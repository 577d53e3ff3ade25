"""Tables cut into blocks, and large ones of random numbers, for the tests of their streams."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence

import numpy as np

from mechkin_cli.tables import Columns
from mechkin_cli.tables.columns import TableColumn, Words, column_of_numbers
from mechkin_cli.tables.csv import CsvStyle
from mechkin_cli.tables.stream import TableStream, heading_of, write_table

WORDS = ("ok", "near-singular", "dead-centre", 'a "b", c;', "θ")


def cut(table: Columns, size: int) -> Iterator[Sequence[TableColumn]]:
    """The rows of a table in blocks of a size, the last one of the rest."""
    rows = table.columns[0].rows
    for start in range(0, rows, size):
        part = np.arange(start, min(rows, start + size))
        yield [column.part(part) for column in table.columns]


def written(
    table: Columns,
    format: str,
    size: int | None = None,
    style: CsvStyle = CsvStyle(),  # noqa: B008
    whole: Sequence[str] = (),
) -> bytes:
    """A table as a file, in one block or in blocks of a size."""
    blocks = [table.columns] if size is None else cut(table, size)
    file = io.BytesIO()
    rows = write_table(TableStream(heading_of(table, whole), blocks), format, file, style)
    assert rows == table.columns[0].rows
    return file.getvalue()


def random_table(rows: int, seed: int = 0) -> Columns:
    """A table of rows with numbers of all sizes, missing and infinite ones, and words."""
    random = np.random.default_rng(seed)
    usual = random.uniform(-1, 1, rows) * 10.0 ** random.integers(-9, 18, rows)
    any_bits = np.frombuffer(random.bytes(8 * rows), np.float64).copy()
    any_bits[~np.isfinite(any_bits)] = np.nan
    usual[random.integers(0, 9, rows) == 0] = np.nan
    infinite = np.where(random.integers(0, 99, rows) == 0, np.inf, usual)
    infinite[random.integers(0, 99, rows) == 0] = -np.inf
    zeros = np.where(random.integers(0, 2, rows) == 0, -0.0, random.integers(-9, 9, rows))
    return Columns(
        "random",
        "Random numbers",
        (
            TableColumn("row", "", np.arange(1.0, rows + 1)),
            TableColumn("O1.theta", "deg", usual),
            TableColumn("any, bits", "lbm*in/s^2", any_bits),
            column_of_numbers("infinite", "µm", infinite),
            TableColumn("zeros", "", zeros.astype(np.float64)),
            TableColumn("word", "", Words(random.integers(0, 5, rows).astype(np.int32), WORDS)),
        ),
    )
