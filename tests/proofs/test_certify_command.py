"""`mechkin analyze --certify`: files, summary, exit codes."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest
from references import FILE_OF, RCSR

import mechkin_cli as mk


def analyze(file: Path, out: Path, *options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-P", "-m", "mechkin_cli", "analyze", str(file), "--out", str(out)]
    return subprocess.run([*command, *options], check=False, capture_output=True, text=True)


def rows_of(out: Path) -> list[dict[str, str]]:
    with (out / "rows.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_rows_and_summary(tmp_path: Path) -> None:
    run = analyze(RCSR, tmp_path, "--certify")
    assert run.returncode == 0
    assert "  proof    27 proven; one branch from end to end (5 tubes)" in run.stderr
    assert [row["proof"] for row in rows_of(tmp_path)] == ["proven"] * 27
    analyze(RCSR, tmp_path)
    assert "proof" not in rows_of(tmp_path)[0]


def test_json(tmp_path: Path) -> None:
    answer = json.loads(analyze(RCSR, tmp_path, "--certify", "--json").stdout)
    (column,) = [column for column in answer["rows"] if column["label"] == "proof"]
    assert column["values"] == ["proven"] * 27
    assert answer["proof"] == {"one_branch": True, "tubes": 5, "dead_centres": []}
    assert "proof" not in json.loads(analyze(RCSR, tmp_path, "--json").stdout)


def test_a_dead_centre_at_the_end(tmp_path: Path) -> None:
    file = tmp_path / "beyond.yaml"
    text = RCSR.read_text(encoding="utf-8")
    file.write_text(text.replace("from: 150, to: 202, step: 2", "from: 150, to: 210, step: 2"))
    run = analyze(file, tmp_path / "out", "--certify", "--json")
    assert run.returncode == analyze(file, tmp_path / "out").returncode
    (found,) = json.loads(run.stdout)["proof"]["dead_centres"]
    assert found["low"] < found["value"] < found["high"]
    assert [found[key] for key in ("name", "unit", "last_row", "tubes", "proof")] == [
        *("O1.theta", "deg", 28, 2),
        "proven",
    ]


def test_strict_wants_all_rows_proven(tmp_path: Path) -> None:
    """Rows up to 1e-9 degrees before the dead centre are more than rounding can tell."""
    text = RCSR.read_text(encoding="utf-8")
    near = tmp_path / "near.yaml"
    near.write_text(text.replace("from: 150, to: 202, step: 2", "values: [200, 205.1439656]"))
    found = mk.load(near).certify()
    code = analyze(near, tmp_path / "out", "--certify", "--strict").returncode
    solved = (found.analysis["row.status"] == "ok").all()
    assert (code == 0) == (found.is_one_branch and solved)


def test_a_response_is_told_to_have_no_proofs(tmp_path: Path) -> None:
    run = analyze(FILE_OF["rcsr_response"], tmp_path, "--certify")
    assert run.returncode == 0
    assert "the rows of response are not proven: --certify proves sweeps" in run.stderr


def test_a_column_of_a_table(tmp_path: Path) -> None:
    text = RCSR.read_text(encoding="utf-8")
    head, _, _ = text.partition("\ntables:")
    table = "\ntables: [{name: t, columns: [{label: proof, value: row.proof}]}]\n"
    file = tmp_path / "column.yaml"
    file.write_text(head + table, encoding="utf-8")
    analyze(file, tmp_path / "out")
    lines = (tmp_path / "out" / "t.csv").read_text().split()
    assert lines == ["proof", *["proven"] * 27]
    assert mk.load(file).analyze()["row.proof"].tolist() == ["proven"] * 27
    with pytest.raises(mk.ExpressionError):
        mk.load(file).analyze()["row.proof + 1"]
