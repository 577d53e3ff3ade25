"""From a path to text: limits, size, encoding and invisible characters, checked before any YAML.

The limits keep bad input from exhausting time or memory. A program's file of ten thousand four-bars
has 2.7 MB and 650 000 events; a file written by hand has some thousand lines. Up to the limits
libyaml works for some seconds, the parser in Python for a minute.
"""

from __future__ import annotations

import codecs
import errno
import os
import re
import stat
from pathlib import Path
from typing import Final

from mechkin_cli.diagnostics import Diagnostic, InvalidFile, Number, Place, UsageError

MOST_BYTES: Final = 1 << 22
"""Size of the file in bytes."""

MOST_EVENTS: Final = 1_000_000
"""YAML events (scalars, starts and ends of lists and mappings) in a file."""

MOST_LEVELS: Final = 32
"""Lists and mappings inside one another; format 1 itself needs eight."""

MOST_PIECES: Final = 100
"""Pieces of one expression that YAML has cut at its commas; no function takes so many values."""

LONGEST_EXPRESSION: Final = 4000
"""Characters of a line searched for the end of an expression that YAML has cut."""

MOST_DIAGNOSTICS: Final = 50
"""Messages shown for one file; the rest is counted in one more message."""

MOST_TABLE_BYTES: Final = 1 << 30
"""Size of a table on disk that is compared; committed tables have some kilobytes."""

SHORT_NAME: Final = 8
"""Letters of a file's name below which a slip makes the name of another mechanism."""

_PIECE = 1 << 20
_FLAGS = os.O_RDONLY | sum(  # each where it exists: without the last, Windows changes line ends
    getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_BINARY")
)


class NotRegular(OSError):
    """A folder, device, pipe or socket stands where a file is to be read; nothing was opened."""

    def __init__(self, path: Path, mode: int) -> None:
        self.is_folder = stat.S_ISDIR(mode)
        what = "a folder" if self.is_folder else "not a regular file"
        super().__init__(errno.EINVAL, f"it is {what}", str(path))


