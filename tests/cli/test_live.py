"""`mechkin view --live` as a process: what it prints, and how it ends."""

from __future__ import annotations

import json
import os
import pty
import re
import signal
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from cli import files
from cli.conftest import Mechkin

from mechkin_cli.cli.messages import ExitCode

COMMAND = [sys.executable, "-P", "-m", "mechkin_cli", "view", "--live", "--no-open", "crank.yaml"]
NUMBERS = {
    **{f"joints.O.point.{axis}": 0 for axis in "xyz"},
    **{f"points.tip.at.{axis}": 0 for axis in "yz"},
    "links.arm.mass": 1,
}
"""Of the file, beside its parameter."""


@contextmanager
def served(folder: Path, text: str, stderr: int = subprocess.PIPE) -> Iterator[subprocess.Popen]:
    (folder / "crank.yaml").write_text(text, encoding="utf-8")
    with subprocess.Popen(
        COMMAND, cwd=folder, stdout=subprocess.PIPE, stderr=stderr, text=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def first_news(address: str) -> dict:
    with urllib.request.urlopen(f"{address}news", timeout=60) as stream:
        found: dict = json.loads(next(line for line in stream if line.startswith(b"data:"))[5:])
    return found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_serves_until_it_is_ended_and_is_quiet_in_a_pipe(tmp_path: Path, number: int) -> None:
    with served(tmp_path, files.CRANK) as process:
        address = process.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{24}/", address)
        if number == signal.SIGINT:
            assert first_news(address)["picture"]["parameters"] == {"r": 2, **NUMBERS}
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
        assert (process.returncode, out, err) == (ExitCode.OK, "", "")
    assert [path.name for path in tmp_path.iterdir()] == ["crank.yaml"]


def test_a_terminal_is_told_of_faults(tmp_path: Path) -> None:
    ours, theirs = pty.openpty()
    with served(tmp_path, files.INVALID, theirs) as process:
        address = process.stdout.readline().strip()
        assert first_news(address)["faults"][0]["line"] == 5
        process.send_signal(signal.SIGINT)
        process.wait(60)
        told = os.read(ours, 10_000).decode()
    os.close(ours), os.close(theirs)
    assert "crank.yaml is followed; Ctrl-C ends" in told
    assert "crank.yaml:5:" in told
    assert "did you mean arm?" in told


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["crank.yaml", "-o", "page.html"], "--live writes no page"),
        (["crank.yaml", "--set", "r=1m"], "--live shows the file as it is"),
        (["-"], "a file is followed; save the text in a file and name it"),
        (["crnak.yaml"], "there is no file crnak.yaml"),
        (["."], "is a directory"),
    ],
)
def test_what_cannot_be_followed_is_refused(mechkin: Mechkin, words: list[str], told: str) -> None:
    run = mechkin("view", "--live", "--no-open", *words)
    assert (run.code, run.out) == (ExitCode.USAGE, "")
    assert told in run.err
