"""A study where a mechanism is needed, and the other way: one message with the command."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from mechkin_cli.cli.app import app

STUDY = "study: 1\nmechanism: crank.yaml\nvary: {r: [1 m]}\nkeep: [{of: O.theta, as: max}]\n"
CRANK = (
    "format: 1\nname: crank\nlinks: {arm: {}}\n"
    "joints: {O: {type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}\n"
)


@pytest.mark.parametrize("command", ["analyze", "check", "modes", "ranges", "mobility", "view"])
def test_a_study_is_no_mechanism(tmp_path: Path, command: str) -> None:
    file = tmp_path / "many.yaml"
    file.write_text(STUDY, encoding="utf-8")
    done = CliRunner().invoke(app, [command, str(file)])
    assert done.exit_code == 3
    said = " ".join(done.output.split())
    assert said.count("error:") == 1
    assert "this is a study" in said
    assert "mechkin study" in said
    assert "crank.yaml" in said


def test_a_mechanism_is_no_study(tmp_path: Path) -> None:
    file = tmp_path / "crank.yaml"
    file.write_text(CRANK, encoding="utf-8")
    done = CliRunner().invoke(app, ["study", str(file)])
    assert done.exit_code == 3
    said = " ".join(done.output.split())
    assert said.count("error:") == 1
    assert "this is a mechanism file" in said
    assert "mechkin analyze" in said


def test_no_folder_is_taken_for_a_misspelt_file(tmp_path: Path) -> None:
    (tmp_path / "crane.yaml").mkdir()
    done = CliRunner().invoke(app, ["check", str(tmp_path / "crank.yaml")])
    assert "did you mean" not in done.output
