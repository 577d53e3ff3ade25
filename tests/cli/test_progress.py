"""Progress: on a terminal alone, after a second, and gone at the end however that comes."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from cli import files

HIDE, SHOW = b"\x1b[?25l", b"\x1b[?25h"
WORK = """
import sys, time
from mechkin_cli.__main__ import end_quietly
from mechkin_cli.cli.messages import say
from mechkin_cli.cli.progress import shown, working
def work():
    if sys.argv[1] != "until shown":
        return time.sleep(float(sys.argv[1]))
    while not shown:
        time.sleep(0.05)
    time.sleep(0.5)
end_quietly()
with working("searching [bold]x[/bold]", quiet=sys.argv[2:] == ["quiet"]) as tell:
    work()
    say("a message")
    tell("still at it")
    work()
"""


def on_terminal(
    *words: str, stop_at: bytes | None = None, work: str = WORK, **settings: str
) -> tuple[int, bytes]:
    """Exit code, and what a terminal of 80 columns gets on stderr; interrupted where it gets some
    bytes for the first time."""
    master, slave = pty.openpty()
    environment = os.environ | {"TERM": "xterm", "COLUMNS": "80"} | settings
    process = subprocess.Popen(
        [sys.executable, "-P", "-c", work, *words], stderr=slave, env=environment
    )
    os.close(slave)
    text = b""
    while True:
        try:
            piece = os.read(master, 4096)
        except OSError:  # how a terminal of Linux ends
            break
        if not piece:
            break
        text += piece
        if stop_at is not None and stop_at in text:
            process.send_signal(signal.SIGINT)
            stop_at = None
    os.close(master)
    return process.wait(), text


def test_after_a_second_on_a_terminal() -> None:
    code, text = on_terminal("until shown")
    assert code == 0
    assert b"searching [bold]x[/bold]" in text
    assert b"still at it" in text
    assert b"a message\r\n" in text
    assert text.count(HIDE) == text.count(SHOW) == 2
    assert text.rindex(SHOW) > text.rindex(HIDE)


COUNTED = """
import time
from mechkin_cli.cli.progress import counting, shown
with counting("coupler_lengths", "variants") as count:
    count(40000, 60000)
    while not shown:
        time.sleep(0.05)
    time.sleep(0.5)
    count(56000, 60000)
    time.sleep(0.5)
"""


def test_a_bar_is_there_before_the_first_piece_and_fits_80_columns() -> None:
    """16000 in 1.5 s or more, whatever was done before: 11 thousand a second at most."""
    code, text = on_terminal(work=COUNTED)
    assert code == 0
    lines = [re.sub(rb"\x1b\[[0-9;?]*[a-zA-Z]", b"", each).decode() for each in text.split(b"\r")]
    assert any(
        re.search(r"\|######----\| 40000/60000 variants 0:\d\d:\d\d", line) for line in lines
    )
    late = next(line for line in lines if "56000/60000" in line)
    assert re.search(r"56000/60000 variants, (\d|10)?\d{3}/s, 0:\d\d left 0:\d\d:\d\d", late)
    assert all(len(line.strip()) < 80 and "\u2026" not in line for line in lines)


@pytest.mark.parametrize("words", [("0.2",), ("1.6", "quiet")])
def test_nothing_of_short_work_or_when_quiet(words: tuple[str, ...]) -> None:
    assert on_terminal(*words) == (0, b"a message\r\n")


def test_nothing_in_a_pipe_or_on_a_dumb_terminal() -> None:
    done = subprocess.run(
        [sys.executable, "-P", "-c", WORK, "1.4"], capture_output=True, timeout=60, check=True
    )
    assert done.stderr == b"a message\n"
    assert on_terminal("1.4", TERM="dumb") == (0, b"a message\r\n")


def test_no_colour_where_none_is_wanted() -> None:
    _, plain = on_terminal("until shown", NO_COLOR="1")
    assert b"searching" in plain
    assert b"\x1b[3" not in plain


def test_an_interrupt_brings_the_line_and_the_cursor_back() -> None:
    code, text = on_terminal("60", stop_at=b"searching")
    assert code == 130
    assert text.count(HIDE) == 1
    assert SHOW in text
    assert text.endswith(
        b"\x1b[2K\x1b[?25hmechkin: interrupted; files written so far are whole\r\n"
    )


COMMAND = """
import sys
from mechkin_cli.cli import progress
progress.AFTER = 0.0
waits = progress._Display.wait
def shows(display):
    waits(display)
    display._timer.join()
progress._Display.wait = shows
from mechkin_cli.cli.app import app
app(sys.argv[1:])
"""
ENDING = {"view": "html", "plot": "svg"}


@pytest.mark.parametrize("command", ["view", "plot"])
def test_pages_and_pictures_say_what_they_are_at(tmp_path: Path, command: str) -> None:
    pytest.importorskip("matplotlib")
    (tmp_path / "crank.yaml").write_text(files.CRANK + files.TABLES)
    words = [command, str(tmp_path / "crank.yaml"), "-o", str(tmp_path / f"out.{ENDING[command]}")]
    if command == "plot":
        words += ["--table", "tip"]
    code, text = on_terminal(*words, work=COMMAND, COLUMNS="200")
    assert code == 0, text
    assert b"crank.yaml: " in text
    assert text.rindex(SHOW) > text.rindex(HIDE)
    code, text = on_terminal(*words, "--quiet", work=COMMAND)
    assert (code, text) == (0, b"")
    piped = subprocess.run(
        [sys.executable, "-P", "-c", COMMAND, *words], capture_output=True, timeout=60, check=True
    )
    assert b"\x1b" not in piped.stderr + piped.stdout
