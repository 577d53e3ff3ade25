"""What the commands print: data on stdout, messages for a person on stderr."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from pathlib import Path

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError

Record = dict[str, object]
"""Plain data for `--json`."""

_COLOURS = {"error": "\x1b[31m", "warning": "\x1b[33m", "note": "\x1b[36m"}
_PLAIN = "\x1b[0m"


def put(text: str) -> None:
    """Data on stdout. Once its reader has gone away the work goes on, and nothing more is shown."""
    try:
        try:
            sys.stdout.write(text)
        except UnicodeEncodeError:
            encoding = sys.stdout.encoding
            sys.stdout.write(text.encode(encoding, "backslashreplace").decode(encoding))
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(text: str = "") -> None:
    """One line on stderr; on a terminal, broken between words where it is too long."""
    sys.stderr.write(_fitted(text) + "\n")


def _fitted(text: str) -> str:
    if not sys.stderr.isatty():
        return text
    from shutil import get_terminal_size
    from textwrap import wrap

    width = max(get_terminal_size((80, 24)).columns, 40)
    lines = wrap(text, width, subsequent_indent="    ", break_on_hyphens=False)
    return "\n".join(lines)


def say_diagnostics(diagnostics: Iterable[Diagnostic], file: str | None = None) -> None:
    """Diagnostics on stderr; those without a place of their own are put at the file."""
    for diagnostic in diagnostics:
        text = str(diagnostic)
        if diagnostic.place is None and file is not None:
            text = f"{file}: {text}"
        sys.stderr.write(_coloured(_fitted(text), diagnostic.severity) + "\n")


def refusal(path: Path, error: InvalidFile | UsageError) -> tuple[ExitCode, Record]:
    """Says why a file was not used; its exit code and its record."""
    if isinstance(error, InvalidFile):
        say_diagnostics(error.diagnostics)
        code, diagnostics = ExitCode.INVALID_FILE, error.diagnostics
    else:
        say(f"mechkin: {error}")
        code, diagnostics = ExitCode.USAGE, (Diagnostic("usage", "error", str(error)),)
    return code, {"file": str(path), "diagnostics": [found.record() for found in diagnostics]}


def _coloured(text: str, severity: str) -> str:
    if not sys.stderr.isatty() or os.environ.get("NO_COLOR"):
        return text
    word = f"{severity}:"
    return text.replace(word, f"{_COLOURS[severity]}{word}{_PLAIN}", 1)


class Progress:
    """A counter on stderr, only on a terminal and only once the work has taken a second."""

    def __init__(self, total: int, what: str, quiet: bool) -> None:
        from time import monotonic

        self._clock = monotonic
        self._start = monotonic()
        self._total = total
        self._what = what
        self._on = not quiet and total > 1 and sys.stderr.isatty()
        self._shown = False

    def step(self, done: int) -> None:
        """Shows how far the work is."""
        if self._on and self._clock() - self._start > 1.0:
            sys.stderr.write(f"\r{done} of {self._total} {self._what}")
            sys.stderr.flush()
            self._shown = True

    def end(self) -> None:
        """Clears the counter."""
        if self._shown:
            sys.stderr.write("\r\x1b[K")
