"""The example of a CI job is a workflow, and its commands do what it says of them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from cli import files

EXAMPLE = Path(__file__).parents[2] / "docs" / "ci-workflow.yml"
STEPS: list[dict[str, Any]] = yaml.safe_load(EXAMPLE.read_text())["jobs"]["mechanisms"]["steps"]
COMMANDS = {
    step["name"]: step["run"] for step in STEPS if step.get("run", "").startswith("mechkin ")
}
CHECK, COMPARE, SOLVE = COMMANDS.values()


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    (tmp_path / "mechanisms").mkdir()
    (tmp_path / "mechanisms" / "crank.yaml").write_text(files.CRANK + files.TABLES)
    assert run(tmp_path, "mechkin tables mechanisms")[0] == 0
    return tmp_path


def run(folder: Path, command: str) -> tuple[int, str]:
    """Exit code and messages of a command of the workflow, in a shell as the runner has it."""
    mechkin = f"{sys.executable} -P -m mechkin_cli"
    script = command.replace("mechkin ", f"{mechkin} ", 1)
    done = subprocess.run(
        ["bash", "-e", "-c", script],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    return done.returncode, done.stderr


def test_every_step_does_one_thing() -> None:
    assert all(("run" in step) != ("uses" in step) for step in STEPS)
    assert len(COMMANDS) == 3


def test_a_good_repository_passes(repository: Path) -> None:
    assert [run(repository, command)[0] for command in COMMANDS.values()] == [0, 0, 0]
    kept = repository / STEPS[-1]["with"]["path"]
    assert (kept / "rows.csv").exists() or (kept / "crank" / "rows.csv").exists()


def test_a_wrong_file_is_annotated(repository: Path) -> None:
    (repository / "mechanisms" / "bad.yaml").write_text(files.INVALID)
    code, told = run(repository, CHECK)
    assert code == 3
    assert "::error file=mechanisms/bad.yaml,line=5,col=39," in told


def test_an_old_table_fails(repository: Path) -> None:
    table = repository / "mechanisms" / "crank" / "tip.csv"
    table.write_text(table.read_text().replace("0,2", "0,3"))
    assert run(repository, COMPARE)[0] == 1


def test_a_missing_row_fails(repository: Path) -> None:
    (repository / "mechanisms" / "beyond.yaml").write_text(files.beyond_dead_centre())
    assert run(repository, SOLVE)[0] == 4
