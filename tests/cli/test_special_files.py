"""No special file makes a command wait, crash or grow: as input, beside it, or where it writes."""

from __future__ import annotations

import os
import socket
import stat
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from cli import files
from cli.test_processes import MECHKIN

import mechkin_cli as mk
from mechkin_cli.reading.text import NotRegular, read_regular


def fifo(path: Path) -> None:
    os.mkfifo(path)


def unix_socket(path: Path) -> None:
    place = socket.socket(socket.AF_UNIX)
    here = Path.cwd()
    os.chdir(path.parent)  # names of sockets are short
    place.bind(path.name)
    os.chdir(here)
    place.close()


def link_to(target: str) -> Callable[[Path], None]:
    return lambda path: path.symlink_to(target)


KINDS: dict[str, Callable[[Path], None]] = {
    "fifo": fifo,
    "socket": unix_socket,
    "folder": Path.mkdir,
    "/dev/zero": link_to("/dev/zero"),
    "/dev/full": link_to("/dev/full"),
    "/dev/tty": link_to("/dev/tty"),
    "/dev/stdin": link_to("/dev/stdin"),
    "/proc/kmsg": link_to("/proc/kmsg"),
    "/proc/self/mem": link_to("/proc/self/mem"),
    "/proc/self/pagemap": link_to("/proc/self/pagemap"),
    "/proc/cpuinfo": link_to("/proc/cpuinfo"),
    "itself": link_to("x.yaml"),
    "nothing": link_to("no/where"),
}
COMMANDS = [
    ["analyze", "x.yaml"],
    ["check", "x.yaml"],
    ["modes", "x.yaml"],
    ["mobility", "x.yaml"],
    ["ranges", "x.yaml"],
    ["tables", "x.yaml"],
    ["tables", "x.yaml", "--check"],
    ["tables", "."],
    ["schema", "--check", "--out", "x.yaml"],
]


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    reader, writer = os.pipe()  # a stdin that never says anything
    done = subprocess.run(
        [*MECHKIN, *arguments],
        cwd=folder,
        stdin=reader,
        capture_output=True,
        text=True,
        timeout=30,
        check=False,
    )
    os.close(reader), os.close(writer)
    return done


@pytest.mark.parametrize("kind", KINDS)
def test_as_input(tmp_path: Path, kind: str) -> None:
    KINDS[kind](tmp_path / "x.yaml")
    commands = COMMANDS if kind in ("fifo", "/dev/zero", "/proc/kmsg") else COMMANDS[:2]
    for command in commands:
        found = run(tmp_path, *command)
        assert found.returncode in (1, 2, 3), command
        assert "Traceback" not in found.stderr
        assert "internal error" not in found.stderr


BESIDE = """\
tables: [{name: t, columns: [O.theta], published: beside.csv}]
loads: [{type: torque, joint: O, value: {table: beside.csv}}]
"""


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("line", BESIDE.splitlines(), ids=["published", "table"])
def test_beside_a_file(tmp_path: Path, kind: str, line: str) -> None:
    (tmp_path / "crank.yaml").write_text(f"{files.CRANK}{line}\n")
    KINDS[kind](tmp_path / "beside.csv")
    found = run(tmp_path, "tables", "crank.yaml")
    assert found.returncode in (2, 3)
    assert "beside.csv" in found.stderr
    assert "Traceback" not in found.stderr
    assert "internal error" not in found.stderr


@pytest.mark.parametrize("kind", KINDS)
def test_where_tables_are_written(tmp_path: Path, kind: str) -> None:
    (tmp_path / "crank.yaml").write_text(files.CRANK)
    (tmp_path / "crank").mkdir()
    path = tmp_path / "crank" / "sweep.csv"
    KINDS[kind](path)
    is_special = path.exists() and not stat.S_ISREG(path.stat().st_mode)
    assert run(tmp_path, "tables", "crank.yaml", "--check").returncode in (1, 2)
    found = run(tmp_path, "tables", "crank.yaml")
    assert found.returncode == (2 if is_special else 0), found.stderr
    assert path.is_file() != is_special
    names = sorted(child.name for child in path.parent.iterdir())
    written = ["picture.svg", "sweep.csv", "sweep.md"]
    assert names == (["sweep.csv"] if is_special else written)


def test_a_device_is_never_replaced_by_the_schema() -> None:
    mode = os.stat("/dev/null").st_mode
    found = run(Path("/"), "schema", "--out", "/dev/null")
    assert found.returncode == 2
    assert "a device or a pipe stands there" in found.stderr
    assert os.stat("/dev/null").st_mode == mode


def test_what_a_page_of_an_overview_stands_for(tmp_path: Path) -> None:
    (tmp_path / "crank.yaml").write_text(files.CRANK)
    os.mkfifo(tmp_path / "README.md")
    for arguments in (["tables", ".", "--check"], ["tables", "."]):
        found = run(tmp_path, *arguments)
        assert found.returncode in (1, 2)
        assert "Traceback" not in found.stderr


def test_no_more_is_read_than_asked_for(tmp_path: Path) -> None:
    (tmp_path / "long").write_bytes(b"x" * 100)
    assert read_regular(tmp_path / "long", 10) == b"x" * 11
    assert read_regular(tmp_path / "long", 100) == b"x" * 100
    with pytest.raises(NotRegular, match="a folder"):
        read_regular(tmp_path, 10)


LIMITED = {
    "size": files.CRANK + "# " + "x" * (1 << 22),
    "bytes": files.CRANK + "# " + "\U0001f600" * (1 << 20),
    "depth": files.CRANK + "loads: " + "[" * 100_000,
    "mappings": files.CRANK + "loads: " + "{a: " * 50_000,
    "events": files.CRANK + "loads: [" + "1, " * 1_100_000 + "1]",
    "half characters": files.CRANK + "# \ud800",
    "controls": files.CRANK + "# \x00",
    "anchors": files.CRANK + "source: &a b",
}


@pytest.mark.parametrize("which", LIMITED)
def test_a_text_has_the_limits_of_a_file(tmp_path: Path, which: str) -> None:
    text = LIMITED[which]
    with pytest.raises(mk.InvalidFile) as by_text:
        mk.loads(text, "m.yaml")
    content = text.encode("utf-8", "surrogatepass")
    (tmp_path / "m.yaml").write_bytes(content)
    with pytest.raises(mk.InvalidFile) as by_file:
        mk.load(tmp_path / "m.yaml")
    codes = [[found.code for found in each.value.diagnostics] for each in (by_text, by_file)]
    if which != "half characters":  # no bytes of a file are half a character
        assert codes[0] == codes[1]
