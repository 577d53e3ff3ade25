"""The classic mistake of one-line mappings: `{value: det(a, b, c)}` without quotes.

Inside braces and brackets YAML ends an unquoted scalar at the comma, so the example has the keys
`value`, `b` and `c)`. A scalar with an open parenthesis gives the mistake away.
"""

from __future__ import annotations

from bisect import bisect_left
from functools import lru_cache
from itertools import accumulate

from mechkin_cli.diagnostics import Diagnostic, Place
from mechkin_cli.reading.limits import LONGEST_EXPRESSION, MOST_PIECES
from mechkin_cli.reading.nodes import Node, Scalar, Style

_OPENING, _CLOSING = "([{", ")]}"
_ENDS_AN_EXPRESSION = ",}]"


def is_cut_off(node: Node) -> bool:
    """Whether the node is an unquoted scalar in which a parenthesis stays open."""
    return isinstance(node, Scalar) and node.style is Style.PLAIN and _open_parentheses(node) > 0


def pieces_of_mapping(pairs: list[tuple[Node, Node]], first: int) -> int:
    """The number of entries after `pairs[first]` that are pieces of its cut off value.

    A piece is a key without a value; the pieces end where the parentheses are closed.
    """
    still_open = _open_parentheses(pairs[first][1])
    end = first + 1
    last = min(len(pairs), end + MOST_PIECES)
    while end < last and still_open > 0 and is_empty(pairs[end][1]):
        still_open += _open_parentheses(pairs[end][0])
        end += 1
    return end - first - 1


def pieces_of_sequence(items: list[Node], first: int) -> int:
    """The number of items after `items[first]` that are pieces of it; 0 where nothing closes it."""
    still_open = _open_parentheses(items[first])
    for end in range(first + 1, min(len(items), first + 1 + MOST_PIECES)):
        still_open += _open_parentheses(items[end])
        if still_open <= 0:
            return end - first
    return 0


def is_empty(node: Node) -> bool:
    """Whether YAML reads the node as 'no value'."""
    nothing = ("", "~", "null", "Null", "NULL")
    return isinstance(node, Scalar) and node.style is Style.PLAIN and node.text in nothing


def cut_at_comma(scalar: Scalar, line: str, file: str) -> Diagnostic:
    """The message for a cut off scalar; `line` is the source line on which it starts."""
    whole = _whole_expression(line, scalar.mark.column - 1)
    hint = f'put it in quotes: "{whole}"' if whole else "put the whole expression in quotes"
    return Diagnostic(
        "comma-without-quotes",
        "error",
        f"YAML ends the value {_shortened(scalar.text)} at the comma or bracket that follows",
        Place(file, *scalar.mark),
        hint=hint,
    )


def _open_parentheses(node: Node) -> int:
    if not isinstance(node, Scalar) or node.style is not Style.PLAIN:
        return 0
    return node.text.count("(") - node.text.count(")")


def _whole_expression(line: str, start: int) -> str | None:
    depths, ends = _nesting(line)
    level = depths[min(start, len(line))]
    places = ends.get(level, [])
    first = bisect_left(places, start)
    if first < len(places) and places[first] < start + LONGEST_EXPRESSION:
        return line[start : places[first]].strip()
    source = line[start:]
    return source.strip() if depths[-1] == level and len(source) <= LONGEST_EXPRESSION else None


@lru_cache(maxsize=1)
def _nesting(line: str) -> tuple[list[int], dict[int, list[int]]]:
    """How deep each character of a line stands in brackets, and the end's depth; and by depth where
    an expression could end. A line may have thousands of values that ask."""
    steps = ((c in _OPENING) - (c in _CLOSING) for c in line)
    depths = list(accumulate(steps, initial=0))
    ends: dict[int, list[int]] = {}
    for index, character in enumerate(line):
        if character in _ENDS_AN_EXPRESSION or line.startswith(" #", index):
            ends.setdefault(depths[index], []).append(index)
    return depths, ends


def _shortened(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."
