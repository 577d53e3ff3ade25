"""`mechkin bench` measures, and runs nothing that lies about in the current folder."""

import json
import sys
import sysconfig
from pathlib import Path
from subprocess import run

import pytest
from references import FILE_OF

TRAP = "from pathlib import Path\nPath(r'{mark}').write_text('ran')\nraise SystemExit(3)\n"
NAMES = ("run", "prep", "mechs", "numpy", "yaml", "typer", "json", "mechkin_cli", "sitecustomize")


@pytest.fixture
def trapped(tmp_path: Path) -> Path:
    """A folder with modules and C sources that leave a mark when they run or are compiled."""
    mark = tmp_path / "mark"
    folder = tmp_path / "here"
    for place in (folder, folder / "tests/benchmark", folder / "tests/benchmark/yardstick"):
        place.mkdir(parents=True)
        for name in NAMES:
            (place / f"{name}.py").write_text(TRAP.format(mark=mark), encoding="utf-8")
        (place / "kern.c").write_text("#error compiled\n", encoding="utf-8")
    (folder / "tests/benchmark/do_nothing.py").write_text(TRAP.format(mark=mark))
    (folder / "mechanisms").mkdir()
    (folder / "mechanisms/rcsr.yaml").write_text("format: 1\n")
    return folder


def command() -> list[str]:
    script = Path(sysconfig.get_path("scripts")) / "mechkin"
    return [str(script)] if script.is_file() else [sys.executable, "-P", "-m", "mechkin_cli"]


MECHANISM = """\
format: 1
name: RSSR
units: {length: m}
links: {crank: {}, rod: {}, rocker: {}}
joints:
  O1: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  O2: {type: S, links: [crank, rod], point: [0.4, 0, 0]}
  O3: {type: S, links: [rod, rocker], point: [1.4, 1, 0.6]}
  O4: {type: R, links: [ground, rocker], point: [1.6, 0, 0.6], axis: [0.25, 0, 1]}
motion: {inputs: {O1.theta: {from: 0, to: 60, step: 10, rate: 2 rad/s}}}
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "rssr.yaml"
    path.write_text(MECHANISM, encoding="utf-8")
    return path


def test_nothing_of_the_current_folder_runs(trapped: Path, file: Path) -> None:
    done = run(
        [*command(), "bench", str(file), "--quick", "--json"],
        cwd=trapped,
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert not (trapped.parent / "mark").exists()
    record = json.loads(done.stdout)
    assert list(record) == ["mechkin", "format", "machine", "mechanisms", "tables"]
    (mechanism,) = record["mechanisms"]
    assert mechanism["name"] == "rssr"
    assert all(m["microseconds"] > 0.0 for m in mechanism["measurements"])
    assert {"ahead", "demand_rssr", "threads"} == set(record["tables"])


def test_files_that_cannot_be_measured_are_told(file: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("format: 1\nname: x\n", encoding="utf-8")
    response = FILE_OF["rcsr_response"]
    files = [str(path) for path in (response, wrong)]
    done = run([*command(), "bench", *files, "--quick"], capture_output=True, text=True)
    assert done.returncode == 3
    assert "has no sweep to measure" in done.stderr
    assert "wrong.yaml" in done.stderr
    assert done.stdout == ""


def test_an_output_folder_that_takes_no_file_is_told(file: Path, tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("")
    line = [*command(), "bench", str(file), "--quick", "--out", str(taken)]
    done = run(line, capture_output=True, text=True)
    assert done.returncode == 2
    assert "--out" in done.stderr
    assert "name a folder" in done.stderr


def test_the_traps_would_be_seen(trapped: Path) -> None:
    run([sys.executable, "tests/benchmark/yardstick/run.py"], cwd=trapped, check=False)
    assert (trapped.parent / "mark").exists()


def test_folders_of_code_are_no_option(trapped: Path) -> None:
    done = run([*command(), "bench", "--yardstick", "."], cwd=trapped, capture_output=True)
    assert done.returncode == 2
    assert not (trapped.parent / "mark").exists()


def test_without_a_file_templates_are_measured() -> None:
    done = run([*command(), "bench", "--quick", "--json"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    record = json.loads(done.stdout)
    assert [one["name"] for one in record["mechanisms"]] == ["rssr", "rcsr", "platform"]
    assert {m["family"] for one in record["mechanisms"] for m in one["measurements"]} == {
        *("mechkin", "dense", "scipy", "stepping")
    }


def test_no_other_command_loads_its_room() -> None:
    code = (
        "import sys, mechkin_cli.cli.app, mechkin_cli.model.model; "
        "print([m for m in sys.modules if m.startswith('mechkin_cli.bench.')])"
    )
    done = run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
