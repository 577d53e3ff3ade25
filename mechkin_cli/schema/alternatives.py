"""Values that come in several forms: which form is meant is told by one look at the value.

Each form carries a tag. Tags start with a parenthesis, which no key of the format does, so that
they can be told apart from keys in the location of an error.
"""

from collections.abc import Callable
from typing import Any, NamedTuple


class Tag(NamedTuple):
    """The tag of one form."""

    tag: str


class Choice(NamedTuple):
    """Which form a value has: `choose` gives its tag, None where the word is none of `words`.

    `key` is the key that holds the word; both are None where every value has a form.
    """

    choose: Callable[[Any], str | None]
    key: str | None = None
    words: str | None = None


def by_word(key: str, choose: Callable[[dict[str, Any]], str | None], words: str) -> Choice:
    """The choice for mappings in which the value of `key` says the form.

    `choose` is shown the mapping and gives the tag, None where the word is unknown; the error then
    names the `words` possible.
    """

    def tag(value: Any) -> str | None:
        return choose(_as_mapping(value))

    return Choice(tag, key, words)


def _as_mapping(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    # a section that is already built, as Python callers may pass
    return getattr(value, "__dict__", {})
