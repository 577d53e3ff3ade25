"""Values of a mechanism file changed in its text; comments, order and layout stay."""

from __future__ import annotations

from collections.abc import Mapping

from mechkin_cli.reading.document import Document, KeyPath
from mechkin_cli.reading.text import lines_of
from mechkin_cli.reading.yaml import ScalarNode, Style

_QUOTES = {Style.SINGLE_QUOTED: "'", Style.DOUBLE_QUOTED: '"'}


def with_values(document: Document, values: Mapping[KeyPath, str]) -> str:
    """The document's text with other values at some paths.

    Args:
        document: as read.
        values: texts that need no quotes, by the paths of the scalars that they replace.

    Raises:
        ValueError: a path that leads to no scalar on one line, which cannot be replaced.
    """
    lines = lines_of(document.text)
    found = []
    for path, value in values.items():
        node = document.node(path)
        if not isinstance(node, ScalarNode):
            raise ValueError(f"no value stands at {path}")
        line, column = node.mark
        quote = _QUOTES.get(node.style, "")
        written = f"{quote}{node.text}{quote}"
        if not lines[line - 1].startswith(written, column - 1):
            raise ValueError(f"the value at {path} is not written on one line")
        found.append((line - 1, column - 1, len(written), value))
    # from the end on, so that the places of the others stay
    for line, column, width, value in sorted(found, reverse=True):
        text = lines[line]
        lines[line] = f"{text[:column]}{value}{text[column + width :]}"
    return "\n".join(lines)
