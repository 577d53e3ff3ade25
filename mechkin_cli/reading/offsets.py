"""Where a character of a scalar's text stands in the source, behind quotes, escapes and folds.

In plain and block style only white space is folded, so the n-th visible character of the text is
the n-th visible character of the source. In quoted style an escape sequence stands for one
character.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from mechkin_cli.reading.nodes import Mark, Scalar, Style

_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]{2}|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|.|$)")

_ESCAPES_OF_BLANKS = ("", *" \tntrvfNLP_")


def source_mark(scalar: Scalar, offset: int, lines: list[str]) -> Mark:
    """The position of `scalar.text[offset]`, given the source `lines`.

    An offset behind the last character gives the place just behind it.

    >>> source_mark(Scalar("a''b", Mark(1, 4), Style.DOUBLE_QUOTED), 3, ["x: \\"a''b\\""])
    Mark(line=1, column=8)
    """
    visible_before = sum(not character.isspace() for character in scalar.text[:offset])
    if visible_before == 0 and scalar.style is Style.PLAIN:
        return scalar.mark
    at_blank = offset >= len(scalar.text) or scalar.text[offset].isspace()
    position = scalar.mark
    for seen, (mark, width) in enumerate(_visible(scalar, lines)):
        if at_blank and seen + 1 == visible_before:
            return _after(mark, width, scalar.text, offset)
        if not at_blank and seen == visible_before:
            return mark
        position = mark
    return position


def _after(mark: Mark, width: int, text: str, offset: int) -> Mark:
    blanks = len(text[:offset]) - len(text[:offset].rstrip())
    return Mark(mark.line, mark.column + width + blanks)


def _visible(scalar: Scalar, lines: list[str]) -> Iterator[tuple[Mark, int]]:
    """Mark and width of the source of each visible character, from the scalar's start on."""
    line, column = scalar.mark
    if scalar.style is Style.BLOCK:
        line, column = line + 1, 1
    elif scalar.style is not Style.PLAIN:
        column += 1
    for number in range(line, len(lines) + 1):
        source = lines[number - 1]
        index = column - 1 if number == line else 0
        while index < len(source):
            width = _width(source, index, scalar.style)
            if _is_visible(source, index, scalar.style):
                yield Mark(number, index + 1), width
            index += width


def _is_visible(source: str, index: int, style: Style) -> bool:
    if style is Style.DOUBLE_QUOTED and source[index] == "\\":
        return source[index + 1 : index + 2] not in _ESCAPES_OF_BLANKS
    return not source[index].isspace()


def _width(source: str, index: int, style: Style) -> int:
    if style is Style.DOUBLE_QUOTED and source[index] == "\\":
        found = _ESCAPE.match(source, index)
        return len(found[0]) if found else 1
    if style is Style.SINGLE_QUOTED and source.startswith("''", index):
        return 2
    return 1
