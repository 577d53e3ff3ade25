"""Several files replaced at one moment: all of them are the old ones, or all are the new."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from mechkin_cli.diagnostics import UsageError

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
PART = 1 << 16
"""As many bytes of a file are compared at once."""
_UP = f"..{os.sep}..{os.sep}"
"""From `old/` to the folder in which the set stands."""


def new_attempt(folder: Path) -> Path:
    """A name for the folder of an attempt."""
    return folder / f".mechkin-{os.urandom(8).hex()}"


def begin_attempt(attempt: Path) -> None:
    """Makes its folder with both sides."""
    for path in (attempt, attempt / "new", attempt / "old"):
        os.mkdir(path)


def replace_files(
    folder: Path,
    files: Mapping[str, bytes],
    removed: Sequence[str] = (),
    attempt: Path | None = None,
    streamed: Sequence[str] = (),
    rows: Mapping[str, int] | None = None,
) -> None:
    """Put files (name -> content) into the folder, replacing those of the same names; those of the
    names `removed` go at the same moment.

    Whatever fails, a keyboard interrupt included, the old files stay.

    Args:
        attempt: one that was begun, in which the files of the names `streamed` are new already;
            None: there is none. What stands in their places is not compared with them: reading it
            takes as long as writing them did.
        rows: of the files that hold rows: how many are done.

    Raises:
        UsageError: a file cannot be written.
    """
    files = {name: content for name, content in files.items() if not _stays(folder / name, content)}
    new = [*files, *streamed]
    names = [*new, *removed]
    if not names:
        return
    is_begun = attempt is not None
    attempt = attempt or new_attempt(folder)
    try:
        replacing.add(attempt)
        with refusal(folder / names[0]):
            if not is_begun:
                begin_attempt(attempt)
        _prepare(attempt, folder, files, names, rows or {})
        if len(names) == len(new) == 1:
            (name,) = new
            with refusal(folder / name):
                os.replace(attempt / "new" / name, folder / name)
        elif _link(attempt / "set", "old"):
            each(folder, names, lambda name: _put_link(name, folder, attempt))
            with refusal(folder):
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


def each(
    folder: Path,
    names: Iterable[str],
    work: Callable[[str], object],
    rows: Mapping[str, int] | None = None,
) -> None:
    """Does the work for each name; an error is told of the file of that name in the folder, of
    which so many `rows` are done."""
    name = ""
    try:
        for name in names:
            work(name)
    except OSError as error:
        raise refused(folder / name, error, (rows or {}).get(name)) from error


def _prepare(
    attempt: Path,
    folder: Path,
    files: Mapping[str, bytes],
    names: Sequence[str],
    rows: Mapping[str, int],
) -> None:
    """What is new, beside what was streamed, and second names of what is old."""
    new, old = (f"{attempt}{os.sep}{side}{os.sep}" for side in ("new", "old"))
    done = {name: count for name, count in rows.items() if count}

    def write(name: str) -> None:
        try:
            _write(new + name, files[name])
        except OSError:
            if name in done:
                done[name] = rows_within(new + name, Path(name).suffix, done[name])
            raise

    each(folder, files, write, done)
    each(folder, names, lambda name: _keep(f"{folder}{os.sep}{name}", old + name))


def _stays(path: Path, content: bytes) -> bool:
    """Whether it is a regular file that holds this content already; then it gets a new date."""
    try:
        state = os.lstat(path)
        if not stat.S_ISREG(state.st_mode) or state.st_size != len(content):
            return False
        with open(path, "rb") as stream:
            for start in range(0, len(content), PART):
                if stream.read(PART) != content[start : start + PART]:
                    return False
        os.utime(path)
    except OSError:
        return False
    return True


_HEADERS = {".csv": 1, ".jsonl": 0}
"""Lines of text before the rows."""


def rows_within(file: str | int, suffix: str, given: int) -> int:
    """The whole rows of a table of text in a file, by its path or open, that could not be written
    to its end; of another kind of file those that were `given` to it."""
    header = _HEADERS.get(suffix)
    if header is None:
        return given
    try:
        with open(file, "rb", closefd=isinstance(file, str)) as stream:
            stream.seek(0)
            lines = sum(part.count(b"\n") for part in iter(lambda: stream.read(PART), b""))
    except OSError:
        return 0
    return max(lines - header, 0)


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
        each(folder, names, put)
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
    errno.ENOSPC: "the disk is full; free some space or choose another place with --out",
    errno.EDQUOT: "the disk quota is used up; free some space or choose another place with --out",
    errno.EFBIG: "the file is larger than is allowed here; write fewer rows or columns",
    errno.EACCES: "no permission to write there; choose another place with --out",
    errno.EPERM: "no permission to write there; choose another place with --out",
    errno.EROFS: "the file system is read-only; choose another place with --out",
    errno.EEXIST: "a file stands where a folder is needed; choose another place with --out",
    errno.ENOTDIR: "a file stands where a folder is needed; choose another place with --out",
    errno.EISDIR: "a folder stands where a file is to be written; move it or choose another --out",
    errno.ELOOP: "a symbolic link there leads nowhere; remove it or choose another --out",
    errno.ENAMETOOLONG: "the name is too long; choose a shorter one with --out",
}
_OPEN_ELSEWHERE = (5, 32, 33)
"""Errors of Windows: access denied, a sharing violation, a locked part."""


def refuse_special(target: Path) -> None:
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
def refusal(target: Path) -> Iterator[None]:
    """Inside, an error of the system is told of this file.

    Raises:
        UsageError: in its place.
    """
    try:
        yield
    except OSError as error:
        raise refused(target, error) from error


def refused(target: Path, error: OSError, rows: int | None = None) -> UsageError:
    """What is said of a file that cannot be written, of which so many rows were; None: no table."""
    reason = error.strerror or str(error)
    cure = _CURES.get(error.errno or 0, f"{reason}; choose another place with --out")
    if getattr(error, "winerror", None) in _OPEN_ELSEWHERE:
        cure = (
            "no permission to write there, or another program has it open; close it there or "
            "choose another place with --out"
        )
    done = "" if rows is None else f" after {rows} rows"
    return UsageError(f"cannot write {target}{done}: {cure}")
