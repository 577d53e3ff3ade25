"""`mechkin bench` measures, and runs nothing that lies about in the current folder."""

import json
import sys
import sysconfig
from pathlib import Path
from subprocess import run

import pytest

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


def test_nothing_of_the_current_folder_runs(trapped: Path) -> None:
    done = run(
        [*command(), "bench", "--quick", "--json"], cwd=trapped, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert not (trapped.parent / "mark").exists()
    record = json.loads(done.stdout)
    assert list(record) == ["machine", "sweeps_rcsr", "demand_rcsr", "sweeps_7r", "demand_7r"]
    assert all(row["microseconds"] > 0.0 for row in record["sweeps_rcsr"]["rows"])


def test_the_traps_would_be_seen(trapped: Path) -> None:
    run([sys.executable, "tests/benchmark/yardstick/run.py"], cwd=trapped, check=False)
    assert (trapped.parent / "mark").exists()


def test_folders_of_code_are_no_option(trapped: Path) -> None:
    done = run([*command(), "bench", "--yardstick", "."], cwd=trapped, capture_output=True)
    assert done.returncode == 2
    assert not (trapped.parent / "mark").exists()
