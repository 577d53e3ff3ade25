"""Streams of tables: a file does not depend on the blocks that its rows come in."""

from __future__ import annotations

import gzip
import io
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from references import FILE_OF
from tables.streamed import WORDS, cut, random_table, written

import mechkin_cli as mk
from mechkin_cli.record import replace
from mechkin_cli.tables import Columns, heading_of
from mechkin_cli.tables.columns import TableColumn, Words
from mechkin_cli.tables.csv import CsvStyle, csv_bytes
from mechkin_cli.tables.markup import rows_table
from mechkin_cli.tables.stream import TableStream, TableWriter, write_table
from mechkin_cli.tables.writers import STREAM_FORMATS
from mechkin_cli.tolerances import PACKED_PART, ROW_GROUP

SIZES = (1, 7, 4096)


@pytest.mark.parametrize("stem", FILE_OF)
def test_all_tables_of_a_kept_mechanism(stem: str) -> None:
    pytest.importorskip("pyarrow")
    for analysis in mk.load(FILE_OF[stem]).analyses():
        rows = rows_table(analysis.result, analysis.run)
        for table in (*analysis.tables, *analysis.coefficients, rows):
            is_long = table.columns[0].rows > 400
            for name in ("csv", "jsonl", "parquet", "arrow"):
                whole = written(table, name)
                if name == "csv":
                    assert whole == csv_bytes(table)
                for size in SIZES[is_long:]:
                    for threads in (1, 2):
                        style = CsvStyle(threads=threads)
                        assert written(table, name, size, style) == whole, (table.name, name, size)


LARGE = random_table(2 * ROW_GROUP + 777)


@pytest.mark.parametrize("name", STREAM_FORMATS)
@pytest.mark.parametrize("threads", [1, 2])
def test_tables_of_several_groups(name: str, threads: int) -> None:
    """Blocks smaller and larger than a group of Parquet, and than what is packed at once."""
    pytest.importorskip("pyarrow")
    style = CsvStyle(threads=threads)
    whole = written(LARGE, name, style=CsvStyle(threads=1), whole=["row"])
    for size in (777, ROW_GROUP - 1, ROW_GROUP, ROW_GROUP + 1):
        assert written(LARGE, name, size, style, whole=["row"]) == whole


@pytest.mark.parametrize(
    "style",
    [
        CsvStyle(units=True),
        CsvStyle(decimal_comma=True),
        CsvStyle(decimal_comma=True, units=True, threads=2),
        CsvStyle(significant_digits=12),
    ],
)
def test_styles_of_csv(style: CsvStyle) -> None:
    table = random_table(3000, seed=1)
    whole = csv_bytes(table, style.significant_digits, 1, style.units, style.decimal_comma)
    for size in SIZES:
        assert written(table, "csv", size, style) == whole


def test_a_single_column_keeps_its_empty_rows_in_every_block() -> None:
    table = Columns("t", "", (TableColumn("x", "", np.array([np.nan, 1.0, np.nan])),))
    for size in SIZES:
        assert written(table, "csv", size) == b'x\n""\n1\n""\n'


@pytest.mark.parametrize("name", STREAM_FORMATS)
def test_a_table_without_rows_has_its_columns(name: str) -> None:
    pytest.importorskip("pyarrow")
    empty = Columns("t", "", tuple(column.part([]) for column in LARGE.columns))
    assert written(empty, name) == written(empty, name, 7)  # one block without rows, and no block


