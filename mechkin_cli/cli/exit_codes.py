"""Exit codes of all commands; with several files the largest counts."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """What the caller of a command learns."""

    OK = 0
    DIFFERENCES = 1
    USAGE = 2
    INVALID_FILE = 3
    ROWS_MISSING = 4
    INTERNAL = 70
    INTERRUPTED = 130
    """By Ctrl-C, or by a request to end (SIGTERM, SIGHUP)."""
