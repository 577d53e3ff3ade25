"""A folder of results: all files of a run are written whole, or none is.

No two runs write into one folder at a time, nor beside the files of an earlier one.
"""

from __future__ import annotations

import contextlib
import errno
import io
import os
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any
from zlib import crc32

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.file_set import (
    PART,
    begin_attempt,
    each,
    new_attempt,
    refusal,
    refuse_special,
    replace_files,
    rows_within,
    settle,
    settle_all,
)
from mechkin_cli.tolerances import HELD_BYTES

# One writer at a time for a folder.
#
# The lock is the operating system's, on the folder itself (flock): no file stands for it, and it
# ends with its process, whatever ends that. File systems without locks are written to without one.

MOST_TRIES = 100
"""A folder may be removed by another run between being made and being locked."""


class Claim:
    """A folder that this process alone writes to until `release`; `locked` says whether that is
    sure."""

    def __init__(self, folder: Path) -> None:
        """Makes the folder, and those above it, as needed.

        Raises:
            UsageError: another run writes to it.
            OSError: it cannot be made.
        """
        self.folder = folder
        self.locked = False
        self.attempt: Path | None = None
        """Where the files of a run are written; it ends with the claim."""
        self._made: list[Path] = []
        self._descriptor: int | None = None
        for _ in range(MOST_TRIES):
            with contextlib.suppress(FileNotFoundError):
                if self._try():
                    held.add(self)
                    return
        raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))

    def release(self) -> None:
        """Ends the claim; folders made for it that are still empty go again."""
        if self.attempt is not None:
            settle(self.attempt)
            self.attempt = None
        for folder in reversed(self._made):
            with contextlib.suppress(OSError):
                folder.rmdir()
        self._made = []
        self._close()
        held.discard(self)

    def _try(self) -> bool:
        """Whether the folder that was locked is still the one of that name."""
        _make(self.folder, self._made)
        try:
            self._descriptor = os.open(self.folder, os.O_RDONLY | getattr(os, "O_DIRECTORY", 0))
        except PermissionError:
            return True  # it may be written to, but not read, nor locked
        try:
            self.locked = _lock(self._descriptor)
            if self.locked and not _is_at(self._descriptor, self.folder):
                self._close()
                return False
        except BlockingIOError:
            self._made = []
            self._close()
            raise UsageError(
                f"another run of mechkin is writing to {self.folder}; wait until it ends, or "
                "choose another folder with --out"
            ) from None
        return True

    def _close(self) -> None:
        if self._descriptor is not None:
            os.close(self._descriptor)
        self._descriptor, self.locked = None, False


held: set[Claim] = set()
"""The claims of this process."""


def _lock(descriptor: int) -> bool:
    """Whether the folder could be locked; False where locks do not exist.

    Raises:
        BlockingIOError: another process has locked it.
    """
    try:
        import fcntl
    except ImportError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:
        return False
    return True


def _is_at(descriptor: int, folder: Path) -> bool:
    return os.path.samestat(os.fstat(descriptor), folder.stat())


def _make(folder: Path, made: list[Path]) -> None:
    """Make the folder and those above it; `made` gets the new ones, outermost first."""
    if folder.is_dir():
        return
    if folder.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    if folder.parent != folder:
        _make(folder.parent, made)
    with contextlib.suppress(FileExistsError):
        folder.mkdir()
        made.append(folder)
        return
    if not folder.is_dir():
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST))


# What a run wrote, by which the next one knows the files that it may remove.

LISTING = ".mechkin-files"
"""A file with a line for each file of the run that its folder holds: checksum, size, name."""

_HEAD = "# the files of a run of mechkin analyze: the next one in this folder removes them\n"
_LINE = re.compile(r"(?P<sum>[0-9a-f]{8}) (?P<size>[0-9]+) (?P<name>[^/\\\0]+)")


class Digest(NamedTuple):
    """What a file is known by: its checksum and its size."""

    checksum: int
    size: int

    def __str__(self) -> str:
        return f"{self.checksum:08x} {self.size}"


def _listing(files: Mapping[str, Digest]) -> bytes:
    lines = (f"{digest} {name}\n" for name, digest in files.items())
    return (_HEAD + "".join(lines)).encode()


def _left_by_earlier(folder: Path, fresh: Collection[str]) -> tuple[list[str], list[str]]:
    """Names of files of the run before in a folder that are not among the fresh ones: those that
    are as they were written, and those that are not."""
    try:
        text = (folder / LISTING).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return [], []
    same: list[str] = []
    changed: list[str] = []
    for line in filter(None, map(_LINE.fullmatch, text.splitlines())):
        name = line["name"]
        path = folder / name
        if name not in fresh and name not in {".", ".."} and path.is_file():
            known = Digest(int(line["sum"], 16), int(line["size"]))
            (same if _is_as_written(path, known) else changed).append(name)
    return same, changed