def test_pandas_is_not_loaded_for_frames(tmp_path: Path) -> None:
    """It takes 45 MB, half of what a long run may hold beside its rows."""
    pytest.importorskip("pyarrow")
    pytest.importorskip("pandas")
    code = (
        "import sys; from mechkin_cli.__main__ import main\n"
        "sys.argv = ['mechkin', *sys.argv[1:]]\n"
        "try: main()\n"
        "except SystemExit as ended: print(ended.code, 'pandas' in sys.modules)"
    )
    words = ["analyze", str(FILE_OF["rcsr"]), "--format", "parquet,arrow", "--quiet"]
    command = [sys.executable, "-P", "-c", code, *words, "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.split()[-1] == "False"
    assert (tmp_path / "rows.parquet").exists()
    assert (tmp_path / "rows.arrow").exists()


@pytest.mark.parametrize("name", ["parquet", "arrow"])
def test_missing_numbers_have_no_bits_of_their_own(name: str) -> None:
    """Which not-a-number a machine computes differs in sign and payload."""
    pytest.importorskip("pyarrow")
    files = set()
    for nan in (0x7FF8000000000000, 0xFFF8000000000000, 0x7FF8000000000123):
        values = np.array([1.5, 0.0, -2.5])
        values[1:2] = np.array([nan], np.uint64).view(np.float64)
        files.add(written(Columns("t", "", (TableColumn("x", "", values),)), name))
    assert len(files) == 1


def test_lines_of_json_are_the_rows() -> None:
    table = random_table(2000, seed=2)
    texts = written(table, "jsonl", 300, whole=["row"]).decode().splitlines()
    assert len(texts) == 2000
    for row, text in enumerate(texts):
        read = json.loads(text, parse_constant=lambda word: pytest.fail(word))
        assert list(read) == [column.label for column in table.columns]
        for column in table.columns:
            found = read[column.label]
            if isinstance(column.values, Words):
                assert found == column.values.words[column.values.codes[row]]
            elif math.isfinite(column.numbers[row]):
                assert found == column.numbers[row]
                assert type(found) is (int if column.label == "row" else float)
            else:
                assert found is None


def test_packed_text_is_the_text() -> None:
    arrow = pytest.importorskip("pyarrow")
    for name in ("csv", "jsonl"):
        plain = written(LARGE, name)
        assert len(plain) > 3 * PACKED_PART
        assert gzip.decompress(written(LARGE, f"{name}.gz", 4096)) == plain
        packed = arrow.BufferReader(written(LARGE, f"{name}.zst", 4096))
        assert arrow.CompressedInputStream(packed, "zstd").read() == plain


def test_gzip_says_neither_when_nor_where() -> None:
    head = written(random_table(3), "csv.gz")[:10]
    assert head[3:8] == bytes(5)  # no name, no date


# What is not as the heading says.


def test_blocks_with_other_texts_are_recoded() -> None:
    """As blocks may list the texts that they have alone, in an order of their own."""
    table = random_table(500, seed=3)
    word = table.columns[-1]
    assert isinstance(word.values, Words)
    blocks = []
    for block in cut(table, 50):
        texts = np.array(WORDS)[block[-1].values.codes]  # type: ignore[union-attr]
        own, codes = np.unique(texts, return_inverse=True)
        other = replace(word, values=Words(codes.astype(np.int32), tuple(own.tolist())))
        blocks.append([*block[:-1], other])
    for name in ("csv", "jsonl", "parquet", "arrow"):
        pytest.importorskip("pyarrow")
        file = io.BytesIO()
        write_table(TableStream(heading_of(table), blocks), name, file)
        assert file.getvalue() == written(table, name)


def test_a_block_that_is_not_the_headings_is_refused() -> None:
    table = random_table(5)
    columns = table.columns
    wrong = [
        (columns[:-1], "shorter"),
        ((*columns[1:], columns[0]), "is due"),
        ((*columns[:-1], replace(columns[0], label="word")), "is due"),
        (
            (*columns[:-1], replace(columns[-1], values=Words(np.zeros(5, np.int32), ("new",)))),
            "its heading has not",
        ),
    ]
    for block, words in wrong:
        writer = TableWriter(heading_of(table), "csv", io.BytesIO())
        with pytest.raises(ValueError, match=words):
            writer.write(block)


# Read back by others: numbers bit by bit, words, units.


def bits(values: object) -> list[str]:
    return [float(x).hex() if x is not None else "none" for x in values]  # type: ignore[attr-defined]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("pyarrow")
    place = tmp_path_factory.mktemp("streams")
    for name in STREAM_FORMATS:
        (place / f"t.{name}").write_bytes(written(READ, name, 5000, whole=["row"]))
    return place


READ = random_table(ROW_GROUP + 3000, seed=4)


def expected(column: TableColumn, keeps_infinite: bool, signed: bool) -> list[str]:
    """What a reader should find: nothing where there is no number, which is not -0 in text."""
    if isinstance(column.values, Words):
        return column.values.texts(range(column.rows))
    numbers = column.numbers if keeps_infinite else np.asarray(column.values)
    numbers = numbers if signed else numbers + 0.0
    return ["none" if math.isnan(x) else x.hex() for x in numbers.tolist()]


def compare(frame: dict[str, list[object]], *, infinite: bool = True, signed: bool = True) -> None:
    assert list(frame) == [column.label for column in READ.columns]
    for column in READ.columns:
        values = frame[column.label]
        if not isinstance(column.values, Words):
            values = bits(None if x is None or x != x else x for x in values)
        assert values == expected(column, infinite, signed), column.label


@pytest.mark.parametrize("name", ["parquet", "arrow"])
def test_pyarrow_reads(folder: Path, name: str) -> None:
    from pyarrow import feather, parquet

    reads = {"parquet": parquet.read_table, "arrow": feather.read_table}[name]
    table = reads(folder / f"t.{name}")
    compare(table.to_pydict())
    assert str(table.schema.field("row").type) == "int64"
    units = {f.name: f.metadata[b"unit"].decode() for f in table.schema if f.metadata}
    assert units == {c.label: c.unit for c in READ.columns if c.unit}
    metadata = {key.decode(): text.decode() for key, text in table.schema.metadata.items()}
    assert (metadata["name"], metadata["title"]) == ("random", "Random numbers")
    assert json.loads(metadata["units"]) == units
    missing = np.isnan(READ.columns[1].values).sum()
    assert table.column("O1.theta").null_count == missing > 0
    if name == "parquet":
        groups = parquet.ParquetFile(folder / "t.parquet").metadata
        rows = [groups.row_group(k).num_rows for k in range(groups.num_row_groups)]
        assert rows == [ROW_GROUP, 3000]


@pytest.mark.parametrize("name", STREAM_FORMATS)
def test_duckdb_reads(folder: Path, name: str) -> None:
    duckdb = pytest.importorskip("duckdb")
    if name == "arrow":
        from pyarrow import feather

        found = duckdb.from_arrow(feather.read_table(folder / "t.arrow"))
    elif name.startswith("csv"):
        found = duckdb.sql(f"FROM read_csv('{folder}/t.{name}', header=true)")
    else:
        found = duckdb.sql(f"FROM '{folder}/t.{name}'")
    columns = [column.label for column in READ.columns]
    is_text = name.startswith(("csv", "jsonl"))
    compare(
        dict(zip(columns, map(list, zip(*found.fetchall(), strict=True)), strict=True)),
        infinite=not name.startswith("jsonl"),
        signed=not is_text,
    )
    if name == "parquet":
        kept = duckdb.sql(f"FROM parquet_kv_metadata('{folder}/t.parquet')").fetchall()
        assert {row[1]: row[2] for row in kept}[b"title"] == b"Random numbers"


@pytest.mark.parametrize("name", STREAM_FORMATS)
def test_polars_reads(folder: Path, name: str) -> None:
    polars = pytest.importorskip("polars")
    path = folder / f"t.{name}"
    kind = name.partition(".")[0]
    if kind == "csv":
        frame = polars.read_csv(path, infer_schema_length=None)
    elif kind == "jsonl":
        text = path.read_bytes()
        frame = polars.read_ndjson(text) if name == "jsonl" else polars.read_ndjson(path)
    else:
        frame = {"parquet": polars.read_parquet, "arrow": polars.read_ipc}[kind](path)
    compare(
        frame.to_dict(as_series=False),
        infinite=kind != "jsonl",
        signed=kind in ("parquet", "arrow"),
    )


@pytest.mark.parametrize("name", [name for name in STREAM_FORMATS if not name.endswith("zst")])
def test_pandas_reads(folder: Path, name: str) -> None:
    """But for zstd, which it needs another library for."""
    pandas = pytest.importorskip("pandas")
    path = folder / f"t.{name}"
    kind = name.partition(".")[0]
    if kind == "csv":
        frame = pandas.read_csv(path)
    elif kind == "jsonl":
        # its own reader of numbers is not exact, and the exact one takes no small numbers
        content = path.read_bytes() if name == "jsonl" else gzip.decompress(path.read_bytes())
        frame = pandas.read_json(io.BytesIO(content), lines=True, engine="pyarrow")
    else:
        frame = {"parquet": pandas.read_parquet, "arrow": pandas.read_feather}[kind](path)
    compare(
        {label: frame[label].tolist() for label in frame},
        infinite=kind != "jsonl",
        signed=kind in ("parquet", "arrow"),
    )
