"""What mechkin has to say to a person: one frozen record per message, and the exceptions that
carry them.

A diagnostic names the place, what was measured, the limit and what to do. Unusable input raises
`InvalidFile`; what happens to a row of a table is data (`mechkin_cli.status`), never an exception.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

Severity = Literal["error", "warning", "note"]


class Place(NamedTuple):
    """A position in a text file; `line` and `column` count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class Diagnostic(NamedTuple):
    """One message.

    `code` is stable and made for programs (`unknown-key`, `dead-centre`, ...); `message` says what
    is wrong and what was expected; `measured` and `limit` are the numbers behind it, as text with
    units; `hint` says what to do.
    """

    code: str
    severity: Severity
    message: str
    place: Place | None = None
    measured: str | None = None
    limit: str | None = None
    hint: str | None = None

    def __str__(self) -> str:
        where = f"{self.place}: " if self.place else ""
        text = f"{where}{self.severity}: {self.message}"
        if self.measured is not None:
            bound = f" (limit {self.limit})" if self.limit is not None else ""
            text += f": {self.measured}{bound}"
        return f"{text}; {self.hint}" if self.hint else text

    def record(self) -> dict[str, object]:
        """The diagnostic as plain data for JSON; fields that are not set are left out."""
        place = self.place
        fields: dict[str, object | None] = {
            "code": self.code,
            "severity": self.severity,
            "message": self.message,
            "place": {"file": place.file, "line": place.line, "column": place.column}
            if place
            else None,
            "measured": self.measured,
            "limit": self.limit,
            "hint": self.hint,
        }
        return {name: value for name, value in fields.items() if value is not None}


class MechkinError(Exception):
    """Base of everything mechkin raises on purpose."""


class InvalidFile(MechkinError):
    """A mechanism file that cannot be used; `diagnostics` holds every independent reason found."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...] | list[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__("\n".join(map(str, self.diagnostics)))


class UsageError(MechkinError):
    """A call that asks for something that does not exist (a table, a mode, a file to write to)."""
