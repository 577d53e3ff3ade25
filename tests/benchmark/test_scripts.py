"""The scripts of other libraries find mechkin's table, and are timed as whole processes."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from benchmark.script_problem import Script, scripts
from benchmark.script_table import FOLDER, LIBRARIES, script_table

from mechkin_cli.cli.analyze import AnalyzeCommand, analyze_files

SAME = 1e-11
"""Both stop at rounding, which accelerations a quarter of a degree apart keep but for a few
digits."""


def difference(library: str, script: Script, folder: Path) -> float:
    (folder / "problem.json").write_text(json.dumps(script.problem), encoding="utf-8")
    path = FOLDER / f"with_{library}.py"
    line = [sys.executable, "-P", str(path), str(folder / "problem.json"), str(folder)]
    line.append(str(folder / "motion.csv"))
    done = subprocess.run(line, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return float(done.stdout.split()[-1])


@pytest.mark.parametrize("library", LIBRARIES.values())
@pytest.mark.parametrize("name", ["RCSR", "7R", "Stewart"])
def test_a_script_finds_the_same_table(name: str, library: str, tmp_path: Path) -> None:
    if find_spec(library) is None:
        pytest.skip(f"{library} is not installed")
    script = scripts()[name]()
    (tmp_path / "m.yaml").write_text(script.text, encoding="utf-8")
    command = AnalyzeCommand([tmp_path / "m.yaml"], tmp_path, ["csv"], quiet=True)
    assert analyze_files(command) == 0
    assert difference(library, script, tmp_path) < SAME
    # another mechanism is seen
    if script.problem["lengths"]:
        script.problem["spots"][1]["place"][0] += 1e-6
    else:
        script.problem["joints"][-1]["axis"][1] += 1e-6
    assert 1e-9 < difference(library, script, tmp_path) < math.inf


def test_the_table_of_whole_scripts() -> None:
    table = script_table(1, ["RCSR"])
    assert table.rows[0]["process"] == "mechkin analyze"
    assert table.rows[0]["ratio"] == 1.0
    here = [label for label, library in LIBRARIES.items() if find_spec(library) is not None]
    assert [row["process"] for row in table.rows[1:]] == here
    for row in table.rows[1:]:
        assert isinstance(row["difference"], float)
        assert 0.0 < row["difference"] < SAME
        assert isinstance(row["milliseconds"], float)
        assert row["milliseconds"] > 0.0
    missing = [label for label in LIBRARIES if label not in here]
    assert [label for label in missing if not any(label in note for note in table.notes)] == []
