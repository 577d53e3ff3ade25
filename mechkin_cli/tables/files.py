"""Writing the files of a run: all of them whole, or none, and no two runs into one folder."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType

from mechkin_cli.diagnostics import UsageError
from mechkin_cli.tables.claim import Claim
from mechkin_cli.tables.file_set import replace_files, settle_all

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
        for target in targets:
            with _refusal(target):
                _refuse_special(target)
        replace_files(self.folder, files, _refusal, removed)
        return targets

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
        mode = target.stat().st_mode
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
        reason = error.strerror or str(error)
        cure = _CURES.get(error.errno or 0, f"{reason}; choose another folder with --out")
        raise UsageError(f"cannot write {target}: {cure}") from error
