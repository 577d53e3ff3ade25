"""A set of files is the old or the new one after a fault or a kill at every operation on files.

The operations are counted by the interpreter's audit events, in a child process that goes down (or
meets an error, or an interrupt) at one of them.
"""

from __future__ import annotations

import errno
import os
import sys
import traceback
from collections.abc import Callable
from pathlib import Path

import pytest

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.folder import OutputFolder, write_files

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))
STEP = 5 if TIMES == 1 else 3
"""Of the operations at which a second kill is tried."""

OLD = {"a.csv": b"old a", "b.md": b"old b", "other.csv": b"of another run"}
NEW = {"a.csv": b"new a", "b.md": b"new b", "c.md": b"new c"}
EVENTS = ("open", "shutil.rmtree")
DONE, REFUSED, KILLED = 0, 2, 9


def files(folder: Path) -> dict[str, bytes]:
    """What a reader of the folder finds by name."""
    return {
        path.name: path.read_bytes()
        for path in sorted(folder.iterdir())
        if path.is_file() and not path.name.startswith(".")
    }


def debris(folder: Path) -> list[str]:
    return [
        path.name for path in folder.iterdir() if path.name.startswith(".") or path.is_symlink()
    ]


def child(work: Callable[[], object], number: int, fault: Callable[[], object]) -> int:
    """The exit code of a process that does the work and meets the fault before an operation on
    files."""
    process = os.fork()
    if process:
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
    count = 0

    def hook(event: str, arguments: object) -> None:
        nonlocal count
        if event in EVENTS or event.startswith("os."):
            count += 1
            if count == number:
                fault()

    try:
        sys.addaudithook(hook)
        work()
        code = DONE if count >= number else 77
    except UsageError:
        code = REFUSED
    except KeyboardInterrupt:
        code = 130
    except BaseException:
        traceback.print_exc()
        code = 70
    os._exit(code)


def fail() -> None:
    raise OSError(errno.EIO, os.strerror(errno.EIO))


def interrupt() -> None:
    raise KeyboardInterrupt


def die() -> None:
    os._exit(KILLED)


@pytest.mark.parametrize("fault", [die, fail, interrupt])
@pytest.mark.parametrize("before", [{}, OLD], ids=["first run", "second run"])
def test_a_fault_at_every_operation(tmp_path: Path, before: dict[str, bytes], fault) -> None:
    seen = set()
    for number in range(1, 500):
        folder = tmp_path / str(number) / "out"
        if before:
            write_files(folder, before)
        code = child(lambda folder=folder: write_files(folder, NEW), number, fault)
        if code == 77:  # all operations were met
            break
        left = files(folder) if folder.is_dir() else {}
        assert left in (before, before | NEW), number
        seen.add(left == before)
        assert code in {die: (KILLED,), fail: (DONE, REFUSED), interrupt: (DONE, 130)}[fault]
        if code == REFUSED:
            assert left == before
        if fault is interrupt and folder.is_dir():
            assert debris(folder) == []
        write_files(folder, {"next.csv": b"next"})
        assert debris(folder) == []
        assert files(folder) == left | {"next.csv": b"next"}
    assert number > 30
    assert seen == {True, False}


@pytest.mark.parametrize("fault", [die, fail, interrupt])
def test_what_is_removed_goes_at_the_same_moment(tmp_path: Path, fault) -> None:
    """No fault leaves the removed file gone and the others old, or the other way round."""
    new = {"a.csv": b"new a"}
    after = {"a.csv": b"new a", "other.csv": OLD["other.csv"]}
    seen = set()
    for number in range(1, 500):
        folder = tmp_path / str(number)
        write_files(folder, OLD)
        code = child(lambda folder=folder: removing(folder, new, ["b.md"]), number, fault)
        if code == 77:
            break
        write_files(folder, {"next.csv": b"next"})
        assert debris(folder) == []
        left = files(folder)
        del left["next.csv"]
        assert left in (OLD, after), number
        seen.add(left == OLD)
    assert seen == {True, False}


def removing(folder: Path, new: dict[str, bytes], removed: list[str]) -> None:
    with OutputFolder(folder) as output:
        output.write(new, removed)


def test_a_kill_while_the_next_run_clears(tmp_path: Path) -> None:
    """Also a run that clears what another left may be killed at every operation."""
    for first in range(20, 60, STEP):
        for second in range(1, 40, STEP):
            folder = tmp_path / f"{first} {second}"
            write_files(folder, OLD)
            child(lambda folder=folder: write_files(folder, NEW), first, die)
            left = files(folder)
            child(lambda folder=folder: write_files(folder, {"next.csv": b"n"}), second, die)
            after = files(folder)
            after.pop("next.csv", None)
            assert after == left
            assert left in (OLD, OLD | NEW)
            write_files(folder, {"next.csv": b"n"})
            assert debris(folder) == []


def test_a_symbolic_link_is_as_it_was_after_a_kill(tmp_path: Path) -> None:
    for number in range(1, 60):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "elsewhere").write_bytes(b"kept")
        (folder / "a.csv").symlink_to("elsewhere")
        child(lambda folder=folder: write_files(folder, NEW), number, die)
        assert (folder / "a.csv").read_bytes() in (b"kept", b"new a")
        is_old = (folder / "a.csv").read_bytes() == b"kept"
        write_files(folder, {"next.csv": b"next"})
        assert (folder / "a.csv").is_symlink() == is_old
        assert not is_old or os.readlink(folder / "a.csv") == "elsewhere"


def test_what_earlier_versions_left_is_cleared(tmp_path: Path) -> None:
    (tmp_path / ".mechkin-0123456789abcdef.tmp").write_bytes(b"half")
    (tmp_path / ".mechkin-notes").write_bytes(b"a user's own")
    write_files(tmp_path, NEW)
    assert debris(tmp_path) == [".mechkin-notes"]


def test_a_folder_that_another_run_writes_to_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    with OutputFolder(folder) as output:
        code = child(lambda: write_files(folder, OLD), 1000, die)
        assert code == REFUSED
        with pytest.raises(UsageError, match=r"another run of mechkin is writing to .*out; wait"):
            write_files(folder, OLD)
        output.write(NEW)
    assert files(folder) == NEW
    write_files(folder, OLD)


def test_a_folder_made_for_nothing_goes_again(tmp_path: Path) -> None:
    with OutputFolder(tmp_path / "out" / "crank"):
        assert (tmp_path / "out" / "crank").is_dir()
    assert list(tmp_path.iterdir()) == []
