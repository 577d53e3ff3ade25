"""`mechkin analyze --errors`: what it writes and says, and that nothing else changes."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from cli.files import CRANK, TABLES
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files
from mechkin_cli.cli.messages import ExitCode

ALL = ["csv", "md", "json"]


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("[!.]*")}


def lines(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_tables_keep_their_bytes(tmp_path: Path) -> None:
    for name, errors in (("without", False), ("with", True)):
        analyze_files(
            AnalyzeCommand([RCSR], tmp_path / name, ["csv", "md"], quiet=True, errors=errors)
        )
    without, found = files(tmp_path / "without"), files(tmp_path / "with")
    assert set(found) - set(without) == {"errors.csv", "errors.md"}
    assert {name: found[name] for name in without} == without


def test_every_cell_has_its_line(tmp_path: Path) -> None:
    analyze_files(AnalyzeCommand([RCSR], tmp_path, ["csv", "json"], quiet=True, errors=True))
    found = lines(tmp_path / "errors.csv")
    assert list(found[0]) == [
        *("table", "column", "unit", "row", "value", "error", "relative", "digits", "why")
    ]
    repeated = [line for line in found if line["row"]]
    for table in lines(tmp_path / "table_03.csv")[:1]:
        assert [f["column"] for f in repeated if f["table"] == "table_03" and f["row"] == "1"] == [
            *table
        ]
    cells = {(f["table"], f["column"], f["row"]): f["value"] for f in repeated}
    for number, row in enumerate(lines(tmp_path / "table_18.csv"), 1):
        for label, value in row.items():
            assert cells["table_18", label, str(number)] == value
    assert min(int(line["digits"]) for line in repeated if line["digits"]) >= 13
    assert {f["table"]: f["why"] for f in found if not f["row"]} == {
        "table_14": "a dense system",
        "table_14_unknowns": "a dense system",
    }
    record = json.loads((tmp_path / "analysis.json").read_text(encoding="utf-8"))
    assert record["errors"]["digits"] >= 13
    own = record["errors"]["columns"][1]
    errors = [float(f["error"]) for f in repeated if f["column"] == own["label"]][:27]
    assert own["error"] == errors


def test_the_summary_has_a_line(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    analyze_files(AnalyzeCommand([RCSR], tmp_path, ["csv"], errors=True))
    (line,) = [x for x in capsys.readouterr().err.splitlines() if x.startswith("  errors")]
    assert "digits; worst: " in line
    assert line.endswith("not repeated: table_14, table_14_unknowns (a dense system)")


def test_cells_that_are_exact(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "crank.yaml"
    path.write_text(CRANK + TABLES, encoding="utf-8")
    analyze_files(AnalyzeCommand([path], tmp_path / "out", ["csv"], errors=True))
    (line,) = [x for x in capsys.readouterr().err.splitlines() if x.startswith("  errors")]
    assert "right to 15 digits" in line or "right to 16 digits" in line
    x = [f for f in lines(tmp_path / "out" / "errors.csv") if f["column"] == "x"]
    # 2 cos 90 deg is zero; what the cell has is its error
    assert float(x[2]["error"]) == pytest.approx(abs(float(x[2]["value"])), abs=1e-30)
    assert np.isclose(float(x[0]["error"]), 0.0, atol=1e-30)


def test_a_response_is_repeated(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = FILE_OF["rcsr_response"]
    analyze_files(AnalyzeCommand([path], tmp_path, ["csv", "md"], errors=True))
    (line,) = [x for x in capsys.readouterr().err.splitlines() if x.startswith("  errors")]
    assert "every cell right to 12 digits" in line
    found = lines(tmp_path / "response.errors.csv")
    assert {f["table"] for f in found if f["digits"]} >= {"table_19", "table_23", "energy"}
    assert all(int(f["digits"]) >= 12 for f in found if f["digits"])


@pytest.mark.parametrize("name", ["errors", "Errors"])
def test_a_table_of_its_name_is_refused_where_errors_are_written(
    name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """It is a table as any other for all commands that write no errors."""
    path = tmp_path / "crank.yaml"
    text = CRANK + TABLES
    own = re.findall(r"name: (\w+)", TABLES)[0]
    path.write_text(text.replace(f"name: {own}", f"name: {name}"), encoding="utf-8")
    assert analyze_files(AnalyzeCommand([path], tmp_path / "out", ["csv"])) == ExitCode.OK
    assert (tmp_path / "out" / f"{name}.csv").is_file()
    capsys.readouterr()
    refused = AnalyzeCommand([path], tmp_path / "other", ["csv"], errors=True)
    assert analyze_files(refused) == ExitCode.USAGE
    assert "--errors writes a table errors, and so does the file" in capsys.readouterr().err
    assert not (tmp_path / "other").exists() or not list((tmp_path / "other").iterdir())
    assert mk.load(path).analyze(errors=True).errors.digits
    others = [t.name for t in mk.load(path).tables if t.name != name]
    for table in others[:1]:
        code = analyze_files(
            AnalyzeCommand([path], tmp_path / "some", ["csv"], table=[table], errors=True)
        )
        assert code == ExitCode.OK


@pytest.mark.parametrize("options", [{"lanes": 2}, {"threads": 2}])
def test_lanes_and_threads_keep_the_bytes(options: dict[str, int], tmp_path: Path) -> None:
    for name, given in (("other", options), ("one", {})):
        analyze_files(
            AnalyzeCommand([RCSR], tmp_path / name, ["csv"], quiet=True, errors=True, **given)
        )
    assert (tmp_path / "one/errors.csv").read_bytes() == (
        tmp_path / "other/errors.csv"
    ).read_bytes()
