"""CSV of a table, byte for byte."""

import csv
import io

import numpy as np
import pytest

from mechkin_cli.tables import Columns, evaluate
from mechkin_cli.tables.columns import TableColumn, Words, column_of_numbers, words_of
from mechkin_cli.tables.csv import COMMITTED_DIGITS, csv_bytes
from mechkin_cli.tables.markup import rows_table

NAN = float("nan")


def one_table(*columns: TableColumn) -> Columns:
    return Columns("t", "", columns)


def numbers(label: str, values: list[float]) -> TableColumn:
    return TableColumn(label, "", np.array(values, dtype=float))


def test_shortest_numbers_empty_cells_and_no_signed_zero():
    table = one_table(
        numbers("theta1", [150, 0.1, -0.0, 1 / 3]),
        numbers("s", [NAN, 1e-5, -1e300, np.inf]),
    )
    assert csv_bytes(table) == (b"theta1,s\n150,\n0.1,0.00001\n0,-1e+300\n0.3333333333333333,\n")


def test_committed_tables_have_twelve_digits():
    table = one_table(
        numbers("a", [1 / 3, -2e6 / 3, 0.1 + 0.2]), numbers("b", [150, NAN, 1.0000000000004])
    )
    assert csv_bytes(table, COMMITTED_DIGITS) == (
        b"a,b\n0.333333333333,150\n-666666.666667,\n0.3,1\n"
    )


def test_labels_and_words_survive_a_csv_reader():
    labels = ["a,b", 'say "x"', "two\nlines", "ü"]
    words = Words(np.array([1, 0], dtype=np.int32), ("plain", 'with "q", comma'))
    columns = [TableColumn(labels[0], "", words), *(numbers(label, [1, 2]) for label in labels[1:])]
    text = csv_bytes(one_table(*columns)).decode("utf-8")
    read = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    assert read == [labels, ['with "q", comma', "1", "1", "1"], ["plain", "2", "2", "2"]]


def test_a_single_column_keeps_its_empty_rows():
    assert csv_bytes(one_table(numbers("x", [1, NAN, 3, NAN]))) == b'x\n1\n""\n3\n""\n'


def test_arrays_of_any_memory_order_are_taken():
    block = np.array([[1.0, 10.0], [2.0, 20.0]])
    column = TableColumn("x", "", block[:, 1])
    whole = TableColumn("n", "", np.array([3, 4]))
    assert csv_bytes(one_table(column, whole)) == b"x,n\n10,3\n20,4\n"


def test_input_columns_print_as_written(source, layout):
    source.inputs["O1.theta"] = np.array([150, 150.1, 192, 202.0])
    table = evaluate(layout({"theta1": "O1.theta", "s2": "O2.s"}), source)
    assert csv_bytes(table) == b"theta1,s2\n150,1\n150.1,2\n192,-4\n202,\n"


def test_the_rows_table(source):
    assert csv_bytes(rows_table(source)) == (
        b"row,O1.theta,mode,status,residual,condition,power_error\n"
        b"1,190,A,ok,0,2,\n"
        b"2,191,A,ok,1e-16,2.5,\n"
        b"3,192,A,near-singular,2e-16,10000000,\n"
        b"4,193,A,beyond-dead-centre,,,\n"
    )


@pytest.mark.parametrize("inputs", [{}, {"O1.theta": [1.5], "O2.s": [-2]}])
def test_the_rows_table_has_one_column_per_input(source, inputs):
    source.rows = 1
    source.inputs = {name: np.array(values, dtype=float) for name, values in inputs.items()}
    source.status = np.zeros(1, dtype=np.int8)
    source.residual = source.condition = source.power_error = np.array([0.5])
    header, row = csv_bytes(rows_table(source)).decode().splitlines()
    written = [f"{values[0]:g}" for values in inputs.values()]
    assert header.split(",")[1:-5] == list(inputs)
    assert row.split(",") == ["1", *written, "A", "ok", "0.5", "0.5", "0.5"]


def test_a_decimal_comma_is_read_back_with_semicolons():
    numbers = np.array([150.5, -1.25e-30, np.nan, 1 / 3, np.inf])
    texts = ["a.b", "a;b", "a,b", 'a"b', "two\nlines"]
    columns = (column_of_numbers("x;1", "", numbers), TableColumn("y,2", "", words_of(texts)))
    written = csv_bytes(Columns("t", "", columns), decimal_comma=True).decode()
    header, *rows = csv.reader(io.StringIO(written, newline=""), delimiter=";")
    assert header == ["x;1", "y,2"]
    assert [row[0] for row in rows] == ["150,5", "-1,25e-30", "", "0,3333333333333333", "inf"]
    assert [row[1] for row in rows] == texts


def test_an_empty_cell_alone_in_its_line_is_in_quotes_with_semicolons_too():
    only = Columns("t", "", (column_of_numbers("x", "", np.array([np.nan, 0.5])),))
    assert csv_bytes(only, decimal_comma=True) == b'x\n""\n0,5\n'
