"""Files of a run that are written as they come: they take their places together, or none does."""

from __future__ import annotations

import errno
import gc
import io
import os
import resource
import signal
from pathlib import Path

import pytest
from tables.streamed import cut, random_table
from tables.test_file_set import DONE, KILLED, REFUSED, child, debris, die, fail, files, interrupt

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables import (
    OutputFolder,
    TableStream,
    TableWriter,
    file_set,
    folder as room,
    heading_of,
    stream_of,
    write_table,
)
from mechkin_cli.tables.csv import CsvStyle, TextRoom
from mechkin_cli.tables.writers import STREAM_FORMATS
from mechkin_cli.tolerances import HELD_BYTES, TEXT_ROOM

OLD = {"a.csv": b"old a" * 9, "b.md": b"old b", "other.csv": b"of the run before" * 9}
NEW = {"a.csv": b"new a" * 9, "b.md": b"new b", "c.csv": b"new c" * 9}


def write_run(folder: Path, content: dict[str, bytes]) -> None:
    """A run that writes its files in parts, the large ones into the attempt's folder."""
    with OutputFolder(folder) as output:
        for name, data in content.items():
            with output.begin(name) as file, room.refusal(file.target):
                for start in range(0, len(data), 7):
                    file.write(data[start : start + 7])
        output.write_run()


def has_unnamed_files(folder: Path) -> bool:
    """Whether the system and the file system of the folder have them."""
    try:
        room._open_unnamed(folder).close()
    except OSError:
        return False
    return True


