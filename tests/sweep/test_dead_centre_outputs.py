"""What files, pictures, pages, studies and errors say of a row at a dead centre."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from sweep.dead_centre_texts import spatial
from typer.testing import CliRunner

import mechkin_cli as mk
from mechkin_cli.cli.app import app
from mechkin_cli.plots import picture, table_drawing
from mechkin_cli.view.branch import run_marks


def lines(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "crank.yaml"
    path.write_text(spatial("RCSR"), encoding="utf-8")
    return path


def run(*words: str) -> str:
    done = CliRunner().invoke(app, list(words))
    assert done.exit_code in (0, 4), done.output
    return done.output


def test_markdown_sets_infinite_cells_to_the_right(file: Path, tmp_path: Path) -> None:
    run("analyze", str(file), "--out", str(tmp_path / "out"), "--format", "md")
    page = (tmp_path / "out" / "t.md").read_text(encoding="utf-8")
    table = page.split("\n\n")[1].splitlines()
    assert len({len(line) for line in table}) == 1
    assert all(cell.strip().endswith("-:") for cell in table[1].strip("|").split("|"))
    assert [cell.strip() for cell in table[-1].strip("|").split("|")] == ["-30", "-inf", "-inf"]
    assert [cell[-2] for cell in table[-1].strip("|").split("|")] == ["0", "f", "f"]


STUDY = """
study: 1
mechanism: crank.yaml
vary: {{d: [79.5 mm, 80 mm, 80.5 mm]}}
keep:
  - {{of: D.effort, as: [peak, place_of_peak, rms, max, min, range, mean]}}
  - {{of: D.effort, as: value, at: -30 deg, label: last}}
rows: [D.effort]
"""


def test_studies_say_what_tables_say(file: Path, tmp_path: Path) -> None:
    (tmp_path / "widths.yaml").write_text(STUDY.format(), encoding="utf-8")
    shown = run("study", str(tmp_path / "widths.yaml"), "--out", str(tmp_path / "out"))
    found = lines(tmp_path / "out" / "variants.csv")
    assert [line["verdict"] for line in found] == ["ok", "dead-centre", "beyond-dead-centre"]
    run("analyze", str(file), "--out", str(tmp_path / "one"))
    below = {line["summary"]: line["M"] for line in lines(tmp_path / "one" / "t.summary.csv")}
    own = found[1]
    for word in ("peak", "rms", "max", "min", "range", "mean"):
        assert own[f"{word}(D.effort)"] == below[word]
    assert below["peak"] == "inf"
    assert own["last"] == own["min(D.effort)"] == "-inf"
    assert own["place_of_peak(D.effort)"] == below["peak at"] == "-30"
    rows = lines(tmp_path / "out" / "rows.csv")
    assert [line["D.effort"] for line in rows if line["row"] == "4"][1:] == ["-inf", ""]
    # over the variants: the largest peak is infinite, and so is their mean
    (peaks,) = [line for line in shown.splitlines() if line.lstrip().startswith("peak(D.effort)")][
        1:
    ]
    assert peaks.split()[1:] == ["inf", "1"]


def test_pictures_and_pages_mark_the_row(file: Path) -> None:
    r = mk.load(file).analyze()
    x = r["D.theta"]
    (mark,) = [mark for mark in run_marks(r, "D.theta", x) if mark["kind"] == "dead-centre"]
    assert mark["x"] == -30.0
    drawn = picture(table_drawing(r, r.layouts[0], r.tables[0]))
    assert [place for place, _ in drawn.marks] == [-30.0]
    # no entry for a sign that stands nowhere
    assert not drawn.doubtful


def test_errors_say_why_there_is_no_figure(file: Path, tmp_path: Path) -> None:
    shown = run("analyze", str(file), "--errors", "--out", str(tmp_path / "out"))
    assert "2 cells without a figure (at a dead centre, where no digit is sure)" in shown
    own = [line for line in lines(tmp_path / "out" / "errors.csv") if line["row"] == "4"]
    assert [line["why"] != "" for line in own] == [False, True, True]
    assert {line["why"] for line in own[1:]} == {"at a dead centre, where no digit is sure"}
    worst = (tmp_path / "out" / "errors.md").read_text(encoding="utf-8")
    assert worst.count("1 cell without: at a dead centre") == 2


def test_json_has_no_infinity(file: Path) -> None:
    told = run("analyze", str(file), "--json")

    def refuse(word: str) -> None:
        pytest.fail(f"{word} is not JSON")

    data = json.loads(told[told.index("{") :], parse_constant=refuse)
    (table,) = data["tables"]
    effort = next(column for column in table["columns"] if column["label"] == "M")
    assert effort["values"][3] is None
    assert np.isfinite(effort["values"][:3]).all()
