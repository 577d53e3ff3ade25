"""What the command line does for itself on Windows, where elsewhere the shell, the terminal or the
system does it. Other systems never load this module.

Names with `*` and `?` reach a program as they were typed. A console shows colours and a line that
is cleared only once it is asked to read such codes. Text that goes into a file or a pipe gets a
carriage return before each line's end, so that it would not have the bytes it has elsewhere.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Sequence
from glob import glob
from typing import Any, TextIO

_READS_CODES = 0x0004
"""ENABLE_VIRTUAL_TERMINAL_PROCESSING, of SetConsoleMode."""

_STDOUT, _STDERR = -11, -12
"""Standard handles, of GetStdHandle."""


def prepare() -> None:
    """Makes the process ready, before anything is read or written."""
    sys.argv[1:] = expanded(sys.argv[1:])
    for stream in (sys.stdout, sys.stderr):
        _same_bytes(stream)
    if not (_reads_codes(_STDOUT, sys.stdout) and _reads_codes(_STDERR, sys.stderr)):
        # an older console: no colours, and no line that would have to be cleared
        os.environ.setdefault("NO_COLOR", "1")
        os.environ.setdefault("TERM", "dumb")


def expanded(words: Sequence[str]) -> list[str]:
    """The words, each pattern of files as the files that match, sorted; one that matches none stays
    as it is, as in other shells, so that `--set P1=2*3in` is no pattern."""
    found: list[str] = []
    for word in words:
        is_pattern = any(mark in word for mark in "*?") and not word.startswith("-")
        found += (sorted(glob(word)) or [word]) if is_pattern else [word]
    return found


def _same_bytes(stream: TextIO | None) -> None:
    """Lines end as everywhere where they go into a file or a pipe."""
    reconfigure = getattr(stream, "reconfigure", None)
    if stream is not None and reconfigure is not None and not stream.isatty():
        reconfigure(newline="\n")


def _reads_codes(handle: int, stream: TextIO | None) -> bool:
    """Whether codes for colours may be sent; True of what is no console."""
    if stream is None or not stream.isatty():
        return True
    with contextlib.suppress(AttributeError, OSError):
        kernel: Any = ctypes.windll.kernel32  # type: ignore[attr-defined,unused-ignore]
        console, mode = kernel.GetStdHandle(handle), ctypes.c_ulong()
        if kernel.GetConsoleMode(console, ctypes.byref(mode)):
            return bool(kernel.SetConsoleMode(console, mode.value | _READS_CODES))
    return False
