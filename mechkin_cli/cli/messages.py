"""What the commands read and print: a mechanism, data on stdout, messages for a person on stderr.

At the end, diagnostics as annotations of GitHub: workflow commands, one line each. The runner takes
them from either stream of a step and shows them at the line of the file:
https://docs.github.com/actions/reference/workflow-commands-for-github-actions
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping
from enum import IntEnum
from errno import EINVAL
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from mechkin_cli import model, reading, tables
from mechkin_cli.diagnostics import Diagnostic, InvalidFile, UsageError, legible, whole
from mechkin_cli.verdict import FORMAT, __version__, versions

if TYPE_CHECKING:
    from mechkin_cli.model import Model


class ExitCode(IntEnum):
    """Of all commands; with several files the largest counts."""

    OK = 0
    DIFFERENCES = 1
    USAGE = 2
    INVALID_FILE = 3
    ROWS_MISSING = 4
    INTERNAL = 70
    INTERRUPTED = 130
    """By Ctrl-C, or by a request to end (SIGTERM, SIGHUP)."""


STDIN = Path("-")
"""Stands for the text on stdin; `./-` is a file of that name."""

STDIN_NAME = "stdin"
"""What messages and the folder of its tables call the text on stdin."""


def model_of(path: Path, settings: Mapping[str, str]) -> Model:
    """The checked mechanism file; what a text on stdin names is sought in the working folder.

    Raises:
        UsageError: it cannot be read, or an unknown parameter.
        InvalidFile: with every independent error and its place.
    """
    if not is_stdin(path):
        return model.load(path, settings)
    text = reading.decoded(_piped(), STDIN_NAME)
    return model.loads(text, STDIN_NAME, settings, folder=Path())


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
    if sys.stdin is None:
        raise UsageError("stdin is closed, so - has nothing to read; name a file")
    try:
        descriptor = sys.stdin.fileno()
        if os.isatty(descriptor):
            end = "Ctrl-Z and Enter" if os.name == "nt" else "Ctrl-D"
            say(f"reading the mechanism from the terminal; end it with {end}")
        pieces, left = [], reading.MOST_BYTES + 1
        while left and (piece := os.read(descriptor, left)):
            pieces.append(piece)
            left -= len(piece)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"stdin cannot be read: {reason}; name a file") from None
    return b"".join(pieces)


def mechanism_files(path: Path) -> list[Path]:
    """The mechanism files of a folder, or of the folders in it where it has none of its own, by
    name; a file stands for itself.

    Raises:
        UsageError: there are none.
    """
    if path.is_dir():
        files = [*path.glob("*.yaml")] or [*path.glob("*/*.yaml")]
        if not files:
            raise UsageError(f"{path} holds no mechanism files (*.yaml)")
        return sorted(files, key=lambda file: (file.name, file))
    if not path.exists():
        raise UsageError(f"{path} does not exist; give a mechanism file or a folder of them")
    return [path]


def content_of(path: Path) -> bytes:
    """The bytes of a committed file.

    Raises:
        UsageError: it cannot be read.
    """
    try:
        return reading.read_regular(path, reading.MOST_TABLE_BYTES)
    except FileNotFoundError:
        raise UsageError(f"there is no file {path}; check its name, and the folder") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot read {path}: {reason}; make it readable") from None


Record = dict[str, object]
"""Plain data for `--json`."""

_COLOURS = {"error": "\x1b[31m", "warning": "\x1b[33m", "note": "\x1b[36m"}
_PLAIN = "\x1b[0m"

FORMS = ("text", "github")
"""Forms of diagnostics: sentences for a person, or annotations of GitHub."""

_form = FORMS[0]

_tells_notes = True


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


def tell_notes(wanted: bool) -> None:
    """Chooses whether diagnostics that are notes are told from here on; warnings and errors are."""
    global _tells_notes
    _tells_notes = wanted


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
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    is_utf8 = encoding.lower().replace("_", "-") in ("utf-8", "utf8")
    put(tables.json_text(versions() | record, ascii=not is_utf8))


def version_text() -> str:
    """The versions of program, kernel and file format, a line each."""
    from mechkin_cli import kernel as core

    try:
        kernel = f"{core._kernel.widest} lanes ({core._kernel.instructions[core._kernel.widest]})"
    except core.KernelMissing:
        kernel = "missing"
    return f"mechkin {__version__}\nkernel  {kernel}\nformat  {FORMAT}\n"


def stdout_failed(error: OSError) -> None:
    """Gives stdout up: quietly where its reader has gone away.

    Raises:
        UsageError: it takes no more for another reason.
    """
    discard(sys.stdout)
    # a pipe of Windows without a reader says that its argument is invalid
    if isinstance(error, BrokenPipeError) or (os.name == "nt" and error.errno == EINVAL):
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


def _say(text: str) -> None:
    if sys.stderr is None:
        return
    _clear_progress()
    try:
        sys.stderr.write(f"{text}\n")
        sys.stderr.flush()
    except OSError:
        discard(sys.stderr)


def _clear_progress() -> None:
    progress = sys.modules.get("mechkin_cli.cli.progress")
    if progress is not None:
        progress.pause()


def discard(stream: TextIO) -> None:
    """Lets whatever is still written to a stream go nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _on_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _fitted(text: str) -> str:
    return fitted(legible(text), sys.stderr)


