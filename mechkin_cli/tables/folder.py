"""A folder of results: all files of a run are written whole, or none is.

No two runs write into one folder at a time, nor beside the files of an earlier one.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from zlib import crc32

from mechkin_cli.diagnostics import UsageError

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


# Replacing several files at one moment: all of them are the old ones, or all are the new.
#
# A rename replaces one file at once, but not two. So an attempt at a set has a folder of its own,
# `.mechkin-...`, with the new files in `new/`, second names of those that they replace in `old/`,
# and a symbolic link `set` to one of the two. First `set` leads to `old/`, and file by file a link
# through `set` is put in the place of what stands there: whoever reads still finds the old files.
# Then one rename lets `set` lead to `new/`: that is the moment. At last the links are replaced by
# the files themselves, and the attempt's folder goes.
#
# `settle` is this last part, in both directions: it also takes back what was interrupted before the
# moment, and clears what a run left that was killed.
#
# A file that holds the new content already stays, with a new date: where a run is repeated, writing
# and replacing its files takes longer than computing them.

replacing: set[Path] = set()
"""The attempts of this process that are under way: an interrupt must let them be taken back."""

_ATTEMPT = re.compile(r"\.mechkin-[0-9a-f]{16}(\.tmp)?")
_PART = 1 << 16
"""As many bytes of a file are compared at once."""
_UP = f"..{os.sep}..{os.sep}"
"""From `old/` to the folder in which the set stands."""


def replace_files(folder: Path, files: Mapping[str, bytes], removed: Sequence[str] = ()) -> None:
    """Put files (name -> content) into the folder, replacing those of the same names; those of the
    names `removed` go at the same moment.

    Whatever fails, a keyboard interrupt included, the old files stay.

    Raises:
        UsageError: a file cannot be written.
    """
    files = {name: content for name, content in files.items() if not _stays(folder / name, content)}
    names = [*files, *removed]
    if not names:
        return
    attempt = folder / f".mechkin-{os.urandom(8).hex()}"
    try:
        replacing.add(attempt)
        _prepare(attempt, folder, files, names)
        if len(names) == len(files) == 1:
            (name,) = files
            with _refusal(folder / name):
                os.replace(attempt / "new" / name, folder / name)
        elif _link(attempt / "set", "old"):
            _each(folder, names, lambda name: _put_link(name, folder, attempt))
            with _refusal(folder):
                os.symlink("new", attempt / "spare")
                os.replace(attempt / "spare", attempt / "set")
        else:
            _replace_one_by_one(attempt, folder, names)
    finally:
        _without_interrupts(lambda: settle(attempt))
        replacing.discard(attempt)


def settle(attempt: Path) -> None:
    """Let the side that `set` leads to stand in the folder, and remove the attempt; may be repeated
    after an interrupt. What cannot be settled now stays as it is, readable, for the next time."""
    with contextlib.suppress(OSError):
        if links := _links(attempt):
            side = attempt / os.readlink(attempt / "set")
            with contextlib.suppress(FileNotFoundError):
                os.unlink(attempt / "spare")
            for name in links:
                with contextlib.suppress(OSError):
                    _put_file(f"{side}{os.sep}{name}", f"{attempt.parent}{os.sep}{name}", attempt)
            if _links(attempt):
                return
        _remove(attempt)


def settle_all(folder: Path) -> None:
    """Settles and clears what runs left that were killed; none may be under way."""
    for name in os.listdir(folder):
        if _ATTEMPT.fullmatch(name):
            path = folder / name
            if path.is_dir() and not path.is_symlink():
                settle(path)
            else:
                with contextlib.suppress(OSError):
                    path.unlink()


def _each(folder: Path, names: Iterable[str], work: Callable[[str], object]) -> None:
    """Does the work for each name; an error is told of the file of that name in the folder."""
    name = ""
    try:
        for name in names:
            work(name)
    except OSError as error:
        raise _refused(folder / name, error) from error


def _prepare(attempt: Path, folder: Path, files: Mapping[str, bytes], names: Sequence[str]) -> None:
    """The attempt's folder with both sides."""
    with _refusal(folder / names[0]):
        for path in (attempt, attempt / "new", attempt / "old"):
            os.mkdir(path)
    new, old = (f"{attempt}{os.sep}{side}{os.sep}" for side in ("new", "old"))
    _each(folder, files, lambda name: _write(new + name, files[name]))
    _each(folder, names, lambda name: _keep(f"{folder}{os.sep}{name}", old + name))


