"""The mechanism that a command line names: a file, or `-`, the text on stdin."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.diagnostics import UsageError

if TYPE_CHECKING:
    from mechkin_cli.interface import Model

STDIN = Path("-")
"""Stands for the text on stdin; a file of this name is named with its folder's whole path."""

STDIN_NAME = "stdin"
"""What messages and the folder of its tables call the text on stdin."""


def model_of(path: Path, settings: Mapping[str, str]) -> Model:
    """The checked mechanism file; what a text on stdin names is sought in the working folder.

    Raises:
        UsageError: it cannot be read, or an unknown parameter.
        InvalidFile: with every independent error and its place.
    """
    from mechkin_cli.interface import load, loads

    if not is_stdin(path):
        return load(path, settings)
    from mechkin_cli.reading.text import decoded

    return loads(decoded(_piped(), STDIN_NAME), STDIN_NAME, settings, folder=Path())


def is_stdin(path: Path) -> bool:
    """Whether the word stands for stdin."""
    return path == STDIN


def shown(path: Path) -> str:
    """What messages and records call the file."""
    return STDIN_NAME if is_stdin(path) else str(path)


def stem_of(path: Path) -> str:
    """What the folder of its results is called."""
    stem = STDIN_NAME if is_stdin(path) else path.stem
    # a file called ...yaml has the stem .., which leads out of the folder
    return stem if stem.strip(".") else path.name


def refuse_stdin(path: Path, why: str) -> None:
    """Refuses `-` where a command needs a file.

    Raises:
        UsageError: the word stands for stdin.
    """
    if is_stdin(path):
        raise UsageError(f"{why}; save the text in a file and name it")


def _piped() -> bytes:
    """The bytes on stdin, no more than one above what a mechanism file may have."""
    from mechkin_cli.cli.messages import say
    from mechkin_cli.reading.limits import MOST_BYTES

    if sys.stdin is None:
        raise UsageError("stdin is closed, so - has nothing to read; name a file")
    try:
        descriptor = sys.stdin.fileno()
        if os.isatty(descriptor):
            say("reading the mechanism from the terminal; end it with Ctrl-D")
        pieces, left = [], MOST_BYTES + 1
        while left and (piece := os.read(descriptor, left)):
            pieces.append(piece)
            left -= len(piece)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"stdin cannot be read: {reason}; name a file") from None
    return b"".join(pieces)