def _is_as_written(path: Path, known: Digest) -> bool:
    if path.is_symlink() or path.stat().st_size != known.size:
        return False
    found = 0
    with open(path, "rb") as stream:
        while part := stream.read(PART):
            found = crc32(part, found)
    return found == known.checksum


MOST_UNNAMED = 64
"""Large files of a run that are without names at a time; each keeps a descriptor open."""


def _open_unnamed(folder: Path) -> io.FileIO:
    """A new file in the folder that has no name there: unless it gets one, it is gone when it is
    closed, or with the process.

    Raises:
        OSError: the system, or the file system, has no unnamed files.
    """
    flag = getattr(os, "O_TMPFILE", None)
    if flag is None:
        raise OSError(errno.ENOTSUP, os.strerror(errno.ENOTSUP))
    return io.FileIO(os.open(folder, flag | os.O_RDWR | os.O_CLOEXEC, 0o666), "rb+")


def _give_name(file: io.FileIO, path: str) -> None:
    """Lets an unnamed file stand at the path."""
    descriptor = file.fileno()
    try:
        # Python follows the link in /proc only when it is given a descriptor, too
        os.link(f"/proc/self/fd/{descriptor}", path, src_dir_fd=descriptor, follow_symlinks=True)
    except OSError:  # no /proc, or no right to it
        from shutil import copyfileobj

        file.seek(0)
        with open(path, "xb") as copy:
            copyfileobj(file, copy)


class OutputFile(io.RawIOBase):
    """A file of a run while it is written: in memory as long as it is small, then in the folder,
    unnamed where there are such files. It takes its place with the others
    (`OutputFolder.write_run`)."""

    def __init__(self, target: Path, begin: Callable[[str], io.FileIO]) -> None:
        """Begins it.

        Args:
            target: where it is to stand.
            begin: opens a new file of the run, for what gets this name.

        `rows` are those of a table that have been given to it.
        """
        self.target = target
        self.held: bytearray | None = bytearray()
        self._begin = begin
        self._stream: io.FileIO | None = None
        self.rows = 0
        self._checksum = self._size = 0
        self._has_failed = False

    @property
    def digest(self) -> Digest:
        """Of what was written so far."""
        return Digest(self._checksum, self._size)

    def rows_within(self, given: int) -> int:
        """The rows of a table that are on the disk, of which so many were given to it, when more
        cannot be written."""
        if self._stream is None or self._stream.closed:
            return 0
        return rows_within(self._stream.name, self.target.suffix, given)

    def writable(self) -> bool:
        """It is."""
        return True

    def write(self, data: Any) -> int:
        """Adds bytes, all of them. After an error, of its own or of the run, nothing more is
        written, nor refused: what packs or frames a file may still write its end when it goes.

        Raises:
            OSError: they cannot be written.
        """
        view = memoryview(data).cast("B")
        if self._has_failed:
            return view.nbytes
        self._checksum = crc32(view, self._checksum)
        self._size += view.nbytes
        if self.held is not None and self._size <= HELD_BYTES:
            self.held += view
            return view.nbytes
        try:
            if self._stream is None:
                self._stream = self._begin(self.target.name)
            held, self.held = self.held, None
            for part in (held, view) if held else (view,):
                _write_all(self._stream, part)
        except BaseException:
            self._has_failed = True
            raise
        return view.nbytes

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._has_failed = self._has_failed or kind is not None
        self.close()

    def close(self) -> None:
        """Ends it; an unnamed file waits for its name, or for `drop`."""
        if not self.is_unnamed:
            self.drop()
        super().close()

    @property
    def is_unnamed(self) -> bool:
        """Whether it is on the disk without a name."""
        stream = self._stream
        return stream is not None and not stream.closed and isinstance(stream.name, int)

    def give_name(self, path: str) -> None:
        """Lets an unnamed file stand at the path.

        Raises:
            OSError: it cannot be put there.
        """
        assert self._stream is not None
        _give_name(self._stream, path)
        self.drop()

    def drop(self) -> None:
        """Closes what is on the disk; an unnamed file is gone then."""
        if self._stream is not None:
            self._stream.close()


def _write_all(stream: io.FileIO, data: bytearray | memoryview) -> None:
    """Writes all of the data, as much at a time as the system takes."""
    view = memoryview(data)
    while view:
        view = view[stream.write(view) or 0 :]


