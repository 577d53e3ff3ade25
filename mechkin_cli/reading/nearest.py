"""The known name that a mistyped one is most like."""

from __future__ import annotations

from collections.abc import Iterable


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The entry of `known` most similar to `name`, or None where nothing is close.

    Letters that differ only in case count as the same.

    >>> nearest("axxis", ["point", "axis"])
    'axis'
    """
    from difflib import get_close_matches  # only on the way to a message

    by_folded = {candidate.casefold(): candidate for candidate in known}
    matches = get_close_matches(name[:100].casefold(), by_folded, n=1)
    return by_folded[matches[0]] if matches else None
