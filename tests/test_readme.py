"""What the README says is true: its files, its commands, its numbers."""

import re
import subprocess
from math import cos, radians, sin, sqrt
from pathlib import Path

import pytest
from documents.reading import ROOT, blocks, page, ran

import mechkin_cli as mk
from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files

README = page("README.md")
LONGEST = 120
"""Lines: who reads more has the pages."""


def test_the_readme_stays_short() -> None:
    assert len(README.splitlines()) <= LONGEST


def test_files_named_in_the_readme_exist() -> None:
    named = re.findall(r"\b((?:mechanisms|tests|mechkin_cli|schemas)/[\w./]*\w)", README)
    assert len(named) > 2
    missing = [name for name in {*named, ".ci/run"} if not (ROOT / name).exists()]
    assert not missing


@pytest.mark.parametrize("marker", ["main", "tests"])
def test_the_gate_runs_the_command_lines_of_the_readme(marker: str) -> None:
    gate = (ROOT / ".ci/run").read_text(encoding="utf-8")
    (extraction,) = [
        line for line in gate.splitlines() if line.startswith("command=") and marker in line
    ]
    found = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", f'{extraction}\nprintf %s "$command"'],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    (block,) = [text for text in blocks(README, "sh") if text.startswith(found)]
    assert block == f"{found}\n"
    assert found.startswith("python3 -m venv .venv && .venv/bin/pip install -q ")
    ending = {
        "main": ".venv/bin/mechkin analyze mechanisms/plane/planar_four_bar.yaml",
        "tests": ".venv/bin/pytest -n auto --dist loadfile",
    }
    assert found.endswith(ending[marker])


def test_what_the_example_prints(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (text,) = blocks(README, "yaml")
    monkeypatch.chdir(tmp_path)
    Path("readme.yaml").write_text(text, encoding="utf-8")
    analyze_files(AnalyzeCommand([Path("readme.yaml")], None, []))
    said = capsys.readouterr()
    assert said.out + said.err in blocks(README, "text")


def test_the_example_file_against_the_closed_form_of_the_slider_crank() -> None:
    (text,) = blocks(README, "yaml")
    model = mk.loads(text, "readme.yaml")
    analysis = model.analyze()
    assert analysis.diagnostics == ()
    assert analysis.result.complete
    (table,) = analysis.tables
    assert [column.label for column in table.columns] == ["theta", "s", "v", "torque", "bearing"]
    columns = {column.label: column.values for column in table.columns}
    assert columns["theta"].tolist() == [float(angle) for angle in range(-70, 71, 35)]
    crank, rate = 40.0, 20.0
    rod = sqrt(120.0**2 + 40.0**2)
    for theta, s, v in zip(columns["theta"], columns["s"], columns["v"], strict=True):
        x, y = -crank * sin(radians(theta)), crank * cos(radians(theta))
        reach = sqrt(rod**2 - y**2)
        assert s == pytest.approx(x + reach - 120.0, abs=1e-11)
        assert v == pytest.approx(rate * (-y - y * x / reach), abs=1e-9)


def test_the_python_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    (code,) = blocks(README, "python")
    analysis = ran(code, "r")
    assert isinstance(analysis, mk.Analysis)
    assert analysis["O4.theta"].shape == (27,)
    for expression in re.findall(r'r\["(.*?)"\]', code):
        assert analysis[expression].shape[0] == 27
