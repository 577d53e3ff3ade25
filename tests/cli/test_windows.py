"""What differs on Windows, by what can be changed here: the name of the system, functions that are
missing or answer differently, and consoles that are only played."""

from __future__ import annotations

import ctypes
import errno
import io
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from mechkin_cli import load
from mechkin_cli.cli import interrupts, messages, windows
from mechkin_cli.diagnostics import UsageError
from mechkin_cli.reading import read_document, text
from mechkin_cli.studies import workers
from mechkin_cli.tables import file_set, folder


class Renamed:
    """The module `os` as code sees it there: its name, without some functions, with others."""

    def __init__(self, *missing: str, **other: Any) -> None:
        self._missing, self._other = missing, {"name": "nt", **other}

    def __getattr__(self, name: str) -> Any:
        if name in self._missing:
            raise AttributeError(name)
        return self._other[name] if name in self._other else getattr(os, name)


class Console(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name in ("b.yaml", "a.yaml", "c.csv"):
        (tmp_path / name).write_text("", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_patterns_are_expanded_as_a_shell_would(files: Path) -> None:
    words = ["analyze", "*.yaml", "?.csv", "--set", "P1=2*3in", "-*", "x*"]
    expected = ["analyze", "a.yaml", "b.yaml", "c.csv", "--set", "P1=2*3in", "-*", "x*"]
    assert windows.expanded(words) == expected


def played(monkeypatch: pytest.MonkeyPatch, *, console: bool, sets: bool) -> list[tuple[int, int]]:
    """A console that does, or does not, take codes; what it was set to."""
    asked: list[tuple[int, int]] = []

    def set_mode(handle: int, mode: int) -> int:
        asked.append((handle, mode))
        return int(sets)

    def get_mode(handle: int, mode: Any) -> int:
        mode._obj.value = 3
        return int(console)

    kernel = SimpleNamespace(
        GetStdHandle=lambda which: which, GetConsoleMode=get_mode, SetConsoleMode=set_mode
    )
    fake = SimpleNamespace(kernel32=kernel)
    monkeypatch.setattr(ctypes, "windll", fake, raising=False)
    monkeypatch.setattr(sys, "stdout", Console())
    monkeypatch.setattr(sys, "stderr", Console())
    for name in ("NO_COLOR", "TERM"):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)
    return asked


@pytest.mark.parametrize(("console", "sets"), [(True, True), (True, False), (False, True)])
def test_an_older_console_gets_no_codes(
    monkeypatch: pytest.MonkeyPatch, console: bool, sets: bool
) -> None:
    monkeypatch.setattr(sys, "argv", ["mechkin"])
    asked = played(monkeypatch, console=console, sets=sets)
    windows.prepare()
    takes = console and sets
    assert (os.environ.get("NO_COLOR"), os.environ.get("TERM")) == (
        (None, None) if takes else ("1", "dumb")
    )
    if takes:
        assert asked == [(-11, 3 | 4), (-12, 3 | 4)]


def test_lines_end_in_pipes_as_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    pipe = io.BytesIO()
    # as Python opens a pipe there
    stdout = io.TextIOWrapper(pipe, encoding="cp1252", newline="\r\n")
    monkeypatch.setattr(sys, "argv", ["mechkin"])
    monkeypatch.setattr(sys, "stdout", stdout)
    monkeypatch.setattr(sys, "stderr", None)
    windows.prepare()
    messages.put("theta \u2265 1\n")
    assert pipe.getvalue() == b"theta \\u2265 1\n"


def test_the_way_in_prepares_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    from mechkin_cli import __main__

    called: list[bool] = []
    monkeypatch.setattr(windows, "prepare", lambda: called.append(True))
    monkeypatch.setattr(sys, "argv", ["mechkin", "--version"])
    for name, times in (("posix", 0), ("nt", 1)):
        monkeypatch.setattr(__main__, "os", Renamed(name=name))
        with pytest.raises(SystemExit):
            __main__.main()
        assert len(called) == times


@pytest.fixture
def usual() -> Iterator[None]:
    names = ("SIGINT", "SIGTERM", "SIGHUP")
    before = {getattr(signal, name): signal.getsignal(getattr(signal, name)) for name in names}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def test_signals_that_do_not_exist_are_left_out(
    monkeypatch: pytest.MonkeyPatch, usual: None
) -> None:
    taken: list[int] = []
    there = SimpleNamespace(
        **{name: getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIG_DFL")},
        SIGBREAK=21,
        default_int_handler=signal.default_int_handler,
        getsignal=lambda _: signal.SIG_DFL,
        signal=lambda number, _: taken.append(number),
    )
    monkeypatch.setattr(interrupts, "signal", there)
    interrupts.end_quietly()
    assert taken == [signal.SIGINT, signal.SIGTERM, 21]


def test_a_file_is_read_as_its_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert text._FLAGS & getattr(os, "O_BINARY", 0) == getattr(os, "O_BINARY", 0)
    file = tmp_path / "x.yaml"
    file.write_bytes(b"format: 1\r\n\x1a")
    assert text.read_regular(file, 100) == b"format: 1\r\n\x1a"
    # where the system has no other flags, and a text mode
    import importlib.util

    monkeypatch.setattr(os, "O_BINARY", 0x8000, raising=False)
    monkeypatch.delattr(os, "O_NONBLOCK")
    monkeypatch.delattr(os, "O_NOCTTY")
    spec = importlib.util.spec_from_file_location("text_there", text.__file__)
    assert spec is not None
    assert spec.loader is not None
    there = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(there)
    assert there._FLAGS == 0x8000


OLD = {"a.csv": b"1", "b.csv": b"2"}
NEW = {"a.csv": b"10", "b.csv": b"20", "c.csv": b"30"}


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def without_links(source: str, target: str, **_: object) -> None:
    raise NotImplementedError("follow_symlinks unavailable on this platform")


def test_files_are_replaced_without_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise AssertionError("a symbolic link was made")

    monkeypatch.setattr(file_set, "os", Renamed("O_DIRECTORY", "fchmod", symlink=refused))
    for files in (OLD, NEW):
        file_set.replace_files(tmp_path, files)
        assert contents(tmp_path) == files
    file_set.replace_files(tmp_path, {"a.csv": b"0"}, removed=["c.csv", "b.csv"])
    assert contents(tmp_path) == {"a.csv": b"0"}


def test_a_file_that_is_open_elsewhere_leaves_the_old_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a workbook does that shows a table: its file cannot be replaced while it is shown."""
    file_set.replace_files(tmp_path, OLD)

    def replace(source: Any, target: Any) -> None:
        if str(target).endswith("b.csv") and b"20" in Path(source).read_bytes():
            error = PermissionError(errno.EACCES, "Access is denied", str(target))
            error.winerror = 5  # type: ignore[attr-defined,unused-ignore]
            raise error
        os.replace(source, target)

    monkeypatch.setattr(file_set, "os", Renamed(replace=replace, link=without_links))
    monkeypatch.setattr(file_set, "_keep", copied)
    with pytest.raises(UsageError, match=r"b\.csv: no permission .*another program has it open"):
        file_set.replace_files(tmp_path, NEW)
    assert contents(tmp_path) == OLD


def copied(target: str, second: str) -> None:
    """What `_keep` does where there are no second names."""
    if os.path.exists(target):
        Path(second).write_bytes(Path(target).read_bytes())


def test_without_locks_files_are_written_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def cannot(*_: object) -> int:
        raise PermissionError(errno.EACCES, "Permission denied")  # of a folder, there

    monkeypatch.setattr(folder, "os", Renamed("O_DIRECTORY", open=cannot))
    monkeypatch.setitem(sys.modules, "fcntl", None)
    claim = folder.Claim(tmp_path / "out")
    assert not claim.locked
    claim.release()


def test_no_tracker_of_resources_is_started(monkeypatch: pytest.MonkeyPatch) -> None:
    def started() -> None:
        raise ModuleNotFoundError("No module named '_posixsubprocess'")

    monkeypatch.setattr(workers.resource_tracker, "ensure_running", started)
    monkeypatch.setattr(workers, "os", Renamed())
    workers.end_without_warnings()


def test_a_pipe_without_reader_ends_quietly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(messages, "discard", lambda _: None)
    error = OSError(errno.EINVAL, "Invalid argument")
    with pytest.raises(UsageError):
        messages.stdout_failed(error)
    monkeypatch.setattr(messages, "os", Renamed())
    messages.stdout_failed(error)


def test_a_file_on_another_drive_keeps_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    def relpath(*_: object) -> str:
        raise ValueError("path is on mount 'C:', start on mount 'D:'")

    path = SimpleNamespace(relpath=relpath, abspath=os.path.abspath)
    monkeypatch.setenv("GITHUB_WORKSPACE", "/")
    monkeypatch.setattr(messages, "os", Renamed(path=path))
    assert messages._from_the_top("C:\\x.yaml") == "C:\\x.yaml"


FOUR_BAR = Path(__file__).parents[2] / "mechanisms" / "plane" / "planar_four_bar.yaml"


def test_line_ends_of_windows_change_no_place_and_no_number(tmp_path: Path) -> None:
    written = FOUR_BAR.read_bytes()
    assert b"\r" not in written
    file = tmp_path / FOUR_BAR.name
    file.write_bytes(b"\xef\xbb\xbf" + written.replace(b"\n", b"\r\n"))
    assert place_of_joints(file) == place_of_joints(FOUR_BAR)
    one, other = load(FOUR_BAR).analyze(), load(file).analyze()
    assert [*other] == [*one] != []
    assert all(other[name].tobytes() == one[name].tobytes() for name in one)


def place_of_joints(file: Path) -> tuple[int, int]:
    place = read_document(file).place(("joints",))
    return place.line, place.column
