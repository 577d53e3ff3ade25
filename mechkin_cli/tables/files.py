"""Writing the files of a run: all of them whole, or none.

Every file is first written under a temporary name in the folder where it will stand; only when all
are complete are they renamed, so no reader ever meets half a file. Files that are to be replaced
keep a second name until the last rename has succeeded. Whatever fails, a keyboard interrupt
included, the old files come back, and the temporary files and the folders made for them go again.
"""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mechkin_cli.diagnostics import UsageError

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


def write_files(folder: Path, files: Mapping[str, bytes]) -> list[Path]:
    """Write `files` (path below `folder` -> content); folders are made as needed.

    Returns the paths written, in the order given.

    Raises:
        UsageError: a file cannot be written; the message says where, why and what to do.
    """
    attempt = _Attempt()
    try:
        for name, content in files.items():
            target = folder / name
            with _refusal(target):
                attempt.prepare(target, content)
        for target in attempt.pending:
            with _refusal(target):
                attempt.keep_old(target)
        attempt.renaming = True
        for target, temporary in attempt.pending.items():
            with _refusal(target):
                temporary.replace(target)
        attempt.complete = True
    finally:
        _clean_up(attempt)
    return list(attempt.pending)


@dataclass
class _Attempt:
    """What has been done so far, in a form that can be undone, also twice."""

    pending: dict[Path, Path] = field(default_factory=dict)
    """Target -> temporary file; whose temporary file is gone stands in its place."""
    old: dict[Path, Path] = field(default_factory=dict)
    """Target -> second name of the file that it replaces."""
    made: list[Path] = field(default_factory=list)
    """Folders made, outermost first."""
    renaming: bool = False
    """Whether targets may have been replaced."""
    complete: bool = False
    """Whether all of them have been."""

    def prepare(self, target: Path, content: bytes) -> None:
        """Write the content beside its target."""
        _make_folder(target.parent, self.made)
        if target.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        temporary = _beside(target)
        self.pending[target] = temporary
        _write(temporary, content)

    def keep_old(self, target: Path) -> None:
        """Give the file that the target replaces a second name."""
        if not os.path.lexists(target):
            return
        second = _beside(target)
        self.old[target] = second
        try:
            os.link(target, second, follow_symlinks=False)
        except OSError:
            # a file system without hard links: for a moment the target has no file
            target.replace(second)

    def drop_old(self) -> None:
        """Remove the second names."""
        for second in self.old.values():
            with contextlib.suppress(OSError):
                second.unlink(missing_ok=True)

    def undo(self) -> None:
        """Bring the old files back and remove everything new."""
        for target, temporary in self.pending.items():
            with contextlib.suppress(OSError):
                second = self.old.get(target)
                if second is not None and os.path.lexists(second):
                    _restore(second, target)
                elif self.renaming and second is None and not temporary.exists():
                    target.unlink(missing_ok=True)
                temporary.unlink(missing_ok=True)
        for folder in reversed(self.made):
            with contextlib.suppress(OSError):
                folder.rmdir()


def _clean_up(attempt: _Attempt) -> None:
    """Undo what is not complete; an interrupt meanwhile counts only after that."""
    interrupts = 0
    while True:
        try:
            attempt.drop_old() if attempt.complete else attempt.undo()
            break
        except KeyboardInterrupt:
            interrupts += 1
    if interrupts:
        raise KeyboardInterrupt


def _beside(target: Path) -> Path:
    return target.with_name(f".mechkin-{os.urandom(8).hex()}.tmp")


def _restore(second: Path, target: Path) -> None:
    second.replace(target)
    # where both are names of one file, a rename leaves both
    second.unlink(missing_ok=True)


def _make_folder(folder: Path, made: list[Path]) -> None:
    """Make the folder and those above it; `made` gets the new ones, outermost first."""
    if folder.is_dir():
        return
    if folder.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
    if folder.parent != folder:
        _make_folder(folder.parent, made)
    made.append(folder)
    folder.mkdir(exist_ok=True)


def _write(path: Path, content: bytes) -> None:
    with path.open("xb") as stream:
        stream.write(content)


@contextlib.contextmanager
def _refusal(target: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error)
        cure = _CURES.get(error.errno or 0, f"{reason}; choose another folder with --out")
        raise UsageError(f"cannot write {target}: {cure}") from error
