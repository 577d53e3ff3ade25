"""What can be wrong with an expression."""

from __future__ import annotations

from collections.abc import Iterable

from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.nearest import nearest_hint


class ExpressionError(MechkinError):
    """An expression that cannot be read or evaluated.

    `offset` counts characters from the start of the expression's text; `hint` says what to do;
    `name` is the parameter whose text it is, where it is one's.
    """

    def __init__(
        self, message: str, offset: int = 0, hint: str | None = None, name: str | None = None
    ) -> None:
        self.message = message
        self.offset = offset
        self.hint = hint
        self.name = name
        super().__init__(message)

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message


class UnknownName(KeyError):
    """Raised by a resolver for a name that it does not have; `known` are the names that it has,
    `reason` why it has none of this kind."""

    def __init__(self, name: str, known: Iterable[str] = (), reason: str | None = None) -> None:
        self.name = name
        self.known = known
        self.reason = reason
        super().__init__(name)

    @property
    def hint(self) -> str | None:
        """The reason, or else the nearest known names, or all of them when they are few."""
        return self.reason or nearest_hint(self.name, self.known)
