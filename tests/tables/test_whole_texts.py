"""Whole tables against texts made cell by cell with Python's repr, json and exact decimals."""

import csv
import io
import json
from decimal import ROUND_HALF_EVEN, Context, Decimal

import numpy as np
import pytest

from mechkin_cli.tables import Columns
from mechkin_cli.tables.columns import TableColumn, Words
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.json import JsonCells, json_bytes, json_text, table_record
from mechkin_cli.tables.markup import markdown_bytes

CONTEXT = Context(prec=1500)
WORDS = (
    "ok",
    "",
    "θ₁ größer",
    'a "b", c',
    "bar | and \\",
    "a long word that is wider than the head",
)
ROWS = [0, 1, 2, 1023, 1024, 1025, 3000]


def random_column(random, rows):
    """Numbers of one of several sizes, with zeros, ties, gaps and what is not finite among them."""
    kind = random.integers(6)
    if kind == 0:
        values = np.frombuffer(random.bytes(8 * rows), dtype=np.float64).copy()
    elif kind == 1:
        values = random.integers(-(10**6), 10**6, rows) / 8.0
    elif kind == 2:
        values = np.arange(rows, dtype=float)
    else:
        values = random.uniform(-1, 1, rows) * 10.0 ** random.integers(-9, 18)
    holes = random.integers(0, 12, rows)
    for code, special in enumerate((np.nan, np.inf, -np.inf, 0.0, -0.0)):
        values[holes == code] = special
    return np.full(rows, np.nan) if kind == 5 else values


def random_table(seed, rows):
    random = np.random.default_rng(seed)
    columns = []
    for number in range(random.integers(1, 7)):
        label = random.choice(
            ["x", "a,b", 'say "x"', "α|β", "two\nlines", "a label of some length"]
        )
        unit = str(random.choice(["", "deg", "lbm*in/s^2", "µm"]))
        if random.integers(4) == 0:
            codes = random.integers(0, len(WORDS), rows).astype(np.int32)
            columns.append(TableColumn(f"{label}{number}", unit, Words(codes, WORDS)))
            continue
        decimals = None if random.integers(2) else int(random.integers(0, 26))
        columns.append(TableColumn(f"{label}{number}", unit, random_column(random, rows), decimals))
    return Columns("t", "T", tuple(columns))


def words_of(column):
    return [column.values.words[code] for code in column.values.codes]


def finite(value):
    return value == value and abs(value) != float("inf")


# --- Markdown -----------------------------------------------------------------------------------


def fixed(value, decimals):
    if not finite(value):
        return ""
    rounded = Decimal(value).quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_EVEN, CONTEXT)
    return f"{rounded if rounded else abs(rounded):f}"


def scientific(value):
    return ("0" if value == 0 else f"{value:.5e}") if finite(value) else ""


def decimal_cells(values, decimals):
    """The rule for people, cell by cell."""
    if decimals is not None:
        return [fixed(value, decimals) for value in values]
    largest = max((abs(value) for value in values if finite(value)), default=0.0)
    exponent = int(f"{largest:.5e}".split("e")[1])
    if not -6 <= exponent < 9:
        return [scientific(value) for value in values]
    texts = [fixed(value, max(0, 5 - exponent)) for value in values]
    while any(texts) and all("." in text and text[-1] in "0." for text in texts if text):
        ended = [text[-1] for text in texts if text]
        texts = [text[:-1] for text in texts]
        if ended[0] == ".":
            break
    return texts


def escaped(text):
    return " ".join(text.split()).replace("\\", "\\\\").replace("|", "\\|")


def expected_markdown(table):
    padded = []
    for column in table.columns:
        left = isinstance(column.values, Words)
        head = escaped(f"{column.label} [{column.unit}]" if column.unit else column.label)
        cells = (
            [escaped(word) for word in words_of(column)]
            if left
            else decimal_cells(column.values.tolist(), column.decimals)
        )
        width = max(4, len(head), *map(len, cells), 0)
        place = str.ljust if left else str.rjust
        rule = ":" + "-" * (width - 1) if left else "-" * (width - 1) + ":"
        padded.append([place(head, width), rule, *(place(cell, width) for cell in cells)])
    return "".join(f"| {' | '.join(cells)} |\n" for cells in zip(*padded, strict=True))


class Solved:
    """A source of which every row has a solution; footnotes name rows by number alone."""

    def __init__(self, rows):
        self.inputs, self.status = {}, np.zeros(rows, dtype=np.int8)


def table_lines(table, rows, threads):
    text = markdown_bytes(table, Solved(rows), threads).decode()
    assert text.startswith("# T\n\n|")
    return "".join(f"{line}\n" for line in text.split("\n") if line.startswith("|"))


@pytest.mark.parametrize("rows", ROWS)
@pytest.mark.parametrize("seed", range(8))
def test_markdown_cell_by_cell(seed, rows):
    table = random_table(seed, rows)
    expected = expected_markdown(table)
    for threads in (1, 2, 5):
        assert table_lines(table, rows, threads) == expected


# --- CSV ----------------------------------------------------------------------------------------


def shortest(value):
    """The digits of repr, plain from 1e-5 up to below 1e16, whole numbers without a point."""
    if not finite(value) or value == 0:
        return "0" if value == 0 else ""
    if 1e-5 <= abs(value) < 1e16:
        text = f"{Decimal(repr(value)):f}"
        return text.rstrip("0").rstrip(".") if "." in text else text
    return repr(value)


@pytest.mark.parametrize("rows", ROWS)
@pytest.mark.parametrize("seed", range(8))
def test_csv_cell_by_cell(seed, rows):
    table = random_table(seed, rows)
    cells = [
        words_of(column)
        if isinstance(column.values, Words)
        else map(shortest, column.values.tolist())
        for column in table.columns
    ]
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([column.label for column in table.columns])
    writer.writerows(zip(*cells, strict=True))
    for threads in (1, 2, 5):
        assert csv_bytes(table, threads=threads).decode() == stream.getvalue()


# --- JSON ---------------------------------------------------------------------------------------


def json_number(value):
    if not finite(value):
        return None
    return int(value) if value.is_integer() and abs(value) < 1e16 else value


@pytest.mark.parametrize("rows", ROWS)
@pytest.mark.parametrize("seed", range(8))
def test_json_cell_by_cell(seed, rows):
    table = random_table(seed, rows)
    for column in table.columns:
        cells = (
            words_of(column)
            if isinstance(column.values, Words)
            else [json_number(value) for value in column.values.tolist()]
        )
        expected = json.dumps(cells, ensure_ascii=False)
        for threads in (1, 2, 5):
            assert JsonCells(column.values, threads).json_bytes().decode() == expected
    assert len(json.loads(json_text(table_record(table)))["columns"]) == len(table.columns)


def test_the_record_is_as_json_lays_it_out():
    """Keys, brackets and indents against the same record with plain lists."""
    table = random_table(3, 5)
    record = {"tables": [table_record(table)], "none": [], "empty": {}, "n": 1.5}
    plain = json.loads(json_bytes(record))
    assert json_bytes(plain) == json_bytes(record)
