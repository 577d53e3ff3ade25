"""What can be wrong with an expression."""

from __future__ import annotations

from collections.abc import Iterable

from mechkin_cli.diagnostics import MechkinError


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
        return self.reason or nearest(self.name, self.known)


SHORT_LIST = 8
"""Up to so many known names are listed when none of them is near."""

LONGEST_COMPARED = 100
"""Characters of a name that are compared; the comparison takes the square of them."""


def nearest(name: str, known: Iterable[str]) -> str | None:
    """A hint that names the known names most like `name`."""
    from difflib import get_close_matches

    names = sorted(known)
    close = get_close_matches(name[:LONGEST_COMPARED], names, 3, 0.6)
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"known are {', '.join(names)}" if 0 < len(names) <= SHORT_LIST else None
