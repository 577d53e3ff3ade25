"""The page: the template that is built from `page/`, with the data of a scene in it."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from mechkin_cli.view.encoding import script_json

if TYPE_CHECKING:
    from mechkin_cli.view.encoding import Plain

NAME = "view.html"
"""Name of the page where none is given: it stands beside the tables."""

TEMPLATE = Path(__file__).with_name("page.html")
PLACE = "/*mechkin-data*/null"
"""Where the data stand in the template, once."""


@cache
def template() -> str:
    """The text of the page without data."""
    return TEMPLATE.read_text(encoding="utf-8")


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
