"""`python -m benchmarks`: what `mechkin bench` measures, and other libraries beside it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from cli.test_bench import MECHANISM

from benchmarks import ROOT, suite
from benchmarks.peers import FAMILIES
from benchmarks.scenes import texts
from mechkin_cli.bench import runs


def run(*words: object) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "benchmarks", *map(str, words)]
    return subprocess.run(line, cwd=ROOT, capture_output=True, text=True, check=False)


def test_a_file_is_measured_by_all_families(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text(MECHANISM, encoding="utf-8")
    done = run(file, "--quick", "--json", "--out", tmp_path / "out")
    assert (done.returncode, done.stderr) == (0, "")
    (own,) = json.loads(done.stdout)["mechanisms"]
    found = {m["family"] for m in own["measurements"]} | {s["family"] for s in own["skipped"]}
    assert found == set(FAMILIES) == {*runs.FAMILIES, "Pinocchio", "CasADi", "MuJoCo"}
    page = (tmp_path / "out" / "bench.md").read_text(encoding="utf-8")
    assert f"Made by `python -m benchmarks {file}`" in page


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["--stress", "--only", "3"], 2, "benchmarks: --only K is a mechanism of one family"),
        (["--rows", "9"], 2, "without --stress there is nothing for --rows"),
        (["nowhere.yaml"], 2, "nowhere.yaml"),
    ],
)
def test_what_is_wrong_is_told_in_words(words: list[str], code: int, said: str) -> None:
    done = run(*words)
    assert (done.returncode, done.stdout) == (code, "")
    assert said in done.stderr
    assert "Traceback" not in done.stderr


def test_the_whole_suite_has_all_that_was_measured() -> None:
    assert list(texts())[:3] == ["RCSR", "RSSR", "7R"]
    assert {*suite.DEMAND_SCENES, *suite.PROCESS_SCENES} <= texts().keys()
