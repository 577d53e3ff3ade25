"""Text that cannot be shown as it is: bytes of file names that are no text, control characters."""

from __future__ import annotations

import re

SURROGATES = re.compile("[\ud800-\udfff]")
"""Half characters: no encoding has them; Python has them for bytes of file names."""


def legible(text: str, also: str = "\n") -> str:
    r"""The text with every character that does not print, except those in `also`, as an escape.

    Example:
        >>> legible("a\x1b[31m\udcff")
        'a\\x1b[31m\\xff'
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in also else escape(c) for c in text)


def whole(text: str) -> str:
    """The text with what no encoding has as escapes; all other characters stay."""
    return SURROGATES.sub(lambda found: escape(found[0]), text)


def escape(character: str) -> str:
    r"""`\xff` for the byte 0xff of a file name, else as Python writes the character in ASCII."""
    code = ord(character)
    return f"\\x{code - 0xDC00:02x}" if 0xDC80 <= code <= 0xDCFF else ascii(character)[1:-1]
