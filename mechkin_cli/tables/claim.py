"""One writer at a time for a folder.

The lock is the operating system's, on the folder itself (flock): no file stands for it, and it ends
with its process, whatever ends that. File systems without locks are written to without one.
"""

from __future__ import annotations

import contextlib
import errno
import os
from pathlib import Path

from mechkin_cli.diagnostics import UsageError

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
