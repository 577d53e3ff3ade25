"""The table of output formats: one entry is all that a new one needs."""

import json

import pytest

from mechkin_cli.cli import analyze_options
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import writers
from mechkin_cli.tables.csv import csv_bytes
from mechkin_cli.tables.markup import rows_table
from mechkin_cli.tables.results import Results
from mechkin_cli.tables.table import evaluate
from mechkin_cli.tables.writers import STREAM_FORMATS


@pytest.fixture
def results(source, layout):
    return Results("RCSR", (evaluate(layout({"s2": "O2.s"}), source),), source)


def test_each_format_writes_its_files(results):
    kinds = {
        "csv": ["table.csv"],
        "md": ["table.md"],
        "json": ["analysis.json"],
        "tex": ["table.tex"],
        "xlsx": ["analysis.xlsx"],
        **{name: [f"table.{name}"] for name in STREAM_FORMATS if name != "csv"},
    }
    assert list(writers.WRITERS) == list(kinds)
    for name, files in kinds.items():
        library, _ = writers.NEEDS.get(name, ("numpy", ""))
        pytest.importorskip(library)
        rows = f"rows.{name if name in STREAM_FORMATS else 'csv'}"
        assert list(writers.written_files([results], [name])) == [*files, rows]


def test_rows_are_in_the_formats_of_streams_that_are_asked_for(results):
    found = writers.written_files([results], ["jsonl", "md", "csv.gz"])
    assert list(found) == ["table.jsonl", "table.md", "table.csv.gz", "rows.jsonl", "rows.csv.gz"]
    row = json.loads(found["rows.jsonl"].splitlines()[0])
    assert (row["row"], row["status"]) == (1, "ok")


def test_rows_come_with_every_format_and_alone(results):
    found = writers.written_files([results], [])
    assert found == {"rows.csv": csv_bytes(rows_table(results.source))}


def test_a_new_format_is_one_entry(results, monkeypatch):
    """Tabs between cells: known to the command, and written."""

    def tsv(runs):
        for results in runs:
            for table in results.tables:
                yield f"{table.name}.tsv", csv_bytes(table).replace(b",", b"\t")

    monkeypatch.setattr(analyze_options, "WRITERS", {**writers.WRITERS, "tsv": tsv})
    monkeypatch.setattr(writers, "WRITERS", {**writers.WRITERS, "tsv": tsv})
    assert analyze_options.AnalyzeCommand([], None, ["tsv", "csv"]).formats == ("tsv", "csv")
    assert list(writers.written_files([results], ["tsv", "csv"])) == [
        "table.tsv",
        "table.csv",
        "rows.csv",
    ]


def test_an_unknown_format_is_refused_with_the_list():
    with pytest.raises(UsageError, match="--format xml: formats are csv, md, json, tex, xlsx"):
        _ = analyze_options.AnalyzeCommand([], None, ["xml"]).formats
