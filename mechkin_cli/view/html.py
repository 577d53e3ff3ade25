"""A page: a template with the data of a scene in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechkin_cli.view.encoding import script_json

if TYPE_CHECKING:
    from mechkin_cli.view.encoding import Plain

PLACE = "/*mechkin-data*/null"
"""Where the data stand in the template, once."""


def filled(page: str, data: Plain) -> bytes:
    """The page with data in it, in UTF-8.

    Raises:
        ValueError: the page has no place for data, or several.
    """
    if page.count(PLACE) != 1:
        raise ValueError(
            f"the template of the page has {PLACE} {page.count(PLACE)} times, not once"
        )
    before, _, after = page.partition(PLACE)
    return (before + script_json(data) + after).encode("utf-8")
