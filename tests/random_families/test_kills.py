"""Runs that are killed at random moments, and runs that write to one folder at once.

A set of files is always the old or the new one, whole. `MECHKIN_RANDOM` multiplies the number of
kills.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from cli import files

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.folder import LISTING, write_files

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
MECHKIN = [sys.executable, "-P", "-m", "mechkin_cli"]
SETS = [{f"{i}.csv": bytes([65 + which]) * 1000 for i in range(12)} for which in (0, 1)]


def found(folder: Path) -> dict[str, bytes]:
    files = [path for path in folder.iterdir() if path.is_file() and path.suffix == ".csv"]
    return {path.name: path.read_bytes() for path in files}


def debris(folder: Path) -> list[str]:
    return [
        path.name
        for path in folder.iterdir()
        if (path.name.startswith(".") and path.name != LISTING) or path.is_symlink()
    ]


def forked(work: Callable[[], None]) -> int:
    process = os.fork()
    if not process:
        try:
            work()
        finally:
            os._exit(70)
    return process


def test_writing_is_killed(tmp_path: Path) -> None:
    rng = random.Random(0)
    folder = tmp_path / "out"
    write_files(folder, SETS[0])
    left = 0
    for _ in range(100 * TIMES):

        def work() -> None:
            while True:
                for content in SETS:
                    write_files(folder, content)

        process = forked(work)
        time.sleep(rng.uniform(0.001, 0.01))
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
        assert found(folder) in SETS
        left += bool(debris(folder))
        assert len([name for name in debris(folder) if name.startswith(".")]) <= 1
    assert left > 20 * TIMES  # kills in the midst of it
    write_files(folder, SETS[0])
    assert debris(folder) == []
    assert found(folder) == SETS[0]


def test_two_at_once(tmp_path: Path) -> None:
    """Each writes as often as it can, and one is killed now and then."""
    rng = random.Random(1)
    folder = tmp_path / "out"
    write_files(folder, SETS[0])
    ends, gives_up = (time.monotonic() + 1.0 * TIMES * n for n in (1, 30))
    refused = tmp_path / "refused"

    def writer(which: int) -> Callable[[], None]:
        def work() -> None:
            while time.monotonic() < gives_up:
                try:
                    write_files(folder, SETS[which])
                except UsageError:
                    refused.touch()

        return work

    processes = [forked(writer(0)), forked(writer(1))]
    while time.monotonic() < (ends if refused.exists() else gives_up):
        time.sleep(rng.uniform(0.0, 0.02))
        which = rng.randrange(2)
        os.kill(processes[which], signal.SIGKILL)
        os.waitpid(processes[which], 0)
        processes[which] = forked(writer(which))
    for process in processes:
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
    assert found(folder) in SETS
    write_files(folder, SETS[1])
    assert debris(folder) == []
    assert found(folder) == SETS[1]
    assert refused.exists()


TEXT = files.CRANK + files.TABLES


def run(folder: Path, radius: str) -> subprocess.Popen[bytes]:
    command = [*MECHKIN, "analyze", "crank.yaml", "--set", f"r={radius} m", "--quiet"]
    return subprocess.Popen(command, cwd=folder, stdout=-3, stderr=-3)


def tables(folder: Path) -> dict[str, bytes]:
    out = folder / "out/crank"
    paths = sorted(out.iterdir()) if out.is_dir() else []
    files = [path for path in paths if path.is_file() and not path.name.startswith(".")]
    return {path.name: path.read_bytes() for path in files}


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_an_analysis_is_killed(tmp_path: Path, number: signal.Signals) -> None:
    rng = random.Random(int(number))
    (tmp_path / "crank.yaml").write_text(TEXT, encoding="utf-8")
    known = [{}]
    took = 0.0
    for radius in ("1", "2"):
        start = time.monotonic()
        assert run(tmp_path, radius).wait() == 0
        took = time.monotonic() - start
        known.append(tables(tmp_path))
    assert known[1] != known[2]
    for i in range(3 * TIMES):
        process = run(tmp_path, str(1 + i % 2))
        time.sleep(rng.uniform(0.5, 1.05) * took)
        process.send_signal(number)
        process.wait()
        assert tables(tmp_path) in known
    assert run(tmp_path, "1").wait() == 0
    assert tables(tmp_path) == known[1]
    assert debris(tmp_path / "out/crank") == []


def test_the_second_of_two_runs_says_so(tmp_path: Path) -> None:
    """While a long analysis is under way another with the same folder is refused."""
    long = files.CRANK.replace("to: 90, step: 45", "to: 90, step: 1e-4")
    (tmp_path / "long.yaml").write_text(long, encoding="utf-8")
    (tmp_path / "crank.yaml").write_text(TEXT, encoding="utf-8")
    first = subprocess.Popen(
        [*MECHKIN, "analyze", "long.yaml", "--quiet", "--out", "here"], cwd=tmp_path
    )
    while not (tmp_path / "here").is_dir():
        time.sleep(0.01)
        assert first.poll() is None
    second = subprocess.run(
        [*MECHKIN, "analyze", "crank.yaml", "--out", "here"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert (second.returncode, second.stdout) == (2, "")
    assert second.stderr == (
        "mechkin: another run of mechkin is writing to here; wait until it ends, or choose another "
        "folder with --out\n"
    )
    assert first.wait() == 0
    assert sorted(path.name for path in (tmp_path / "here").iterdir()) == [
        LISTING,
        "rows.csv",
        "sweep.csv",
        "sweep.md",
    ]