class OutputFolder:
    """A folder that this run alone writes to, inside `with`.

    The files of a run are begun, written as they come, and take their places together
    (`write_run`); a run that ends before leaves nothing. Entering it clears what a killed run left
    there; a folder that cannot be made is refused only when something is written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._claim: Claim | None = None
        self._files: dict[str, OutputFile] = {}

    def __enter__(self) -> OutputFolder:
        """Claims the folder.

        Raises:
            UsageError: another run writes to it.
        """
        with contextlib.suppress(OSError):
            self._enter()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for file in self._files.values():
            file.drop()
        if self._claim is not None:
            self._claim.release()
            self._claim = None

    def write(self, files: Mapping[str, bytes], removed: Sequence[str] = ()) -> list[Path]:
        """Write `files` (name -> content), and remove the files `removed`, at one moment; returns
        the paths written in the order given.

        Raises:
            UsageError: a file cannot be written, and none was; the message says where, why and what
                to do.
        """
        return self._place(files, removed)

    def begin(self, name: str) -> OutputFile:
        """A file of the run, to be written and closed before `write_run`; one of the same name that
        was begun before is dropped.

        Raises:
            UsageError: a file of this name cannot be written there.
        """
        target = self.folder / name
        with refusal(target):
            self._claimed()
            refuse_special(target)
        earlier = self._files.pop(name, None)
        if earlier is not None and earlier.is_unnamed:
            earlier.drop()
        elif earlier is not None and earlier.held is None:
            with refusal(target):
                os.unlink(self._new_file(name))
        file = self._files[name] = OutputFile(target, self._open)
        return file

    def add(self, name: str, content: bytes) -> None:
        """A whole file of the run.

        Raises:
            UsageError: it cannot be written.
        """
        with self.begin(name) as file, refusal(file.target):
            file.write(content)

    def write_run(self) -> tuple[list[Path], list[str], list[str]]:
        """Let the files that were begun take the place of those of the run before, at one moment:
        what that one wrote and this one did not is removed, unless it was changed since.

        Returns:
            The files written; the names of those removed, and of those left since somebody changed
            them.

        Raises:
            UsageError: as `write`.
        """
        files = self._files
        assert all(file.closed for file in files.values())
        with refusal(self.folder / next(iter(files), LISTING)):
            self._claimed()
            removed, changed = _left_by_earlier(self.folder, files)
        held = {name: bytes(file.held) for name, file in files.items() if file.held is not None}
        held[LISTING] = _listing({name: file.digest for name, file in files.items()})
        rows = {name: file.rows for name, file in files.items()}
        streamed = [name for name in files if name not in held]

        def give_name(name: str) -> None:
            if files[name].is_unnamed:
                files[name].give_name(self._new_file(name))

        each(self.folder, streamed, give_name, rows)
        self._files = {}
        self._place(held, removed, streamed, rows)
        return [self.folder / name for name in files], removed, changed

    def _place(
        self,
        files: Mapping[str, bytes],
        removed: Sequence[str] = (),
        streamed: Sequence[str] = (),
        rows: Mapping[str, int] | None = None,
    ) -> list[Path]:
        targets = [self.folder / name for name in files]
        if targets:
            with refusal(targets[0]):
                self._claimed()
        each(self.folder, [*files, *streamed], lambda name: refuse_special(self.folder / name))
        claim = self._claim
        attempt = claim.attempt if claim is not None else None
        replace_files(self.folder, files, removed, attempt, streamed, rows)
        if claim is not None:
            claim.attempt = None
        return targets

    def _open(self, name: str) -> io.FileIO:
        """Opens a new file of the run: an unnamed one where there are such files, of which a killed
        run leaves nothing, else one in the attempt's folder."""
        folder = self._claimed().folder
        if sum(file.is_unnamed for file in self._files.values()) < MOST_UNNAMED:
            with contextlib.suppress(OSError):
                return _open_unnamed(folder)
        return io.FileIO(self._new_file(name), "xb")

    def _new_file(self, name: str) -> str:
        """Where a file of the attempt stands; the first one makes its folder."""
        claim = self._claimed()
        if claim.attempt is None:
            claim.attempt = new_attempt(self.folder)
            begin_attempt(claim.attempt)
        return f"{claim.attempt}{os.sep}new{os.sep}{name}"

    def _claimed(self) -> Claim:
        if self._claim is None:
            self._enter()
        assert self._claim is not None
        return self._claim

    def _enter(self) -> None:
        claim = self._claim = Claim(self.folder)
        if claim.locked:
            with contextlib.suppress(OSError):
                settle_all(self.folder)


def write_files(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write `files` into a folder, as `OutputFolder.write`."""
    with OutputFolder(folder) as output:
        return output.write(files)
