"""What an annotation may say of a value beside its Python type: `Annotated[str, Before(...), ...]`.

The validator (`compiled`) obeys `Limits`, `Before`, `After` and the discriminators of
`alternatives`; the JSON Schema shows them, and `Named` and `Shown`, too.
"""

from collections.abc import Callable
from typing import Any, NamedTuple


class Named(NamedTuple):
    """The definition of the JSON Schema that the type and the rules before it make up."""

    name: str


class Limits(NamedTuple):
    """Bounds of a number, of a length, or the form of a text; None: no such bound."""

    min_length: int | None = None
    max_length: int | None = None
    ge: int | None = None
    le: int | None = None
    pattern: str | None = None


class Before(NamedTuple):
    """A function that is shown the value as it was given, and returns what is validated."""

    function: Callable[[Any], Any]


class After(NamedTuple):
    """A function that is shown the valid value, and returns or refuses it."""

    function: Callable[[Any], Any]


class Shown(NamedTuple):
    """What editors are told about a scalar: the JSON types it may have, a help text, examples."""

    types: tuple[str, ...]
    description: str
    examples: tuple[str | float, ...] = ()


class Dimension(NamedTuple):
    """The dimension an expression must have, in words, with examples: for readers and editors."""

    name: str
    examples: tuple[str | float, ...]


class ShortForm(NamedTuple):
    """Tells editors that a section may be written as a single value."""

    types: tuple[str, ...]
    description: str
    pattern: str | None = None


class Barred(NamedTuple):
    """A pattern that editors refuse; the reader has a rule with words of its own."""

    pattern: str
