"""Sections that come in several forms: which form is meant is told by one look at the keys.

Each form carries a tag. Tags start with a parenthesis, which no key of the format does, so that
they can be told apart from keys in the location of an error.
"""

from collections.abc import Callable
from typing import Any

from pydantic import Discriminator


def by_word(key: str, choose: Callable[[dict[str, Any]], str | None], words: str) -> Discriminator:
    """A discriminator for mappings in which the value of `key` says the form.

    `choose` is shown the mapping and gives the tag, None where the word is unknown; the error then
    names the `words` possible.
    """

    def tag(value: Any) -> str | None:
        return choose(_as_mapping(value))

    return Discriminator(
        tag,
        custom_error_type="unknown-word",
        custom_error_message=f"expected one of {words}",
        custom_error_context={"key": key, "words": words},
    )


def _as_mapping(value: Any) -> dict[str, Any]:
    if isinstance(value, dict):
        return value
    # a section that is already built, as Python callers may pass
    return getattr(value, "__dict__", {})