def _stays(path: Path, content: bytes) -> bool:
    """Whether it is a regular file that holds this content already; then it gets a new date."""
    try:
        state = os.lstat(path)
        if not stat.S_ISREG(state.st_mode) or state.st_size != len(content):
            return False
        with open(path, "rb") as stream:
            for start in range(0, len(content), _PART):
                if stream.read(_PART) != content[start : start + _PART]:
                    return False
        os.utime(path)
    except OSError:
        return False
    return True


def _write(path: str, content: bytes) -> None:
    with open(path, "xb") as stream:
        stream.write(content)


def _keep(target: str, second: str) -> None:
    """Give what stands at the target a second name."""
    try:
        mode = os.lstat(target).st_mode
    except FileNotFoundError:
        return
    if stat.S_ISLNK(mode):
        text = os.readlink(target)
        os.symlink(text if os.path.isabs(text) else _UP + text, second)
        return
    try:
        os.link(target, second)
    except OSError:  # a file system without hard links
        from shutil import copy2

        copy2(target, second)


def _link(path: Path, text: str) -> bool:
    """Whether the symbolic link could be made: some file systems have none. Windows asks for a
    right that few users have, and reads such links differently."""
    if os.name == "nt":
        return False
    try:
        os.symlink(text, path)
    except OSError:
        return False
    return True


def _put_link(name: str, folder: Path, attempt: Path) -> None:
    """Put a link through `set` in the place of a file, or where there is none."""
    text, target = f"{attempt.name}/set/{name}", f"{folder}{os.sep}{name}"
    try:
        os.symlink(text, target)
    except FileExistsError:
        spare = f"{attempt}{os.sep}spare"
        os.symlink(text, spare)
        os.replace(spare, target)


def _links(attempt: Path) -> list[str]:
    """Names in the attempt's folder that are links through `set`."""
    with os.scandir(attempt.parent) as entries:
        links = [entry.name for entry in entries if entry.is_symlink()]
    ends = {name: os.readlink(f"{attempt.parent}{os.sep}{name}") for name in links}
    return [name for name, end in ends.items() if end == f"{attempt.name}/set/{name}"]


def _put_file(source: str, target: str, attempt: Path) -> None:
    """Put the file at `source`, or nothing where there is none, in the place of the target."""
    spare = f"{attempt}{os.sep}spare"
    try:
        # a second name, for readers that still come by the link
        os.link(source, spare, follow_symlinks=False)
    except FileNotFoundError:
        os.unlink(target)
        return
    except FileExistsError:
        os.unlink(spare)
        _put_file(source, target, attempt)
        return
    except (OSError, NotImplementedError):  # a file system, or a system, without such links
        spare = source
        if not os.path.lexists(source):
            os.unlink(target)
            return
    if os.path.islink(spare):
        text = os.readlink(source).removeprefix(_UP)
        spare = f"{attempt}{os.sep}spare"
        with contextlib.suppress(FileNotFoundError):
            os.unlink(spare)
        os.symlink(text, spare)
    os.replace(spare, target)


def _remove(folder: str | Path) -> None:
    """Removes a folder with all in it; what cannot be removed stays."""
    with contextlib.suppress(OSError):
        with os.scandir(folder) as entries:
            inside = [(entry.path, entry.is_dir(follow_symlinks=False)) for entry in entries]
        for path, is_folder in inside:
            if is_folder:
                _remove(path)
                continue
            with contextlib.suppress(OSError):
                os.unlink(path)
        os.rmdir(folder)


def _replace_one_by_one(attempt: Path, folder: Path, names: list[str]) -> None:
    """Without symbolic links there is no one moment; but what fails is taken back."""

    def put(name: str) -> None:
        if (attempt / "new" / name).exists():
            os.replace(attempt / "new" / name, folder / name)
        else:
            os.unlink(folder / name)

    try:
        _each(folder, names, put)
    except BaseException:
        done = [name for name in names if not (attempt / "new" / name).exists()]
        _without_interrupts(lambda: _take_back(attempt, folder, done))
        raise


def _take_back(attempt: Path, folder: Path, names: list[str]) -> None:
    for name in names:
        with contextlib.suppress(OSError):
            _put_file(str(attempt / "old" / name), str(folder / name), attempt)


def _without_interrupts(work: Callable[[], None]) -> None:
    """Does the work to its end; an interrupt meanwhile counts only after that."""
    interrupts = 0
    while True:
        try:
            work()
            break
        except KeyboardInterrupt:
            interrupts += 1
    if interrupts:
        raise KeyboardInterrupt


