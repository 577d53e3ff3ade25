"""What the reader makes of a YAML text: scalars, sequences and mappings that know where they stand.

Scalars stay text, so that `1e-3`, `on` and `010` mean what the schema says and not what YAML
guesses.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple, TypeAlias


class Mark(NamedTuple):
    """A position in a text; line and column count from 1, columns in characters."""

    line: int
    column: int


class Style(Enum):
    """How a scalar is written; decides how its characters lie in the source text."""

    PLAIN = "plain"
    SINGLE_QUOTED = "single quoted"
    DOUBLE_QUOTED = "double quoted"
    BLOCK = "block"


class Scalar(NamedTuple):
    """One value as text; `mark` is its first character (the quote, where there is one)."""

    text: str
    mark: Mark
    style: Style


class Sequence(NamedTuple):
    """A list; `mark` is its bracket, or its first dash in block style."""

    items: tuple[Node, ...]
    mark: Mark


class Entry(NamedTuple):
    """One `key: value` of a mapping; `mark` is the first character of the key."""

    mark: Mark
    value: Node


class Mapping(NamedTuple):
    """Keys and values in the order written; `mark` is the brace, in block style the first key."""

    entries: dict[str, Entry]
    mark: Mark


Node: TypeAlias = Scalar | Sequence | Mapping
PlainData: TypeAlias = "str | list[PlainData] | dict[str, PlainData]"


def plain_data(node: Node) -> PlainData:
    """The node as dict, list and str, without places.

    >>> plain_data(Sequence((Scalar("1", Mark(1, 2), Style.PLAIN),), Mark(1, 1)))
    ['1']
    """
    if isinstance(node, Scalar):
        return node.text
    if isinstance(node, Sequence):
        return [plain_data(item) for item in node.items]
    return {key: plain_data(entry.value) for key, entry in node.entries.items()}
