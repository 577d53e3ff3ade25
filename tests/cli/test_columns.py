"""`--columns`: some columns of the tables, by their labels; and tables as data."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from cli import files
from references import RCSR

CRANK = files.CRANK + files.TABLES
SUMMARY = CRANK.replace("title: The tip,", "title: The tip, summary: [max, mean],")


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))


def columns_of(path: Path) -> dict[str, list[str]]:
    with path.open(encoding="utf-8", newline="") as stream:
        head, *rows = csv.reader(stream)
    return dict(zip(head, map(list, zip(*rows, strict=True)), strict=True))


def test_columns_of_all_tables_that_have_them_in_the_order_asked_for(mechkin, folder) -> None:
    assert mechkin("analyze", RCSR, "--out", "all").code == 0
    run = mechkin("analyze", RCSR, "--out", "some", "--columns", "FB,theta4", "--columns", "s2")
    assert run.code == 0
    whole = {path.stem: columns_of(path) for path in (folder / "all").glob("table*.csv")}
    asked = ["FB", "theta4", "s2"]
    expected = {
        stem: {label: table[label] for label in asked if label in table}
        for stem, table in whole.items()
    }
    expected = {stem: table for stem, table in expected.items() if table}
    found = {path.stem: columns_of(path) for path in (folder / "some").glob("table*.csv")}
    assert found == expected
    assert 1 < len(found) < len(whole)
    for stem, table in found.items():
        assert list(table) == list(expected[stem])
    assert "rows.csv" in names(folder / "some")
    # stdout shows them, too
    assert "FB" in run.out
    assert "FC" not in run.out


def test_a_label_with_a_comma_and_one_with_spaces_around(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    for text in ("torque, motor", '"torque, motor"', 'x , "torque, motor"', 'x,"torque, motor"'):
        run = mechkin("analyze", path, "--columns", text, "--format", "csv")
        assert (run.code, "drive.csv" in names(folder / "out/crank")) == (0, True), text
        assert ("tip.csv" in names(folder / "out/crank")) == ("x" in text)


@pytest.mark.parametrize(
    ("label", "words"),
    [
        ("thta4", "did you mean theta4 or "),
        ("nothing at all", "columns are "),
        ("", "columns are "),
    ],
)
def test_an_unknown_label_is_refused_with_the_nearest(mechkin, folder, label, words) -> None:
    run = mechkin("analyze", RCSR, "--columns", f"s2,{label}", "--out", "here")
    assert run.code == 2
    assert f"--columns: no table has a column {label}; " in run.err
    assert words in run.err
    assert not (folder / "here").exists()


def test_a_column_of_another_table_than_the_chosen_one_is_refused(mechkin, write) -> None:
    path = write("crank.yaml", CRANK)
    run = mechkin("analyze", path, "--table", "drive", "--columns", "x")
    assert run.code == 2
    assert "no table has a column x" in run.err


def test_summaries_keep_the_chosen_columns(mechkin, write, folder) -> None:
    path = write("crank.yaml", SUMMARY)
    assert mechkin("analyze", path, "--out", "all").code == 0
    run = mechkin("analyze", path, "--columns", "x", "--out", "some")
    assert run.code == 0
    whole, some = (columns_of(folder / each / "tip.summary.csv") for each in ("all", "some"))
    assert some == {"summary": whole["summary"], "x": whole["x"]}
    # the words in a column of their own, and below x what is summed up of it
    lines = (folder / "some/tip.md").read_text(encoding="utf-8").splitlines()
    (below,) = (line.split("|")[1:-1] for line in lines if line.startswith("| max "))
    assert [cell.strip() for cell in below] == ["max", "2.00"]
    assert ["max", "2.00"] in [line.split() for line in run.out.splitlines()]


def test_json_and_errors_have_the_chosen_columns(mechkin, write, folder) -> None:
    path = write("crank.yaml", CRANK)
    record = mechkin("analyze", path, "--columns", "x", "--json", "--errors").json
    assert [[c["label"] for c in table["columns"]] for table in record["tables"]] == [["x"]]
    assert {column["label"] for column in record["errors"]["columns"]} == {"x"}


# Tables as data.


def test_formats_of_data_bring_rows_along(mechkin, write, folder) -> None:
    pytest.importorskip("pyarrow")
    path = write("crank.yaml", CRANK)
    run = mechkin("analyze", path, "--format", "jsonl,parquet,md", "--out", "here")
    assert run.code == 0
    stems = {
        "jsonl": ["drive", "rows", "tip"],
        "parquet": ["drive", "rows", "tip"],
        "md": ["drive", "tip"],
    }
    assert names(folder / "here") == sorted(f"{n}.{kind}" for kind in stems for n in stems[kind])
    lines = (folder / "here/rows.jsonl").read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["row"] for line in lines] == [1, 2, 3]


def test_units_are_in_the_metadata(mechkin, write, folder) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    mechkin("analyze", write("crank.yaml", CRANK), "--format", "parquet")
    schema = parquet.read_schema(folder / "out/crank/tip.parquet")
    assert {f.name: f.metadata[b"unit"].decode() for f in schema} == {"O.theta": "deg", "x": "m"}
    assert schema.metadata[b"name"] == b"tip"
    assert schema.metadata[b"title"] == b"The tip"


def test_a_run_in_another_format_removes_the_files_of_the_first(mechkin, write, folder) -> None:
    pytest.importorskip("pyarrow")
    path = write("crank.yaml", CRANK)
    mechkin("analyze", path, "--format", "csv.gz,arrow")
    run = mechkin("analyze", path, "--format", "csv.zst")
    assert names(folder / "out/crank") == ["drive.csv.zst", "rows.csv.zst", "tip.csv.zst"]
    assert "rows.csv.gz" in run.err
    assert "rows.arrow" in run.err


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ("", "no label is given; columns are "),
        (" , ", "no label is given"),
        ('"x', '"x has a quote that does not end'),
    ],
)
def test_columns_that_name_nothing_are_refused(mechkin, columns, words) -> None:
    run = mechkin("analyze", RCSR, "--columns", columns)
    assert run.code == 2
    assert f"--columns: {words}" in run.err
