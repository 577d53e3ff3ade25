"""The bytes of a regular file: whatever stands at a path, reading it neither waits nor goes on for
ever."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import Final

MOST_TABLE_BYTES: Final = 1 << 30
"""Size of a table on disk that is compared; kept tables have some kilobytes."""

_PIECE = 1 << 20
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0)


class NotRegular(OSError):
    """A folder, device, pipe or socket stands where a file is to be read; nothing was opened."""

    def __init__(self, path: Path, mode: int) -> None:
        self.is_folder = stat.S_ISDIR(mode)
        what = "a folder" if self.is_folder else "not a regular file"
        super().__init__(errno.EINVAL, f"it is {what}", str(path))


def read_regular(path: Path, most: int) -> bytes:
    """The content of a file, of which no more than `most` + 1 bytes are read.

    Files of the system (`/proc`) that wait for news are read without waiting.

    Raises:
        NotRegular: it is no regular file.
        OSError: it cannot be read.
        ValueError: the path holds a NUL character.
    """
    _check(path, path.stat().st_mode)
    descriptor = os.open(path, _FLAGS)
    try:
        _check(path, os.fstat(descriptor).st_mode)
        pieces, left = [], most + 1
        while left and (piece := os.read(descriptor, min(left, _PIECE))):
            pieces.append(piece)
            left -= len(piece)
        return b"".join(pieces)
    finally:
        os.close(descriptor)


def _check(path: Path, mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise NotRegular(path, mode)
