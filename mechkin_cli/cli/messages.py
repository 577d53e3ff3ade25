"""What the commands print: data on stdout, messages for a person on stderr."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TextIO

from mechkin_cli.cli.exit_codes import ExitCode
from mechkin_cli.cli.given_file import shown
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError
from mechkin_cli.legible import legible, whole

Record = dict[str, object]
"""Plain data for `--json`."""

_COLOURS = {"error": "\x1b[31m", "warning": "\x1b[33m", "note": "\x1b[36m"}
_PLAIN = "\x1b[0m"


FORMS = ("text", "github")
"""How diagnostics are told: sentences for a person, or annotations of GitHub."""

_form = FORMS[0]


def tell_as(form: str | None) -> None:
    """Chooses the form of the diagnostics from here on; None: text.

    Raises:
        UsageError: there is no such form.
    """
    global _form
    if form is None:
        form = FORMS[0]
    if form not in FORMS:
        raise UsageError(f"--messages {form}: forms are {' and '.join(FORMS)}")
    _form = form


def put(text: str) -> None:
    """Data on stdout. Once its reader has gone away the work goes on, and nothing more is shown.

    Raises:
        UsageError: stdout takes no more (a full disk).
    """
    if sys.stdout is None:
        return
    _clear_progress()
    try:
        try:
            sys.stdout.write(text)
        except UnicodeEncodeError:
            encoding = sys.stdout.encoding
            whole_text = whole(text).encode(encoding, "backslashreplace")
            sys.stdout.write(whole_text.decode(encoding))
        sys.stdout.flush()
    except OSError as error:
        stdout_failed(error)


def put_json(record: Record) -> None:
    """One JSON object on stdout, in ASCII where stdout has another encoding than UTF-8; the
    versions of program and format come first.

    Raises:
        UsageError: stdout takes no more.
    """
    from mechkin_cli.tables.json_writer import json_text
    from mechkin_cli.version import versions

    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    whole_record = versions() | record
    put(json_text(whole_record, ascii=encoding.lower().replace("_", "-") not in ("utf-8", "utf8")))


def stdout_failed(error: OSError) -> None:
    """Gives stdout up: quietly where its reader has gone away.

    Raises:
        UsageError: it takes no more for another reason.
    """
    _discard(sys.stdout)
    if isinstance(error, BrokenPipeError):
        return
    reason = error.strerror or str(error)
    raise UsageError(
        f"stdout cannot be written: {reason}; send it to another place, or use --quiet"
    ) from error


def say(text: str = "") -> None:
    """One line on stderr; on a terminal, broken between words where it is too long.

    A stderr that takes nothing is no reason to stop the work.
    """
    _say(_fitted(text))


def _say(text: str, end: str = "\n") -> None:
    if sys.stderr is None:
        return
    _clear_progress()
    try:
        sys.stderr.write(text + end)
        sys.stderr.flush()
    except OSError:
        _discard(sys.stderr)


def _clear_progress() -> None:
    """Clears what is shown of the work that goes on."""
    progress = sys.modules.get("mechkin_cli.cli.progress")
    if progress is not None:
        progress.pause()


def _discard(stream: TextIO) -> None:
    """Lets whatever is still written to a stream go nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _on_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _fitted(text: str) -> str:
    text = legible(text)
    if not _on_terminal():
        return text
    from shutil import get_terminal_size
    from textwrap import wrap

    width = max(get_terminal_size((80, 24)).columns, 40)
    lines = wrap(text, width, subsequent_indent="    ", break_on_hyphens=False)
    return "\n".join(lines)


def say_diagnostics(diagnostics: Iterable[Diagnostic], file: str | None = None) -> None:
    """Diagnostics on stderr; those without a place of their own are put at the file."""
    for diagnostic in diagnostics:
        if _form == "github":
            from mechkin_cli.cli.annotations import annotation

            _say(annotation(diagnostic, file))
            continue
        text = str(diagnostic)
        if diagnostic.place is None and file is not None:
            text = f"{file}: {text}"
        _say(_coloured(_fitted(text), diagnostic.severity))


def refusal(path: Path, error: InvalidFile | UsageError) -> tuple[ExitCode, Record]:
    """Says why a file was not used; its exit code and its record."""
    file = shown(path)
    if isinstance(error, InvalidFile):
        say_diagnostics(error.diagnostics)
        code, diagnostics = ExitCode.INVALID_FILE, error.diagnostics
    else:
        code, diagnostics = ExitCode.USAGE, (Diagnostic("usage", "error", str(error)),)
        if _form == "github":
            say_diagnostics(diagnostics, file)
        else:
            say(f"mechkin: {error}")
    return code, {"file": file, "diagnostics": [found.record() for found in diagnostics]}


def _coloured(text: str, severity: str) -> str:
    if not _on_terminal() or os.environ.get("NO_COLOR"):
        return text
    word = f"{severity}:"
    return text.replace(word, f"{_COLOURS[severity]}{word}{_PLAIN}", 1)
