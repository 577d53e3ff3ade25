"""The error of a unit text."""

from __future__ import annotations

from mechkin_cli.diagnostics import MechkinError


class UnitError(MechkinError):
    """A unit that does not exist, is malformed, or does not measure what it is used for.

    `offset` counts characters from the start of the unit text; `key` is the entry of the file's
    `units:` mapping, where the text stands in one.
    """

    def __init__(
        self, message: str, offset: int = 0, hint: str | None = None, key: str | None = None
    ) -> None:
        self.message = message
        self.offset = offset
        self.hint = hint
        self.key = key
        super().__init__(message)

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message
