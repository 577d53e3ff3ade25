"""A disk that is full, files that may not grow, two processes that write to one folder."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from references import FILE_OF
from studies.studies import study_text
from studies.test_folders import contents

STUDY = {
    "vary": {
        "P1": {"from": "0.45 in", "to": "0.55 in", "count": 30},
        "P2": {"from": "0.8 in", "to": "0.85 in", "count": 30},
    },
    "keep": [{"of": "O1.effort", "as": ["peak", "rms", "max", "min"]}],
}
SMALL = 32 * 1024
"""Bytes; the results take about 90 kB."""


def command(tmp_path: Path, out: Path) -> list[str]:
    study = tmp_path / "study.yaml"
    study.write_text(study_text(STUDY, FILE_OF["rcsr"]))
    return [sys.executable, "-P", "-m", "mechkin_cli", "study", str(study), "--out", str(out)]


def run(words: list[str], limit: int = 0) -> subprocess.CompletedProcess[str]:
    def limited() -> None:
        if limit:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.run(words, check=False, capture_output=True, text=True, preexec_fn=limited)


def whole(tmp_path: Path) -> dict[str, bytes]:
    assert run(command(tmp_path, tmp_path / "whole")).returncode == 0
    return contents(tmp_path / "whole")


def test_a_disk_that_is_full(tmp_path: Path) -> None:
    """A file system of 32 kB, where one may be mounted."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounting = ["mount", "-t", "tmpfs", "-o", f"size={SMALL}", "tmpfs", str(disk)]
    if os.geteuid() != 0 or run(mounting).returncode != 0:
        pytest.skip("no file system can be mounted here")
    try:
        words = command(tmp_path, disk / "out")
        first = run(words)
        assert first.returncode == 2
        assert "the disk is full; free some space; the variants computed so far" in first.stderr
        assert "Traceback" not in first.stderr
        # whole pieces stay, but nothing that is half written, and no results
        assert not list(disk.rglob("*.unfinished"))
        assert not list((disk / "out").glob("*.csv"))
        run(["mount", "-o", "remount,size=4m", str(disk)])
        assert run(words).returncode == 0
        assert contents(disk / "out") == whole(tmp_path)
    finally:
        run(["umount", str(disk)])


def test_files_that_may_not_grow(tmp_path: Path) -> None:
    words = command(tmp_path, tmp_path / "out")
    first = run(words, SMALL)
    assert first.returncode == 2
    assert "File too large" in first.stderr
    assert "Traceback" not in first.stderr
    assert run(words).returncode == 0
    assert contents(tmp_path / "out") == whole(tmp_path)


def test_two_processes_and_one_folder(tmp_path: Path) -> None:
    words = command(tmp_path, tmp_path / "out")
    record = tmp_path / "out" / "study.json"
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as first:
        until = time.monotonic() + 60.0
        while not record.exists() and first.poll() is None and time.monotonic() < until:
            time.sleep(0.001)
        first.send_signal(signal.SIGSTOP)
        held = first.poll() is None
        second = run(words)
        first.send_signal(signal.SIGCONT)
        assert first.wait() == 0
    if not held:
        pytest.skip("the first had ended before it was stopped")
    assert second.returncode == 2
    assert "another run of mechkin is writing to" in second.stderr
    assert contents(tmp_path / "out") == whole(tmp_path)
