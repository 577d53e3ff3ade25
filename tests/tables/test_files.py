"""Writing files: all of them whole, or none."""

import errno
import os
from pathlib import Path

import pytest

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import file_set
from mechkin_cli.tables.folder import write_files

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


def test_existing_files_are_replaced(tmp_path):
    write_files(tmp_path, {"a.csv": b"a much longer old content"})
    write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == CONTENT


@pytest.mark.parametrize("size", [0, 5, 1 << 16, (1 << 16) + 1])
def test_a_file_of_the_same_content_stays_with_a_new_date(tmp_path, size):
    same, other = b"." * size, b"." * size + b"old"
    write_files(tmp_path, {"same.csv": same, "other.csv": other, "longer.csv": same})
    for path in tmp_path.iterdir():
        os.utime(path, (1, 1))
    before = {path.name: path.stat().st_ino for path in tmp_path.iterdir()}
    new = {"same.csv": same, "other.csv": b"." * size + b"new", "longer.csv": same + b"."}
    write_files(tmp_path, new)
    assert everything(tmp_path) == new
    assert [name for name in new if (tmp_path / name).stat().st_ino == before[name]] == ["same.csv"]
    assert all((tmp_path / name).stat().st_mtime > 1 for name in new)


def test_a_link_to_the_same_content_becomes_a_file(tmp_path):
    (tmp_path / "elsewhere").write_bytes(CONTENT["a.csv"])
    (tmp_path / "a.csv").symlink_to("elsewhere")
    write_files(tmp_path, CONTENT)
    assert not (tmp_path / "a.csv").is_symlink()


def test_new_files_have_the_usual_permissions(tmp_path):
    (tmp_path / "plain").write_bytes(b"")
    write_files(tmp_path, CONTENT)
    assert (tmp_path / "a.csv").stat().st_mode == (tmp_path / "plain").stat().st_mode


def fail_after(monkeypatch, calls: int, error: BaseException):
    """Let the writing of the file after `calls` others fail when half of it is written."""
    whole, seen = file_set._write, []

    def write(path, content):
        seen.append(path)
        if len(seen) > calls:
            Path(path).write_bytes(content[:2])
            raise error
        whole(path, content)

    monkeypatch.setattr(file_set, "_write", write)


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


OLD = {"a.csv": b"old", "c.csv": b"not of this run"}


def test_a_file_that_cannot_even_be_begun_leaves_the_old_one(tmp_path, monkeypatch):
    write_files(tmp_path, OLD)

    def write(path, content):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(file_set, "_write", write)
    with pytest.raises(UsageError):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD


def without(monkeypatch, name: str) -> None:
    def refused(*_, **__):
        raise OSError(errno.EPERM, os.strerror(errno.EPERM))

    monkeypatch.setattr(os, name, refused)


@pytest.mark.parametrize("missing", [["link"], ["symlink"], ["link", "symlink"]])
def test_file_systems_without_links(tmp_path, monkeypatch, missing):
    for name in missing:
        without(monkeypatch, name)
    write_files(tmp_path, OLD)
    write_files(tmp_path, {"a.csv": b"newer"})
    assert everything(tmp_path) == OLD | {"a.csv": b"newer"}
    write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD | CONTENT


@pytest.mark.parametrize("missing", [["symlink"], ["link", "symlink"]])
def test_without_symbolic_links_a_failure_is_taken_back(tmp_path, monkeypatch, missing):
    write_files(tmp_path, OLD)
    for name in missing:
        without(monkeypatch, name)
    whole = os.replace

    def replace(source, target):
        if target == tmp_path / "b.md":
            raise OSError(errno.EIO, "broken")
        return whole(source, target)

    monkeypatch.setattr(os, "replace", replace)
    with pytest.raises(UsageError):
        write_files(tmp_path, CONTENT)
    assert everything(tmp_path) == OLD


@pytest.mark.parametrize("to", ["elsewhere", "nowhere"])
def test_a_symbolic_link_is_replaced(tmp_path, to):
    (tmp_path / "elsewhere").write_bytes(b"kept")
    (tmp_path / "a.csv").symlink_to(to)
    write_files(tmp_path, CONTENT)
    assert not (tmp_path / "a.csv").is_symlink()
    assert everything(tmp_path) == CONTENT | {"elsewhere": b"kept"}


def test_special_files_are_never_replaced(tmp_path):
    os.mkfifo(tmp_path / "a.csv")
    (tmp_path / "b.md").symlink_to("/dev/null")
    for name in CONTENT:
        message = refusal(tmp_path, {"c": b"", name: b""})
        assert "a device or a pipe stands there" in message
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "b.md"]


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