@pytest.fixture(params=["named", "unnamed", "some unnamed", "copied"])
def little_held(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Files of more than 20 bytes are on the disk: named at once, unnamed until the set is
    complete, some of each, or unnamed and then copied, where they cannot be linked."""
    monkeypatch.setattr(room, "HELD_BYTES", 20)
    link = os.link

    def no_link(source, *given, **named) -> None:
        if str(source).startswith("/proc/"):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))
        link(source, *given, **named)

    if request.param == "named":
        monkeypatch.delattr(os, "O_TMPFILE", raising=False)
    elif request.param == "some unnamed":
        monkeypatch.setattr(room, "MOST_UNNAMED", 1)
    elif request.param == "copied":
        monkeypatch.setattr(os, "link", no_link)
    return request.param


@pytest.mark.parametrize("little_held", ["some unnamed"], indirect=True)
@pytest.mark.usefixtures("little_held")
@pytest.mark.parametrize("fault", [die, fail, interrupt])
@pytest.mark.parametrize("before", [{}, OLD], ids=["first run", "second run"])
def test_a_fault_at_every_operation(tmp_path: Path, before: dict[str, bytes], fault) -> None:
    """What the run before wrote goes at the same moment, too."""
    seen = set()
    for number in range(1, 500):
        folder = tmp_path / str(number) / "out"
        if before:
            write_run(folder, before)
        code = child(lambda folder=folder: write_run(folder, NEW), number, fault)
        if code == 77:  # all operations were met
            break
        left = files(folder) if folder.is_dir() else {}
        # where the listing cannot be read, nothing is known to be of the run before
        beside = {"other.csv": OLD["other.csv"]} if fault is fail and before else {}
        assert left in (before, NEW, NEW | beside), number
        seen.add(left == before)
        assert code in {die: (KILLED,), fail: (DONE, REFUSED), interrupt: (DONE, 130)}[fault]
        if code == REFUSED:
            assert left == before
        if fault is interrupt and folder.is_dir():
            assert debris(folder) in ([], [room.LISTING])
        write_run(folder, {"next.csv": b"next" * 9})
        assert debris(folder) == [room.LISTING]
        assert files(folder) == {"next.csv": b"next" * 9} | (beside if left == NEW | beside else {})
    assert number > 30
    assert seen == {True, False}


@pytest.mark.usefixtures("little_held")
def test_a_small_file_that_is_as_before_stays_and_a_large_one_is_replaced(tmp_path: Path) -> None:
    write_run(tmp_path, OLD)
    before = {name: (tmp_path / name).stat().st_ino for name in OLD}
    write_run(tmp_path, OLD)
    assert files(tmp_path) == OLD
    assert [n for n in OLD if (tmp_path / n).stat().st_ino == before[n]] == ["b.md"]


@pytest.mark.usefixtures("little_held")
def test_a_file_that_is_begun_again_is_the_last_one(tmp_path: Path) -> None:
    with OutputFolder(tmp_path) as output:
        for content in (b"1" * 50, b"2" * 5, b"3" * 60):
            output.add("a.csv", content)
        written, _, _ = output.write_run()
    assert (files(tmp_path), written) == ({"a.csv": b"3" * 60}, [tmp_path / "a.csv"])


def test_an_error_of_the_run_leaves_nothing(tmp_path: Path, little_held: str) -> None:
    write_run(tmp_path, OLD)
    hidden = 2 if little_held == "named" or not has_unnamed_files(tmp_path) else 1

    def fails() -> None:
        with OutputFolder(tmp_path) as output, output.begin("a.csv") as file:
            file.write(b"x" * 100)
            assert len(debris(tmp_path)) == hidden
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fails()
    assert (files(tmp_path), debris(tmp_path)) == (OLD, [room.LISTING])


@pytest.mark.usefixtures("little_held")
def test_more_files_than_descriptors(tmp_path: Path) -> None:
    """Unnamed files are open until the set is complete, so there are not many of them."""
    code = child(lambda: _many_files(tmp_path), 10**9, die)
    assert code == 77
    assert len(files(tmp_path)) == 300


def _many_files(folder: Path) -> None:
    resource.setrlimit(resource.RLIMIT_NOFILE, (150, 150))
    write_run(folder, {f"{i}.csv": b"x" * 30 for i in range(300)})


@pytest.mark.parametrize("before", [{}, OLD], ids=["first run", "second run"])
def test_a_run_that_is_killed_before_its_end_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, before: dict[str, bytes]
) -> None:
    """Not even hidden."""
    if not has_unnamed_files(tmp_path):
        pytest.skip("a file system without unnamed files")
    monkeypatch.setattr(room, "HELD_BYTES", 20)
    write_run(tmp_path, before)
    found = sorted(tmp_path.iterdir())

    def dies() -> None:
        with OutputFolder(tmp_path) as output:
            for name in ("a.csv", "c.csv"):
                output.add(name, b"new" * 30)
            with output.begin("d.csv") as file:
                file.write(b"x" * 30)
                os.kill(os.getpid(), signal.SIGKILL)

    assert child(dies, 10**9, die) == -signal.SIGKILL
    assert sorted(tmp_path.iterdir()) == found


def test_files_get_their_permissions_from_the_user(tmp_path: Path, little_held: str) -> None:
    before = os.umask(0o027)
    try:
        write_run(tmp_path, {"large.csv": b"x" * 30, "small.csv": b"x"})
    finally:
        os.umask(before)
    modes = [(tmp_path / name).stat().st_mode & 0o777 for name in ("large.csv", "small.csv")]
    assert modes == [0o640, 0o640], little_held


def test_a_place_that_cannot_be_written_is_refused_when_a_file_is_begun(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.csv")
    with OutputFolder(tmp_path) as output, pytest.raises(UsageError, match="a device or a pipe"):
        output.begin("a.csv")
    (tmp_path / "file").write_bytes(b"")
    with (
        OutputFolder(tmp_path / "file") as output,
        pytest.raises(UsageError, match=r"b\.csv: a file"),
    ):
        output.begin("b.csv")


@pytest.mark.parametrize("format", STREAM_FORMATS)
@pytest.mark.filterwarnings("error::pytest.PytestUnraisableExceptionWarning")
def test_a_full_disk_is_told_with_the_rows_that_were_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, format: str
) -> None:
    """And what packs or frames the file says nothing more when it goes."""
    pytest.importorskip("pyarrow")
    table = random_table(200_000)
    left = [1_000_000]
    whole = room._write_all

    def write_all(stream, data) -> None:
        if left[0] < len(data):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        left[0] -= len(data)
        whole(stream, data)

    monkeypatch.setattr(room, "_write_all", write_all)
    monkeypatch.setattr(room, "HELD_BYTES", 1000)

    def fails() -> None:
        with OutputFolder(tmp_path / "out") as output, output.begin(f"t.{format}") as file:
            write_table(TableStream(heading_of(table), cut(table, 1000)), format, file)

    with pytest.raises(UsageError) as caught:
        fails()
    gc.collect()
    words = str(caught.value).partition(" rows: the disk is full; free some space or choose")
    assert words[1]
    start, rows = words[0].split(" after ")
    assert start == f"cannot write {tmp_path}/out/t.{format}"
    assert int(rows) % 1000 == 0
    assert 0 < int(rows) < 200_000
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("format", STREAM_FORMATS)
def test_a_table_that_is_dropped_writes_nothing_into_its_closed_file(
    format: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pyarrow")
    said: list[object] = []
    monkeypatch.setattr("sys.unraisablehook", said.append)
    table, file = random_table(70_000), io.BytesIO()
    writer = TableWriter(heading_of(table), format, file)
    writer.write(table.columns)
    file.close()
    del writer
    gc.collect()
    assert [str(one) for one in said] == []


@pytest.mark.parametrize("format", ["csv", "jsonl"])
def test_rows_of_one_block_that_fitted_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, format: str
) -> None:
    """A table that is evaluated whole is one block."""
    table, whole = random_table(60_000), io.BytesIO()
    write_table(stream_of(table), format, whole)
    lines = whole.getvalue().splitlines(keepends=True)
    fitted = [0]
    write = room._write_all

    def write_all(stream, data) -> None:
        if fitted[0] + len(data) > len(whole.getvalue()) // 2:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        fitted[0] += len(data)
        write(stream, data)

    monkeypatch.setattr(room, "_write_all", write_all)
    monkeypatch.setattr(room, "HELD_BYTES", 10)
    style = CsvStyle(threads=1)
    with (
        pytest.raises(UsageError) as caught,
        OutputFolder(tmp_path / "out") as output,
        output.begin(f"t.{format}") as file,
    ):
        write_table(stream_of(table), format, file, style, TextRoom(1 << 16))
    rows = int(str(caught.value).partition(" after ")[2].partition(" rows: ")[0])
    header = format == "csv"
    assert 0 < rows < len(lines) - header
    assert sum(map(len, lines[: rows + header])) == fitted[0]


@pytest.mark.parametrize("fitted", [0, 1, 12, 37])
@pytest.mark.parametrize("format", ["csv", "jsonl"])
def test_a_full_disk_is_told_of_a_small_file_with_the_rows_that_fitted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fitted: int, format: str
) -> None:
    """A small file is held, and written when all of them take their places."""

    def write(path: str, content: bytes) -> None:
        lines = content.splitlines(keepends=True)[: fitted + (format == "csv") + 1]
        # the last line not to its end
        Path(path).write_bytes(b"".join(lines)[:-1] if fitted < 37 else b"".join(lines))
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(file_set, "_write", write)
    words = rf"out/t\.{format} after {fitted} rows: the disk is full"
    with OutputFolder(tmp_path / "out") as output:
        with output.begin(f"t.{format}") as file:
            write_table(stream_of(random_table(37)), format, file)
        with pytest.raises(UsageError, match=words):
            output.write_run()


@pytest.mark.parametrize("format", STREAM_FORMATS)
@pytest.mark.filterwarnings("error::pytest.PytestUnraisableExceptionWarning")
def test_an_error_between_blocks_ends_the_file_without_a_word(tmp_path: Path, format: str) -> None:
    pytest.importorskip("pyarrow")
    table = random_table(100_000)

    def blocks():
        yield table.columns
        raise ZeroDivisionError

    def fails() -> None:
        with OutputFolder(tmp_path / "out") as output, output.begin(f"t.{format}") as file:
            write_table(TableStream(heading_of(table), blocks()), format, file)

    with pytest.raises(ZeroDivisionError):
        fails()
    gc.collect()
    assert list(tmp_path.iterdir()) == []


def test_memory_of_a_stream_is_that_of_a_block(tmp_path: Path) -> None:
    """While a file ten times as large as what is held is written."""
    import tracemalloc

    block = random_table(2000)
    tracemalloc.start()
    with OutputFolder(tmp_path) as output, output.begin("t.csv") as file:
        stream = TableStream(heading_of(block), (block.columns for _ in range(100)))
        assert write_table(stream, "csv", file) == 200_000
        _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert file.digest.size > 10 * HELD_BYTES
    assert peak < TEXT_ROOM + 4 * HELD_BYTES  # of the room a block touches what it needs
