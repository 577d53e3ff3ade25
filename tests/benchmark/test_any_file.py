"""`mechkin bench` takes any mechanism file, or says in a sentence why it does not."""

from __future__ import annotations

import csv
import json
import math
import os
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen, run

import pytest
from cli.test_bench import MECHANISM, command
from references import FILE_OF

import mechkin_cli as mk
from mechkin_cli.bench.report import bench_table, machine, write
from mechkin_cli.bench.runs import Rounds, bench
from mechkin_cli.bench.scene import BenchScene
from mechkin_cli.diagnostics import UsageError

ONCE = Rounds(1, 1)
FILES = list(FILE_OF.values())[:: 3 if os.environ.get("MECHKIN_RANDOM", "1") == "1" else 1]
"""Every third of the kept mechanisms, or all with `MECHKIN_RANDOM=2`."""
REFUSED = (
    "has no sweep",
    "has coordinates at rest",
    "nothing that is solved for",
    "nothing by which errors",
    "no row of",
)


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_a_kept_mechanism_is_measured_or_refused_in_words(path: Path, tmp_path: Path) -> None:
    """Files agree with each other, and no number is none."""
    scene, why = None, ""
    try:
        scene = BenchScene(path.stem, mk.load(path))
    except UsageError as error:
        why = str(error)
    assert any(words in why for words in REFUSED) == bool(why)
    if scene is None:
        return
    found = bench(scene, ONCE, {})
    write(tmp_path, machine(), [found], [bench_table(found)], "mechkin bench")
    text = (tmp_path / "bench.json").read_text(encoding="utf-8")
    record = json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} in bench.json"))
    (own,) = record["mechanisms"]
    with (tmp_path / "bench.csv").open(encoding="utf-8", newline="") as stream:
        lines = list(csv.DictReader(stream))
    assert len(lines) == len(own["measurements"]) == len(found.measurements) > 10
    for line, m in zip(lines, own["measurements"], strict=True):
        assert float(line["microseconds"]) == m["microseconds"] > 0.0
        assert line["curve"] == m["curve"]
        for kind in ("position", "velocity", "acceleration", "loads"):
            assert (line[kind] == "") == (m[kind] is None)
            assert m[kind] is None or (float(line[kind]) == m[kind] and math.isfinite(m[kind]))
    page = (tmp_path / "bench.md").read_text(encoding="utf-8")
    assert page.count("| mechkin |") >= len(lines)
    ET.parse(tmp_path / "bench.svg")


def bench_of(*words: object, cwd: Path) -> tuple[int, str, str]:
    line = [*command(), "bench", *map(str, words), "--quick"]
    done = run(line, capture_output=True, text=True, cwd=cwd)
    assert "Traceback" not in done.stderr + done.stdout
    assert "internal error" not in done.stderr
    return done.returncode, done.stdout, done.stderr


def written(folder: Path, name: str, text: str = MECHANISM) -> Path:
    path = folder / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def test_output_that_cannot_be_written_is_told_before_anything_is_measured(tmp_path: Path) -> None:
    file = written(tmp_path, "a.yaml")
    (tmp_path / "out" / "bench.svg").mkdir(parents=True)
    code, said, why = bench_of(file, "--out", tmp_path / "out", cwd=tmp_path)
    assert (code, said) == (2, "")
    assert "bench.svg" in why
    assert "name a folder that can be written" in why
    # nothing is left where there is nothing to measure
    empty = written(tmp_path, "empty.yaml", MECHANISM.partition("motion:")[0])
    assert bench_of(empty, "--out", tmp_path / "none", cwd=tmp_path)[0] == 3
    assert list((tmp_path / "none").iterdir()) == []


def test_files_of_one_name_stay_apart(tmp_path: Path) -> None:
    """Also those whose names differ only in what no table's name has."""
    files = [written(tmp_path, name) for name in ("one/a-b.yaml", "two/a-b.yaml", "a_b.yaml")]
    code, said, _ = bench_of(*files, "--json", cwd=tmp_path)
    assert code == 0
    record = json.loads(said)
    assert [m["name"] for m in record["mechanisms"]] == ["a-b", "a-b 2", "a_b 3"]
    assert {"demand_a_b", "demand_a_b_2", "demand_a_b_3"} <= set(record["tables"])
    code, _, why = bench_of(files[0], files[0], cwd=tmp_path)
    assert code == 2
    assert "given twice; name it once" in why


def test_a_table_called_errors_is_no_reason_to_refuse(tmp_path: Path) -> None:
    text = MECHANISM + "tables: [{name: errors, columns: [O4.theta]}]\n"
    code, said, why = bench_of(written(tmp_path, "a.yaml", text), cwd=tmp_path)
    assert (code, why) == (0, "")
    assert "sweep, verdicts" in said


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("from: 0, to: 60, step: 10", "values: [0]", 0),
        (", rate: 2 rad/s", "", 0),
        ("[1.6, 0, 0.6]", "[9.6, 0, 0.6]", 0),
        ("motion:", "parameters: {x: 1}\nmotionless:", 3),
    ],
    ids=["one row", "no rates", "another size", "no motion"],
)
def test_what_a_file_lacks_is_left_out(old: str, new: str, code: int, tmp_path: Path) -> None:
    text = MECHANISM.replace(old, new)
    assert text != MECHANISM
    found, said, why = bench_of(written(tmp_path, "a.yaml", text), cwd=tmp_path)
    assert found == code
    assert bool(said) == (code == 0)
    assert bool(why) == (code != 0)
    words = set(said.lower().replace("|", " ").split())
    assert not words & {"nan", "inf", "-inf"}


@pytest.mark.skipif(sys.platform == "win32", reason="no such pipes")
def test_a_reader_that_leaves_ends_it_quietly(tmp_path: Path) -> None:
    line = [*command(), "bench", str(written(tmp_path, "a.yaml")), "--quick"]
    with Popen(line, stdout=PIPE, stderr=PIPE, stdin=DEVNULL, text=True) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline().startswith("processor")
        process.stdout.close()
        assert process.stderr.read() == ""