_CURES = {
    errno.ENOSPC: "the disk is full; free some space or choose another folder with --out",
    errno.EDQUOT: "the disk quota is used up; free some space or choose another folder with --out",
    errno.EFBIG: "the file is larger than is allowed here; write fewer rows or columns",
    errno.EACCES: "no permission to write there; choose another folder with --out",
    errno.EPERM: "no permission to write there; choose another folder with --out",
    errno.EROFS: "the file system is read-only; choose another folder with --out",
    errno.EEXIST: "a file stands where a folder is needed; choose another folder with --out",
    errno.ENOTDIR: "a file stands where a folder is needed; choose another folder with --out",
    errno.EISDIR: "a folder stands where a file is to be written; move it or choose another --out",
    errno.ELOOP: "a symbolic link there leads nowhere; remove it or choose another --out",
    errno.ENAMETOOLONG: "the name is too long; choose a shorter one with --out",
}
_OPEN_ELSEWHERE = (5, 32, 33)
"""Errors of Windows: access denied, a sharing violation, a locked part."""


# What a run wrote, by which the next one knows the files that it may remove.

LISTING = ".mechkin-files"
"""A file with a line for each file of the run that its folder holds: checksum, size, name."""

_HEAD = "# the files of a run of mechkin analyze: the next one in this folder removes them\n"
_LINE = re.compile(r"(?P<sum>[0-9a-f]{8}) (?P<size>[0-9]+) (?P<name>[^/\\\0]+)")


def _listing(files: Mapping[str, bytes]) -> bytes:
    lines = (f"{crc32(data):08x} {len(data)} {name}\n" for name, data in files.items())
    return (_HEAD + "".join(lines)).encode()


def _left_by_earlier(folder: Path, fresh: Mapping[str, bytes]) -> tuple[list[str], list[str]]:
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
            is_same = not path.is_symlink() and path.stat().st_size == int(line["size"])
            is_same = is_same and crc32(path.read_bytes()) == int(line["sum"], 16)
            (same if is_same else changed).append(name)
    return same, changed


class OutputFolder:
    """A folder that this run alone writes to, inside `with`.

    Entering it clears what a killed run left there; a folder that cannot be made is refused only
    when something is written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._claim: Claim | None = None

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
        targets = [self.folder / name for name in files]
        if self._claim is None and targets:
            with _refusal(targets[0]):
                self._enter()
        _each(self.folder, files, lambda name: _refuse_special(self.folder / name))
        replace_files(self.folder, files, removed)
        return targets

    def write_run(self, files: Mapping[str, bytes]) -> tuple[list[Path], list[str], list[str]]:
        """Write the files of a run in the place of those of the run before, at one moment: what
        that one wrote and this one does not is removed, unless it was changed since.

        Returns:
            The files written; the names of those removed, and of those left since somebody changed
            them.

        Raises:
            UsageError: as `write`.
        """
        with _refusal(self.folder / next(iter(files), LISTING)):
            if self._claim is None:
                self._enter()
            removed, changed = _left_by_earlier(self.folder, files)
        written = self.write({**files, LISTING: _listing(files)}, removed)
        return written[:-1], removed, changed

    def _enter(self) -> None:
        claim = self._claim = Claim(self.folder)
        if claim.locked:
            with contextlib.suppress(OSError):
                settle_all(self.folder)


def write_files(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write `files` into a folder, as `OutputFolder.write`."""
    with OutputFolder(folder) as output:
        return output.write(files)


def _refuse_special(target: Path) -> None:
    """Only files and what leads nowhere are replaced: never a device, a pipe or a folder."""
    try:
        mode = os.stat(target).st_mode
    except FileNotFoundError:
        return
    except OSError as error:
        if error.errno == errno.ELOOP and target.is_symlink():
            return
        raise
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(mode):
        raise UsageError(
            f"cannot write {target}: a device or a pipe stands there; choose another place with "
            "--out"
        )


@contextlib.contextmanager
def _refusal(target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise _refused(target, error) from error


def _refused(target: Path, error: OSError) -> UsageError:
    reason = error.strerror or str(error)
    cure = _CURES.get(error.errno or 0, f"{reason}; choose another folder with --out")
    if getattr(error, "winerror", None) in _OPEN_ELSEWHERE:
        cure = (
            "no permission to write there, or another program has it open; close it there or "
            "choose another folder with --out"
        )
    return UsageError(f"cannot write {target}: {cure}")
