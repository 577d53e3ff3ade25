"""Writing the files of a run: all of them whole, or none.

Every file is first written under a temporary name in the folder where it will stand; only when all
are complete are they renamed, so no reader ever meets half a file. Whatever fails, a keyboard
interrupt included, the temporary files and the folders made for them go again; files that were
already renamed stay.
"""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterator, Mapping
from pathlib import Path

from mechkin_cli.diagnostics import UsageError

_CURES = {
    errno.ENOSPC: "the disk is full; free some space or choose another folder with --out",
    errno.EDQUOT: "the disk quota is used up; free some space or choose another folder with --out",
    errno.EACCES: "no permission to write there; choose another folder with --out",
    errno.EPERM: "no permission to write there; choose another folder with --out",
    errno.EROFS: "the file system is read-only; choose another folder with --out",
    errno.EEXIST: "a file stands where a folder is needed; choose another folder with --out",
    errno.ENOTDIR: "a file stands where a folder is needed; choose another folder with --out",
    errno.EISDIR: "a folder stands where a file is to be written; move it or choose another --out",
    errno.ENAMETOOLONG: "the name is too long; choose a shorter one with --out",
}


def write_files(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write `files` (path below `folder` -> content); folders are made as needed.

    Returns the paths written, in the order given.

    Raises:
        UsageError: a file cannot be written; the message says where, why and what to do.
    """
    made: list[Path] = []
    pending: dict[Path, Path] = {}
    try:
        for name, content in files.items():
            target = folder / name
            with _refusal(target):
                _make_folder(target.parent, made)
                if target.is_dir():
                    raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
                temporary = target.with_name(f".mechkin-{os.urandom(8).hex()}.tmp")
                pending[target] = temporary
                _write(temporary, content)
        for target, temporary in pending.items():
            with _refusal(target):
                temporary.replace(target)
    except BaseException:
        _clean_up(pending, made)
        raise
    return list(pending)


def _make_folder(folder: Path, made: list[Path]) -> None:
    """Make the folder and those above it; `made` gets the new ones, outermost first."""
    if folder.is_dir():
        return
    if folder.parent != folder:
        _make_folder(folder.parent, made)
    made.append(folder)
    folder.mkdir(exist_ok=True)


def _write(path: Path, content: bytes) -> None:
    with path.open("xb") as stream:
        stream.write(content)


def _clean_up(pending: Mapping[Path, Path], made: list[Path]) -> None:
    for temporary in pending.values():
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
    for folder in reversed(made):
        with contextlib.suppress(OSError):
            folder.rmdir()


@contextlib.contextmanager
def _refusal(target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        cure = _CURES.get(error.errno or 0, f"{reason}; choose another folder with --out")
        raise UsageError(f"cannot write {target}: {cure}") from error