def read_regular(path: Path, most: int) -> bytes:
    """The content of a file, of which no more than `most` + 1 bytes are read.

    Whatever stands at the path, reading neither waits nor goes on for ever.

    Raises:
        NotRegular: it is not a regular file.
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


_LINE_BREAK = re.compile(r"\r\n|\r|\n")
_TAB_IN_INDENTATION = re.compile(r"^ *(\t)[ \t]*[^ \t\r\n#]", re.MULTILINE)
_DIRECTIVE = re.compile(r"^%", re.MULTILINE)
# the refused characters: compiling the complement takes some milliseconds of every run
INVISIBLE = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]"
)
"""Characters that YAML does not allow, or at which editors and parsers count lines differently."""
_OTHER_ENCODINGS = (codecs.BOM_UTF32_LE, codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def read_text(path: str | Path) -> str:
    """The text of a file, decoded from UTF-8 (a byte order mark is dropped).

    Raises `UsageError` where there is no file to read, `InvalidFile` where its content cannot be a
    mechanism file.
    """
    path = Path(path)
    try:
        content = read_regular(path, MOST_BYTES)
        if len(content) > MOST_BYTES:
            check_size(max(len(content), path.stat().st_size), str(path))
    except NotRegular as error:
        if error.is_folder:
            cure = f"is a directory; name a mechanism file in it{_example(path)}"
            raise UsageError(f"{path} {cure}") from None
        raise UsageError(f"{path} is not a regular file; save the mechanism in a file") from None
    except FileNotFoundError:
        raise UsageError(f"there is no file {path}{_similar(path)}") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        message = f"{path} cannot be read: {reason}; check the path and its rights"
        raise UsageError(message) from None
    return decoded(content, str(path))


def decoded(content: bytes, file: str, is_yaml: bool = True) -> str:
    """The text of a file's bytes; `file` is its name in messages. Raises `InvalidFile`.

    In a text that is not YAML tabs may begin a line, and so may a percent sign.
    """
    check_size(len(content), file)
    try:
        text = content.decode("utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        raise _not_utf8(content, error, file) from None
    check_characters(text, file, is_yaml)
    return text


def check_size(size: int, file: str) -> None:
    """Raise `InvalidFile` where a text has more bytes than a mechanism file may have."""
    if size > MOST_BYTES:
        diagnostic = Diagnostic(
            "file-too-large",
            "error",
            "the file is too large for a mechanism file",
            Place(file, 1, 1),
            measured=f"{size} bytes",
            limit=f"{MOST_BYTES} bytes",
            hint="keep long tables of numbers in CSV files",
            numbers=(Number("bytes", size, limit=MOST_BYTES),),
        )
        raise InvalidFile([diagnostic])


def check_characters(text: str, file: str, is_yaml: bool = True) -> None:
    """Raise `InvalidFile` at the first character that a mechanism file may not hold.

    These are NUL and other control characters and invisible line breaks; in YAML also tabs in the
    indentation, and directives (`%` in the first column).
    """
    if found := INVISIBLE.search(text):
        place = place_at(text, found.start(), file)
        hint = "delete it; a mechanism file is plain UTF-8 text"
        raise _invalid("bad-character", f"{character_name(found[0])} in the text", place, hint)
    if not is_yaml:
        return
    if found := _TAB_IN_INDENTATION.search(text):
        place = place_at(text, found.start(1), file)
        raise _invalid("tab", "a tab in the indentation", place, "indent with blanks")
    if found := _DIRECTIVE.search(text):
        place = place_at(text, found.start(), file)
        hint = "delete the line, or put a text that starts with % in quotes"
        raise _invalid("directive", "YAML directives (%) are not used here", place, hint)


def character_name(character: str) -> str:
    """The name in messages of a character that cannot be shown."""
    code = ord(character)
    return "a NUL character" if code == 0 else f"the invisible character U+{code:04X}"


def place_at(text: str, index: int, file: str) -> Place:
    """The line and column of the character `text[index]`."""
    line, start = 1, 0
    for found in _LINE_BREAK.finditer(text, 0, index):
        line, start = line + 1, found.end()
    return Place(file, line, index - start + 1)


def lines_of(text: str) -> list[str]:
    """The lines of a text as YAML and editors count them, without their breaks."""
    return _LINE_BREAK.split(text)


def shortened(text: str) -> str:
    """A text of the file as messages show it: on one line, not too long."""
    text = re.sub(r"\s+", " ", text)
    return text if len(text) <= 40 else text[:37] + "..."


def _example(folder: Path) -> str:
    names = sorted(path.name for path in folder.glob("*.yaml"))
    return f", for example {folder / names[0]}" if names else ""


def _similar(path: Path) -> str:
    try:
        names = [entry.name for entry in path.parent.glob("*.y*ml") if entry.is_file()]
    except OSError:
        names = []
    meant = [name for name in sorted(names) if _is_slip(path.stem, Path(name).stem)]
    return f"; did you mean {path.parent / meant[0]}?" if meant else "; check the path"


def _is_slip(asked: str, name: str) -> bool:
    """Whether a file's name differs from what was asked by case, blanks or one slip of the keys.

    Short names, and those with other digits, are other files: rscr and rcsr are two mechanisms.
    """
    asked, name = (re.sub(r"[\s_-]", "", text.casefold()) for text in (asked, name))
    if asked == name:
        return True
    if re.sub(r"\D", "", asked) != re.sub(r"\D", "", name) or len(asked) < SHORT_NAME:
        return False
    start = _alike(asked, name)
    asked, name = asked[start:][::-1], name[start:][::-1]
    end = _alike(asked, name)
    asked, name = asked[end:], name[end:]
    return max(len(asked), len(name)) == 1 or (len(asked) == 2 and asked == name[::-1])


def _alike(one: str, other: str) -> int:
    """How many letters two texts have in common from their start on."""
    return next(
        (k for k, (a, b) in enumerate(zip(one, other, strict=False)) if a != b),
        min(len(one), len(other)),
    )


def _not_utf8(content: bytes, error: UnicodeDecodeError, file: str) -> InvalidFile:
    if content.startswith(_OTHER_ENCODINGS):
        place, message = Place(file, 1, 1), "the file is UTF-16 or UTF-32 text, not UTF-8"
    else:
        before = content[: error.start].decode("utf-8").removeprefix("\ufeff")
        place = place_at(before, len(before), file)
        message = f"the byte 0x{content[error.start]:02X} is not UTF-8 text"
    return _invalid("encoding", message, place, "save the file as UTF-8")


def _invalid(code: str, message: str, place: Place, hint: str) -> InvalidFile:
    return InvalidFile([Diagnostic(code, "error", message, place, hint=hint)])
