"""What a shell is offered: files, and names read from the file on the line."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from cli import files

FOUR_BAR = Path(__file__).parents[2] / "mechanisms" / "plane" / "planar_four_bar.yaml"
RESPONSE = "responses: {swing: {start: {O.theta: 0}, time: {from: 0, to: 1, step: 0.5}}}\n"


@pytest.fixture
def filled(tmp_path: Path) -> Path:
    (tmp_path / "crank.yaml").write_text(files.CRANK + files.TABLES + RESPONSE)
    (tmp_path / "crank.csv").write_text("a\n")
    (tmp_path / "craned").mkdir()
    (tmp_path / "craned" / "x.yml").write_text("format: [1\n")
    study = "study: 1\nmechanism: crank.yaml\nvary: {r: [30 mm]}\nkeep: [{of: O.theta, as: max}]\n"
    (tmp_path / "craned" / "many.yaml").write_text(study)
    return tmp_path


def offered(folder: Path, line: str) -> list[str]:
    """What bash is offered at the end of a line."""
    words = line.split(" ")
    given = {
        "_MECHKIN_COMPLETE": "complete_bash",
        "COMP_WORDS": line,
        "COMP_CWORD": str(len(words) - 1),
    }
    done = subprocess.run(
        [sys.executable, "-P", "-m", "mechkin_cli"],
        cwd=folder,
        env=os.environ | given,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.stderr == ""
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("mechkin an", ["analyze"]),
        ("mechkin analyze cr", ["craned/", "crank.yaml"]),
        ("mechkin analyze craned/", ["craned/many.yaml", "craned/x.yml"]),
        ("mechkin study cr", ["craned/"]),
        ("mechkin study craned/", ["craned/many.yaml"]),
        ("mechkin study craned/many.yaml --format ", ["csv", "parquet"]),
        ("mechkin view crank.yaml --run ", ["sweep", "swing"]),
        ("mechkin plot crank.yaml --run s", ["sweep", "swing"]),
        ("mechkin plot crank.yaml --table t", ["tip"]),
        ("mechkin view craned/x.yml --mode ", []),
        ("mechkin analyze crank.yaml --table ", ["tip", "drive"]),
        ("mechkin analyze crank.yaml --table d", ["drive"]),
        ("mechkin analyze crank.yaml --format j", ["json", "jsonl", "jsonl.gz", "jsonl.zst"]),
        ("mechkin analyze crank.yaml --set ", ["r="]),
        ("mechkin analyze craned/x.yml --table ", []),
        ("mechkin analyze nowhere.yaml --table ", []),
        ("mechkin analyze --table ", []),
        ("mechkin modes crank.yaml --run ", ["swing"]),
        ("mechkin ranges crank.yaml --input ", ["O.theta"]),
        ("mechkin check crank.yaml --messages g", ["github"]),
        ("mechkin check no/such/folder/", []),
    ],
)
def test_offers(filled: Path, line: str, expected: list[str]) -> None:
    assert offered(filled, line) == expected


@pytest.mark.parametrize("command", ["analyze", "view", "plot"])
def test_assembly_modes_are_searched_for(filled: Path, command: str) -> None:
    """A four-bar has two."""
    (filled / "four_bar.yaml").write_bytes(FOUR_BAR.read_bytes())
    assert offered(filled, f"mechkin {command} four_bar.yaml --mode ") == ["A", "B"]
    assert offered(filled, f"mechkin {command} four_bar.yaml --mode B") == ["B"]


def test_a_study_offers_the_parameters_of_its_mechanism(filled: Path) -> None:
    (filled / "many.yaml").write_text("study: 1\nmechanism: crank.yaml\n")
    assert offered(filled, "mechkin study many.yaml --set ") == ["r="]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_scripts_to_install(tmp_path: Path, shell: str) -> None:
    done = subprocess.run(
        [sys.executable, "-P", "-m", "mechkin_cli", "--show-completion", shell],
        env=os.environ
        | {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1", "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0
    assert "_MECHKIN_COMPLETE" in done.stdout
