"""`-` is the text on stdin: as good as a file, and as well guarded."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from cli import files

MECHKIN = [sys.executable, "-P", "-m", "mechkin_cli"]
BOM = b"\xef\xbb\xbf"


def run(folder: Path, text: bytes, *words: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [*MECHKIN, *words], cwd=folder, input=text, capture_output=True, timeout=60, check=False
    )


@pytest.mark.parametrize("command", ["analyze", "check", "modes", "ranges", "mobility"])
def test_what_is_said_is_what_is_said_of_the_file(tmp_path: Path, command: str) -> None:
    (tmp_path / "crank.yaml").write_text(files.CRANK)
    piped = run(tmp_path, files.CRANK.encode(), command, "-", "--json")
    named = run(tmp_path, b"", command, "crank.yaml", "--json")
    assert (piped.returncode, piped.stderr) == (0, b"")
    assert piped.stdout.replace(b'"stdin"', b'"crank.yaml"') == named.stdout


@pytest.mark.parametrize(
    "text",
    [
        files.CRANK.encode(),
        BOM + files.CRANK.encode(),
        files.CRANK.replace("\n", "\r\n").encode(),
        files.CRANK.replace("\n", "\r").encode(),
    ],
    ids=["plain", "byte order mark", "CRLF", "CR"],
)
def test_files_are_written_below_the_name_stdin(tmp_path: Path, text: bytes) -> None:
    assert run(tmp_path, text, "analyze", "-", "--quiet").returncode == 0
    written = tmp_path / "out" / "stdin" / "sweep.csv"
    assert written.read_text().splitlines()[1] == "0,3,0"


def test_files_that_the_text_names_are_sought_in_the_working_folder(tmp_path: Path) -> None:
    (tmp_path / "push.csv").write_text("theta,torque\n0,1\n30,2\n60,3\n90,4\n")
    load = "loads: [{type: torque, joint: O, value: {table: push.csv}}]\n"
    found = json.loads(
        run(tmp_path, (files.CRANK + load).encode(), "analyze", "-", "--json").stdout
    )
    labels = {column["label"]: column["values"] for column in found["tables"][0]["columns"]}
    assert labels["O.effort"] == pytest.approx([-1.0, -2.5, -4.0], abs=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"", b"stdin:1:1: error: the file is empty"),
        (b"\x00", b"stdin:1:1: error: a NUL character"),
        (b"format: 1\nname: \xff\n", b"stdin:2:7: error: the byte 0xFF is not UTF-8"),
        (files.CRANK.encode("utf-16"), b"stdin:1:1: error: the file is UTF-16"),
        (files.INVALID.encode(), b"stdin:5:39: error: "),
        (b"#" * 5_000_000, b"stdin:1:1: error: the file is too large"),
    ],
)
def test_hostile_text(tmp_path: Path, text: bytes, words: bytes) -> None:
    done = run(tmp_path, text, "analyze", "-")
    assert (done.returncode, done.stdout) == (3, b"")
    assert done.stderr.startswith(words), done.stderr
    assert not (tmp_path / "out").exists()


def test_a_stream_without_end_is_left_early(tmp_path: Path) -> None:
    with open("/dev/zero", "rb") as zeros:
        done = subprocess.run(
            [*MECHKIN, "check", "-"], stdin=zeros, capture_output=True, timeout=60, check=False
        )
    assert done.returncode == 3
    assert b"too large" in done.stderr


def test_closed_stdin() -> None:
    command = f"{' '.join(MECHKIN)} check - <&-"
    done = subprocess.run(command, shell=True, capture_output=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (2, b"")
    assert b"stdin is closed" in done.stderr


@pytest.mark.parametrize("words", [["tables", "-"], ["bench", "-"]])
def test_commands_that_need_a_file_say_so(tmp_path: Path, words: list[str]) -> None:
    done = run(tmp_path, files.CRANK.encode(), *words)
    assert done.returncode == 2
    assert b"save the text in a file and name it" in done.stderr


def test_a_picture_of_a_text(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    done = run(tmp_path, files.CRANK.encode(), "plot", "-")
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "out" / "stdin").glob("*.svg"))
