"""Writing files: all of them whole, or none."""

import errno
import os
from pathlib import Path

import pytest

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import files
from mechkin_cli.tables.files import write_files

CONTENT = {"a.csv": b"x\n1\n", "b.md": b"# b\n"}


def everything(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_files_are_written_and_folders_made(tmp_path):
    written = write_files(tmp_path / "out" / "rcsr", CONTENT)
    assert everything(tmp_path) == {"out/rcsr/a.csv": b"x\n1\n", "out/rcsr/b.md": b"# b\n"}
    assert written == [tmp_path / "out/rcsr/a.csv", tmp_path / "out/rcsr/b.md"]


def test_names_may_hold_folders(tmp_path):
    write_files(tmp_path, {"one/a.csv": b"1", "two/a.csv": b"2"})
    assert everything(tmp_path) == {"one/a.csv": b"1", "two/a.csv": b"2"}


def test_existing_files_are_replaced(tmp_path):
    write_files(tmp_path, {"a.csv": b"a much longer old content"})
    write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == CONTENT


def test_new_files_have_the_usual_permissions(tmp_path):
    (tmp_path / "plain").write_bytes(b"")
    write_files(tmp_path, CONTENT)
    assert (tmp_path / "a.csv").stat().st_mode == (tmp_path / "plain").stat().st_mode


def fail_after(monkeypatch, calls: int, error: BaseException):
    """Let the writing of the file after `calls` others fail when half of it is written."""
    whole, seen = files._write, []

    def write(path, content):
        seen.append(path)
        if len(seen) > calls:
            path.write_bytes(content[:2])
            raise error
        whole(path, content)

    monkeypatch.setattr(files, "_write", write)


@pytest.mark.parametrize("calls", [0, 1])
@pytest.mark.parametrize(
    ("error", "raised"),
    [
        (KeyboardInterrupt(), KeyboardInterrupt),
        (MemoryError(), MemoryError),
        (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), UsageError),
    ],
)
def test_a_failure_leaves_nothing_behind(tmp_path, monkeypatch, calls, error, raised):
    fail_after(monkeypatch, calls, error)
    with pytest.raises(raised):
        write_files(tmp_path / "new" / "folder", CONTENT)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_leaves_old_files_as_they_were(tmp_path, monkeypatch):
    old = {"a.csv": b"old", "b.md": b"old too"}
    write_files(tmp_path, old)
    fail_after(monkeypatch, 1, KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == old


def fail_at_rename(monkeypatch, calls: int, error: BaseException, *, done: bool = False):
    """Let the rename of the file after `calls` others fail, before or after it is `done`."""
    whole, seen = Path.replace, []

    def replace(self, target):
        if self.suffix == ".tmp":
            seen.append(target)
        if len(seen) == calls + 1 and self.suffix == ".tmp":
            if done:
                whole(self, target)
            raise error
        return whole(self, target)

    monkeypatch.setattr(Path, "replace", replace)


OLD = {"a.csv": b"old", "c.csv": b"not of this run"}


@pytest.mark.parametrize("calls", [0, 1])
@pytest.mark.parametrize("done", [False, True], ids=["before", "after"])
@pytest.mark.parametrize(
    ("error", "raised"),
    [(KeyboardInterrupt(), KeyboardInterrupt), (OSError(errno.EIO, "broken"), UsageError)],
)
def test_a_failure_among_the_renames_brings_the_old_files_back(
    tmp_path, monkeypatch, calls, done, error, raised
):
    write_files(tmp_path, OLD)
    fail_at_rename(monkeypatch, calls, error, done=done)
    with pytest.raises(raised):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD


def test_old_files_come_back_without_hard_links(tmp_path, monkeypatch):
    def no_links(*_, **__):
        raise OSError(errno.EPERM, os.strerror(errno.EPERM))

    monkeypatch.setattr(os, "link", no_links)
    write_files(tmp_path, OLD)
    write_files(tmp_path, {"a.csv": b"newer"})
    assert everything(tmp_path) == OLD | {"a.csv": b"newer"}
    fail_at_rename(monkeypatch, 1, OSError(errno.EIO, "broken"))
    with pytest.raises(UsageError):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD | {"a.csv": b"newer"}


def test_interrupts_while_cleaning_up_do_not_stop_it(tmp_path, monkeypatch):
    write_files(tmp_path, OLD)
    fail_at_rename(monkeypatch, 1, KeyboardInterrupt())
    whole, impatient = Path.unlink, iter(range(5))

    def unlink(self, missing_ok=False):
        for _ in impatient:
            raise KeyboardInterrupt
        whole(self, missing_ok)

    monkeypatch.setattr(Path, "unlink", unlink)
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD


def test_an_interrupt_after_the_last_rename_leaves_the_new_files(tmp_path, monkeypatch):
    write_files(tmp_path, OLD)
    whole, impatient = Path.unlink, iter([None])

    def unlink(self, missing_ok=False):
        for _ in impatient:
            raise KeyboardInterrupt
        whole(self, missing_ok)

    monkeypatch.setattr(Path, "unlink", unlink)
    with pytest.raises(KeyboardInterrupt):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD | CONTENT


def test_a_file_that_cannot_even_be_begun_leaves_the_old_one(tmp_path, monkeypatch):
    write_files(tmp_path, OLD)

    def write(path, content):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(files, "_write", write)
    with pytest.raises(UsageError):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD


def test_a_symbolic_link_is_replaced_and_comes_back(tmp_path, monkeypatch):
    (tmp_path / "elsewhere").write_bytes(b"kept")
    (tmp_path / "a.csv").symlink_to("elsewhere")
    fail_at_rename(monkeypatch, 1, OSError(errno.EIO, "broken"))
    with pytest.raises(UsageError):
        write_files(tmp_path, CONTENT)
    assert (tmp_path / "a.csv").is_symlink()
    monkeypatch.undo()
    write_files(tmp_path, CONTENT)
    assert not (tmp_path / "a.csv").is_symlink()
    assert everything(tmp_path) == CONTENT | {"elsewhere": b"kept"}


def refusal(folder: Path, content=CONTENT) -> str:
    with pytest.raises(UsageError) as caught:
        write_files(folder, content)
    return str(caught.value)


@pytest.mark.parametrize("below", ["file", "file/deeper"])
def test_a_file_in_place_of_a_folder(tmp_path, below):
    (tmp_path / "file").write_bytes(b"kept")
    message = refusal(tmp_path / below)
    assert str(tmp_path / below / "a.csv") in message
    assert "a file stands where a folder is needed" in message
    assert "--out" in message
    assert everything(tmp_path) == {"file": b"kept"}


@pytest.mark.parametrize("below", ["round", "round/deeper", "nowhere"])
def test_links_that_lead_nowhere(tmp_path, below):
    (tmp_path / "round").symlink_to("round")
    (tmp_path / "nowhere").symlink_to("missing/folder")
    assert "a symbolic link there leads nowhere" in refusal(tmp_path / below)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["nowhere", "round"]


def test_a_folder_in_place_of_a_file(tmp_path):
    (tmp_path / "b.md").mkdir()
    message = refusal(tmp_path)
    assert "b.md" in message
    assert "a folder stands where a file is to be written" in message
    assert everything(tmp_path) == {}


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.ENOSPC, "the disk is full; free some space"),
        (errno.EACCES, "no permission to write there"),
        (errno.EROFS, "the file system is read-only"),
        (errno.EIO, os.strerror(errno.EIO)),
    ],
)
def test_refusals_say_the_cure(tmp_path, monkeypatch, number, words):
    fail_after(monkeypatch, 0, OSError(number, os.strerror(number)))
    message = refusal(tmp_path)
    assert words in message
    assert "--out" in message


def test_a_name_that_is_too_long(tmp_path):
    assert "the name is too long" in refusal(tmp_path / ("x" * 300))
    assert list(tmp_path.iterdir()) == []
