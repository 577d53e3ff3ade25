"""The known names that a mistyped one is most like, and the hint that says so."""

from __future__ import annotations

from collections.abc import Iterable

SHORT_LIST = 8
"""Up to so many known names are listed when none of them is near."""

LONGEST_COMPARED = 100
"""Characters of a name that are compared; the comparison takes the square of them."""


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The entry of `known` most similar to `name`, or None where nothing is close.

    >>> nearest("axxis", ["point", "axis"])
    'axis'
    """
    return next(iter(_closest(name, known, 1)), None)


def nearest_hint(name: str, known: Iterable[str]) -> str | None:
    """A hint that names the known names most like `name`, or all of them when they are few."""
    names = sorted(known)
    close = _closest(name, names, 3)
    if close:
        return f"did you mean {' or '.join(close)}?"
    return f"known are {', '.join(names)}" if 0 < len(names) <= SHORT_LIST else None


def _closest(name: str, known: Iterable[str], most: int) -> list[str]:
    """Best first; letters that differ only in case count as the same."""
    from difflib import get_close_matches  # only on the way to a message

    by_folded = {candidate.casefold(): candidate for candidate in sorted(known)}
    asked = name[:LONGEST_COMPARED].casefold()
    return [by_folded[match] for match in get_close_matches(asked, by_folded, most, 0.6)]
