"""Text of an expression to tokens."""

from __future__ import annotations

import re
from typing import Literal, NamedTuple

from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.limits import MAX_TEXT_LENGTH

Kind = Literal["number", "name", "component", "symbol", "end"]

_TOKEN = re.compile(
    r"""
    (?P<number>    (?: [0-9]+ \.? [0-9]* | \. [0-9]+ ) (?: [eE] [+-]? [0-9]+ )? )
  | (?P<word>      (?: and | or | not ) (?! [A-Za-z0-9_.] ) )
  | (?P<name>      [A-Za-z_][A-Za-z0-9_]* (?: \. [A-Za-z_][A-Za-z0-9_]* )* )
  | (?P<component> \. [A-Za-z_][A-Za-z0-9_]* )
  | (?P<symbol>    \*\* | [<>=!]= | [-+*/^()\[\],<>] )
    """,
    re.VERBOSE,
)
_SPACE = re.compile(r"[ \t\r\n]*")

_INSTEAD = {
    "−": "write the minus sign as -",
    "–": "write the minus sign as -",
    "×": "write multiplication as *",
    "·": "write multiplication as *",
    "÷": "write division as /",
    "°": "write degrees as deg, such as 12 deg",
    "²": "write powers as ^2",
    "³": "write powers as ^3",
    "π": "write pi",
    "µ": "write micrometres as um",
    "μ": "write micrometres as um",
    "{": "write ( and )",
    "}": "write ( and )",
    "=": "an expression has no =; write == to compare",
    "≤": "write <=",
    "≥": "write >=",
    "≠": "write !=",
    "&": "write and",
    "|": "write or; a magnitude is abs(x), of a vector norm(a)",
    "!": "write not, or != to compare",
    "?": "write a choice as if(condition, a, b)",
    "%": "write per cent as /100",
    ";": "separate arguments with a comma",
    "'": "leave out the quotes",
    '"': "leave out the quotes",
    ".": "a component is written as .x, .y or .z",
}


VANISHES = "is too small: in SI units it would be zero"
WRITE_ZERO = "check its exponent and unit, or write 0"
"""What is said of a number that a change of unit makes zero."""


def vanishes(text: str, value: float) -> bool:
    """Whether a number was written that is not zero, and none of its digits are left."""
    return value == 0.0 and any(digit in "123456789" for digit in text.lower().partition("e")[0])


class Token(NamedTuple):
    """A piece of text from `start` to `end` (exclusive), both counted from the text's start."""

    kind: Kind
    text: str
    start: int
    end: int


def tokenize(text: str) -> list[Token]:
    """All tokens of a text, the last of kind `end`.

    Raises:
        ExpressionError: the text is too long, or has a character that no expression has.
    """
    if len(text) > MAX_TEXT_LENGTH:
        raise ExpressionError(
            f"the expression has {len(text)} characters (limit {MAX_TEXT_LENGTH})",
            0,
            "split it into parameters",
        )
    tokens: list[Token] = []
    position = _skip_space(text, 0)
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise _unexpected(text[position], position)
        tokens.append(Token(_kind(match), match[0], match.start(), match.end()))
        position = _skip_space(text, match.end())
    tokens.append(Token("end", "", len(text), len(text)))
    return tokens


def _kind(match: re.Match[str]) -> Kind:
    for kind in ("number", "name", "component"):
        if match[kind] is not None:
            return kind
    return "symbol"


def _skip_space(text: str, position: int) -> int:
    match = _SPACE.match(text, position)
    return match.end() if match else position


def _unexpected(character: str, offset: int) -> ExpressionError:
    shown = character if character.isprintable() else f"U+{ord(character):04X}"
    return ExpressionError(
        f"unexpected character '{shown}'",
        offset,
        _INSTEAD.get(
            character, "an expression has numbers, names, + - * / ^ ( ) [ ], comparisons and commas"
        ),
    )