def fitted(text: str, stream: TextIO | None, indent: int = 4) -> str:
    """A line, on a terminal in as many as its width needs, those after the first indented."""
    if stream is None or not stream.isatty():
        return text
    from shutil import get_terminal_size
    from textwrap import wrap

    width = max(get_terminal_size((80, 24)).columns, 40)
    lines = wrap(text, width, subsequent_indent=" " * indent, break_on_hyphens=False)
    return "\n".join(lines)


def say_diagnostics(diagnostics: Iterable[Diagnostic], file: str | None = None) -> None:
    """Diagnostics on stderr; those without a place of their own are put at the file."""
    for diagnostic in diagnostics:
        if diagnostic.severity == "note" and not _tells_notes:
            continue
        if _form == "github":
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


_LEVELS = {"error": "error", "warning": "warning", "note": "notice"}


def annotation(diagnostic: Diagnostic, file: str | None = None) -> str:
    """The workflow command of a diagnostic; one without a place is put at the top of `file`."""
    place = diagnostic.place
    fields = {"title": f"mechkin {diagnostic.code}"}
    if place is not None and place.in_file:
        at = {"file": _from_the_top(place.file), "line": str(place.line), "col": str(place.column)}
        fields = at | fields
    elif file is not None:
        fields = {"file": _from_the_top(file)} | fields
    sentence = str(diagnostic._replace(place=None)).removeprefix(f"{diagnostic.severity}: ")
    if place is not None and not place.in_file:
        sentence = f"{place}: {sentence}"
    listed = ",".join(
        f"{name}={_data(value).replace(':', '%3A').replace(',', '%2C')}"
        for name, value in fields.items()
    )
    return f"::{_LEVELS[diagnostic.severity]} {listed}::{_data(legible(sentence))}"


def _from_the_top(file: str) -> str:
    """The file as the repository knows it: a step may run in a folder of it."""
    top = os.environ.get("GITHUB_WORKSPACE")
    if not top:
        return file
    try:
        path = os.path.relpath(os.path.abspath(file), os.path.abspath(top))
    except ValueError:  # on another drive of Windows
        return file
    return file if path.startswith(os.pardir) else path.replace(os.sep, "/")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def parameters(settings: list[str] | None) -> dict[str, str]:
    """The texts of `--set` as a mapping; errors are those of `values_by_name`."""
    return values_by_name("--set", settings or (), "NAME=VALUE, for example --set P1=0.6in")


def values_by_name(option: str, texts: Iterable[str], expected: str) -> dict[str, str]:
    """The texts of an option, each a name and its value with `=` between them, as a mapping.

    Raises:
        UsageError: a text without `=`, name or value, or a name given twice.
    """
    values = {}
    for text in texts:
        name, _, value = (part.strip() for part in text.partition("="))
        if not name or not value:
            raise UsageError(f"{option} {text}: expected {expected}")
        if name in values:
            raise UsageError(f"{option} gives {name} twice; leave one of them out")
        values[name] = value
    return values
