"""What a shell is offered: files, and names read from the file on the line."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from cli import files

RESPONSE = "responses: {swing: {start: {O.theta: 0}, time: {from: 0, to: 1, step: 0.5}}}\n"


@pytest.fixture
def filled(tmp_path: Path) -> Path:
    (tmp_path / "crank.yaml").write_text(files.CRANK + files.TABLES + RESPONSE)
    (tmp_path / "crank.csv").write_text("a\n")
    (tmp_path / "craned").mkdir()
    (tmp_path / "craned" / "x.yml").write_text("format: [1\n")
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
        ("mechkin analyze craned/", ["craned/x.yml"]),
        ("mechkin analyze crank.yaml --table ", ["tip", "drive"]),
        ("mechkin analyze crank.yaml --table d", ["drive"]),
        ("mechkin analyze crank.yaml --format ", ["csv", "md", "json", "tex"]),
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
