"""Texts of a file as they stand in tables: words, whatever a spreadsheet or a page would make of
them.

A spreadsheet computes a cell of a CSV file that begins with =, +, - or @; it takes one that begins
with an apostrophe for text. In Markdown what would be markup is escaped. Numbers never come here.
"""

from __future__ import annotations

import re
from urllib.parse import quote

_FORMULA = re.compile(r"(^|[;\t\r\n])(?=[\s'\"]*[=+\-@＝＋－＠])|^(?=[\t\r\n])")
_MARKUP = re.compile(r"[\\|`*\[\]~]|(?<![^\W_])_|_(?![^\W_])")
_ENTITY = re.compile(r"&(?=#?\w+;)")
_BLOCK = re.compile(r"^(?=[#>+=-])|^(\d{1,9})(?=[.)])")
_TURNS_THE_LINE = re.compile("[\u202a-\u202e\u2066-\u2069]")
"""Characters after which text runs the other way: a page shows other words than it holds."""


def csv_text(text: str) -> str:
    """The text, with an apostrophe where a spreadsheet would find a formula.

    Example:
        >>> csv_text("=1+1"), csv_text("a; -b"), csv_text("max(a, -b)")
        ("'=1+1", "a;' -b", 'max(a, -b)')
    """
    return _FORMULA.sub(lambda found: f"{found[0]}'", text)


def markdown_text(text: str) -> str:
    r"""The text in one line and without markup.

    Example:
        >>> markdown_text("theta_1 [a](b) <b>|"), markdown_text("R&D &lt;")
        ('theta_1 \\[a\\](b) &lt;b>\\|', 'R&D &amp;lt;')
    """
    line = _TURNS_THE_LINE.sub("", " ".join(text.split()))
    line = _MARKUP.sub(lambda found: f"\\{found[0]}", line)
    return _ENTITY.sub("&amp;", line).replace("<", "&lt;")


def markdown_line(text: str) -> str:
    """As `markdown_text`, for a text that begins a line or an item of a list."""
    return _BLOCK.sub(lambda found: f"{found[0]}\\", markdown_text(text))


def link_target(path: str) -> str:
    """A relative path as it stands in a link."""
    return quote(path, safe="/", errors="surrogateescape")
