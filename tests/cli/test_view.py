"""`mechkin view` and `mechkin analyze --view`: whole pages at the right places."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from cli.conftest import Mechkin
from references import FILE_OF, RCSR

import mechkin_cli as mk
from mechkin_cli.cli.messages import ExitCode

BEYOND = FILE_OF["rcsr"]


def shown(page: Path) -> dict:
    """The data in a page."""
    text = page.read_text(encoding="utf-8")
    (inside,) = re.findall(r'<script[^>]*id="mechkin-data"[^>]*>(.*?)</script>', text, re.DOTALL)
    found: dict = json.loads(inside)
    return found


def test_a_page_is_written_beside_where_tables_would_be(mechkin: Mechkin, folder: Path) -> None:
    run = mechkin("view", RCSR)
    assert (run.code, run.out) == (ExitCode.OK, "out/rcsr/view.html\n")
    assert "RCSR: sweep (27 rows)" in run.err
    assert [path.name for path in (folder / "out/rcsr").iterdir()] == ["view.html"]
    data = shown(folder / "out/rcsr/view.html")
    assert data["file"] == "rcsr.yaml"
    assert [one["name"] for one in data["runs"][0]["branches"]] == ["mode B", "mode A"]


def test_the_same_page_stands_beside_the_tables(mechkin: Mechkin, folder: Path) -> None:
    assert mechkin("view", RCSR, "-o", "page.html").code == ExitCode.OK
    assert mechkin("analyze", RCSR, "--view", "--quiet").code == ExitCode.OK
    beside = folder / "out/rcsr/view.html"
    assert beside.read_bytes() == (folder / "page.html").read_bytes()
    assert (folder / "out/rcsr/rows.csv").exists()
    mk.load(RCSR).view(folder / "python.html")
    assert beside.read_bytes() == (folder / "python.html").read_bytes()
    mk.load(RCSR).analyze().view(folder / "run.html")
    assert beside.read_bytes() == (folder / "run.html").read_bytes()


def test_options_choose_what_is_shown(mechkin: Mechkin, folder: Path) -> None:
    options = ("--mode", "A", "--no-modes", "--set", "P1=0.52in", "--quiet")
    run = mechkin("view", RCSR, "--out", "a.html", *options)
    assert (run.code, run.out, run.err) == (ExitCode.OK, "a.html\n", "")
    data = shown(folder / "a.html")
    assert [one["name"] for one in data["runs"][0]["branches"]] == ["mode A"]
    crank = next(one for one in data["links"] if one["name"] == "crank")
    assert any(abs(abs(point[1]) - 0.52) < 1e-12 for point in crank["shape"]["points"])


def test_one_run_of_several(mechkin: Mechkin, folder: Path) -> None:
    response = FILE_OF["rcsr_response"]
    name = mk.load(response).runs[-1]
    assert mechkin("view", response, "-o", "r.html", "--run", name).code == ExitCode.OK
    assert [one["name"] for one in shown(folder / "r.html")["runs"]] == [name]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--mode", "Q"), "Q"),
        (("--run", "sweeep"), "did you mean sweep"),
        (("--set", "P1"), "NAME=VALUE"),
        (("--out", "."), "no file"),
        (("--out", "taken"), "a folder stands where a file is to be written"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_written(
    mechkin: Mechkin, folder: Path, options: tuple[str, str], words: str
) -> None:
    (folder / "taken").mkdir()
    run = mechkin("view", RCSR, *options)
    assert run.code == ExitCode.USAGE
    assert words in run.err
    assert run.out == ""
    assert [path.name for path in folder.iterdir()] == ["taken"]


def test_missing_rows_are_told_by_the_exit_code(mechkin: Mechkin, write) -> None:
    text = RCSR.read_text(encoding="utf-8").replace("to: 202", "to: 260")
    run = mechkin("view", write("far.yaml", text), "-o", "far.html")
    assert run.code == ExitCode.ROWS_MISSING
    assert "dead centre" in run.err
    data = shown(Path("far.html"))
    assert [one["kind"] for one in data["runs"][0]["branches"][0]["marks"]] == ["dead-centre"]


def test_an_invalid_file_says_so(mechkin: Mechkin, write) -> None:
    run = mechkin("view", write("bad.yaml", "format: 1\n"))
    assert run.code == ExitCode.INVALID_FILE
    assert "the file has no joints" in run.err


def test_the_browser_is_opened_on_request_alone(
    mechkin: Mechkin, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
    mechkin("view", RCSR, "-o", "a.html", "--no-modes")
    assert opened == []
    mechkin("view", RCSR, "-o", "a b.html", "--no-modes", "--open")
    assert opened == [(folder / "a b.html").as_uri()]
    monkeypatch.setattr("webbrowser.open", lambda url: False)
    assert "open a.html by hand" in mechkin("view", RCSR, "-o", "a.html", "--open").err
