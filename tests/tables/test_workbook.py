"""Workbooks: the same cells as CSV, numbers as numbers, the same bytes each time."""

from __future__ import annotations

import csv
import io
import sys
import zipfile

import numpy as np
import pytest

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import workbook
from mechkin_cli.tables.columns import column_of_numbers, words_of
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.results import Results
from mechkin_cli.tables.table import Columns, TableColumn, evaluate

NUMBERS = np.array([0.1, 1.0 / 3.0, -0.0, 5e-324, np.nan, np.inf, -np.inf, 1.7976931348623157e308])


def column(label, unit="mm"):
    return column_of_numbers(label, unit, NUMBERS)


def words():
    return TableColumn("status", "", words_of(["ok", "=1+1", "@x", "", "a,b", "-2", "ok", "ok"]))


def book(content):
    return pytest.importorskip("openpyxl").load_workbook(io.BytesIO(content))


def results_of(source, *tables, units=False):
    return Results("m", tables, source, units=units)


def test_cells_are_those_of_csv(source):
    table = Columns("t", "", (column("x"), words()))
    (sheet,) = book(workbook.workbook_bytes([results_of(source, table, units=True)])).worksheets
    text = csv_bytes(table, units=True).decode()
    assert [[str(one.value) for one in sheet[1]]] == list(csv.reader(io.StringIO(text)))[:1]
    found = [row[0] for row in sheet.iter_rows(min_row=2, values_only=True)]
    assert found[4:7] == [None, "inf", "-inf"]
    for k in (0, 1, 2, 3, 7):
        assert isinstance(found[k], int | float)
        assert float(found[k]) == NUMBERS[k], "all digits"
    kinds = [(row[1].value, row[1].data_type) for row in sheet.iter_rows(min_row=2)]
    assert kinds[:3] == [("ok", "s"), ("=1+1", "s"), ("@x", "s")]
    assert kinds[3][0] is None


def test_a_sheet_for_each_table_and_summary(source, layout):
    table = evaluate(layout({"s2": "O2.s"}), source)
    others = [Columns(name, "", (column("x"),)) for name in ("Table", "a" * 40, "a" * 41)]
    sheets = book(workbook.workbook_bytes([results_of(source, table, *others)])).sheetnames
    assert sheets == ["table", "Table~2", "a" * 31, "a" * 29 + "~2"]


def test_the_bytes_depend_on_the_tables_alone(source, monkeypatch):
    pytest.importorskip("openpyxl")
    results = [results_of(source, Columns("t", "", (column("x"), words())))]
    first = workbook.workbook_bytes(results)
    monkeypatch.setattr("time.time", lambda: 2e9)
    monkeypatch.setattr("time.localtime", lambda *_: (2033, 5, 18, 3, 33, 20, 2, 138, 0))
    assert workbook.workbook_bytes(results) == first
    with zipfile.ZipFile(io.BytesIO(first)) as archive:
        assert {one.date_time for one in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        core = archive.read("docProps/core.xml").decode()
    assert core.count("1980-01-01T00:00:00Z") == 2


def test_rows_and_columns_beyond_a_piece_and_a_letter_are_in_their_places(source, monkeypatch):
    monkeypatch.setattr(workbook, "ROWS_AT_ONCE", 3)
    numbers = np.arange(8.0)
    columns = [column_of_numbers(f"c{k}", "mm", numbers + 100 * k) for k in range(60)]
    (sheet,) = book(
        workbook.workbook_bytes([results_of(source, Columns("t", "", tuple(columns)))])
    ).worksheets
    for row, index, place in ((2, 0, "A2"), (4, 25, "Z4"), (5, 26, "AA5"), (9, 59, "BH9")):
        assert sheet[place].value == 100 * index + row - 2
    assert (sheet.max_row, sheet.max_column) == (9, 60)
    text = words_of(['<b> & "c"', " blank ", "\u00e4"])
    (sheet,) = book(
        workbook.workbook_bytes(
            [results_of(source, Columns("t", "", (TableColumn("s", "", text),)))]
        )
    ).worksheets
    assert [sheet[f"A{row}"].value for row in (2, 3, 4)] == ['<b> & "c"', " blank ", "\u00e4"]


def test_too_many_rows_are_refused(source, monkeypatch):
    pytest.importorskip("openpyxl")
    monkeypatch.setattr(workbook, "MOST_ROWS", 8)
    with pytest.raises(UsageError, match=r"table t has 9 rows with its header.*at most 8.*csv"):
        workbook.workbook_bytes([results_of(source, Columns("t", "", (column("x"),)))])


def test_too_long_a_text_is_refused_and_not_cut(source):
    pytest.importorskip("openpyxl")
    for length in (32_767, 32_768):
        table = Columns("t", "", (TableColumn("status", "", words_of(["x" * length])),))
        if length == 32_767:
            (sheet,) = book(workbook.workbook_bytes([results_of(source, table)])).worksheets
            assert sheet["A2"].value == "x" * length
            continue
        with pytest.raises(UsageError, match=r"table t has a text of 32768 .*at most 32767.*csv"):
            workbook.workbook_bytes([results_of(source, table)])


def test_without_openpyxl_the_command_to_install_it_is_said(source, monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(UsageError, match=r"pip install 'mechkin\[xlsx\]'"):
        workbook.workbook_bytes([results_of(source)])
