"""What mechkin has to say to a person: one frozen record per message, and the exceptions that
carry them.

A diagnostic names the place, what was measured, the limit and what to do. Unusable input raises
`InvalidFile`; what happens to a row of a table is data (`mechkin_cli.verdict`), never an exception.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from math import isfinite
from typing import Literal

from mechkin_cli.record import NamedTuple

LONGEST_NAME = 60
"""Characters of an unknown name that a message repeats."""

Severity = Literal["error", "warning", "note"]


class Place(NamedTuple):
    """A position in a text; `line` and `column` count from 1.

    `line` is 0 in a value from the command line, and `file` then the option (`--set P1`).
    """

    file: str
    line: int
    column: int

    @property
    def in_file(self) -> bool:
        """Whether the text is a file's."""
        return self.line > 0

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}" if self.in_file else self.file

    def record(self) -> dict[str, object]:
        """The place as plain data for JSON."""
        place: dict[str, object] = {"file": self.file, "line": self.line, "column": self.column}
        if not self.in_file:
            del place["line"]
        return place


class Number(NamedTuple):
    """A measured number for programs: its name (`O1.theta`, `rows`), value, unit and limit."""

    name: str
    value: float
    unit: str = ""
    limit: float | None = None

    def record(self) -> dict[str, object]:
        """The number as plain data for JSON; without unit or limit where it has none."""
        fields: dict[str, object | None] = {
            "name": self.name,
            "value": self.value,
            "unit": self.unit or None,
            "limit": self.limit,
        }
        return {name: value for name, value in fields.items() if value is not None}


class Diagnostic(NamedTuple):
    """One message.

    `code` is stable and made for programs (`unknown-key`, `dead-centre`, ...); `message` says what
    is wrong and what was expected; `measured` and `limit` are the numbers behind it, as text with
    units, and `numbers` the same for programs; `hint` says what to do.
    """

    code: str
    severity: Severity
    message: str
    place: Place | None = None
    measured: str | None = None
    limit: str | None = None
    hint: str | None = None
    numbers: tuple[Number, ...] = ()

    def __str__(self) -> str:
        where = f"{self.place}: " if self.place else ""
        text = f"{where}{self.severity}: {self.message}"
        if self.place and not self.place.in_file and self.place.column > 1:
            text += f" (at character {self.place.column} of the value)"
        if self.measured is not None:
            text += f": {self.measured}"
        if self.limit is not None:
            text += f" (limit {self.limit})"
        return f"{text}; {self.hint}" if self.hint else text

    def record(self) -> dict[str, object]:
        """The diagnostic as plain data for JSON; fields that are not set are left out."""
        fields: dict[str, object | None] = {
            "code": self.code,
            "severity": self.severity,
            "message": self.message,
            "place": self.place.record() if self.place else None,
            "measured": self.measured,
            "limit": self.limit,
            "hint": self.hint,
            "numbers": [n.record() for n in self.numbers if isfinite(n.value)] or None,
        }
        return {name: value for name, value in fields.items() if value is not None}


class MechkinError(Exception):
    """Base of everything mechkin raises on purpose."""


class InvalidFile(MechkinError):
    """A mechanism file that cannot be used; `diagnostics` holds every independent reason found."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...] | list[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(map(str, self.diagnostics)))

    def __reduce__(self) -> tuple[type[InvalidFile], tuple[tuple[Diagnostic, ...]]]:
        return InvalidFile, (self.diagnostics,)


class UsageError(MechkinError):
    """A call that asks for something that does not exist (a table, a mode, a file to write to)."""


# Text that cannot be shown as it is: bytes of file names that are no text, control characters.

SURROGATES = re.compile("[\ud800-\udfff]")
"""Half characters: no encoding has them; Python has them for bytes of file names."""


def legible(text: str, also: str = "\n") -> str:
    r"""The text with every character that does not print, except those in `also`, as an escape.

    Example:
        >>> legible("a\x1b[31m\udcff")
        'a\\x1b[31m\\xff'
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in also else escape(c) for c in text)


def whole(text: str) -> str:
    """The text with what no encoding has as escapes; all other characters stay."""
    return SURROGATES.sub(lambda found: escape(found[0]), text)


def escape(character: str) -> str:
    r"""`\xff` for the byte 0xff of a file name, else as Python writes the character in ASCII."""
    code = ord(character)
    return f"\\x{code - 0xDC00:02x}" if 0xDC80 <= code <= 0xDCFF else ascii(character)[1:-1]


# The known names that a mistyped one is most like, and the hint that says so.

SHORT_LIST = 8
"""Up to so many known names are listed when none of them is near."""

LONGEST_COMPARED = 100
"""Characters of a name that are compared; the comparison takes the square of them."""


LIKE_NAMES, LIKE_WORDS = 0.6, 0.7
"""Likeness of names, and of the words behind one owner, from which on one may be meant."""


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The entry of `known` most similar to `name`, or None where nothing is close.

    >>> nearest("axxis", ["point", "axis"])
    'axis'
    """
    return next(iter(_closest(name, known, 1)), None)


def nearest_hint(name: str, known: Iterable[str]) -> str | None:
    """A hint that names the known names most like `name`, or all of them when they are few.

    Of a dotted name whose owner is known these are names of that owner.

    >>> nearest_hint("O.forc", ["O.force", "O.theta", "D.force"])
    'did you mean O.force?'
    """
    names = sorted(known)
    owner, dot, word = name.partition(".")
    words = [each.removeprefix(owner + dot) for each in names if each.startswith(owner + dot)]
    if dot and words:
        close = [f"{owner}.{each}" for each in _closest(word, words, 3, LIKE_WORDS)]
        names = [f"{owner}.{each}" for each in words]
    else:
        close = _closest(name, names, 3)
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"known are {', '.join(names)}" if 0 < len(names) <= SHORT_LIST else None


def _closest(name: str, known: Iterable[str], most: int, like: float = LIKE_NAMES) -> list[str]:
    """Best first; letters that differ only in case count as the same."""
    from difflib import get_close_matches  # only on the way to a message

    by_folded = {candidate.casefold(): candidate for candidate in sorted(known)}
    asked = name[:LONGEST_COMPARED].casefold()
    return [by_folded[match] for match in get_close_matches(asked, by_folded, most, like)]
