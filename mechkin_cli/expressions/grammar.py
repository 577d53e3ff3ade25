"""Text of an expression to tokens."""

from __future__ import annotations

import math
import re
from typing import Literal

from mechkin_cli.diagnostics import nearest_hint
from mechkin_cli.expressions.functions import FORMS, FUNCTIONS, INSTEAD
from mechkin_cli.expressions.operations import COMPARED
from mechkin_cli.expressions.quantity import (
    MAX_DEPTH,
    MAX_NODES,
    MAX_QUOTED,
    MAX_TEXT_LENGTH,
    ExpressionError,
    Name,
    Node,
    NumberNode,
    OperationNode,
    read,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.units import UNITS, CompoundUnit, UnitError, bounded_exponent, compound, named_unit

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


# The unit behind a number literal: `0.5 in`, `10 N*m`, `3 lbm*in/s^2`.
#
# Units stand only here. The word right after a number is a unit, with or without a space between.
# `*` or `/` and another unit word continue the unit only when no space surrounds the sign, so `2 N
# * m` is two newtons times a parameter m. `^` and a whole number right behind a unit word is its
# exponent.

_POWERS = ("^", "**")


class UnitReader:
    """Reads the unit whose first word is `tokens[position]`; `position` ends behind the unit."""

    def __init__(self, tokens: list[Token], position: int) -> None:
        self.tokens = tokens
        self.position = position
        self.number = tokens[position - 1].text[:MAX_QUOTED]
        self.terms: list[tuple[str, int]] = []
        self.joined: list[tuple[str, int]] = []

    def read(self) -> CompoundUnit:
        """The unit.

        Raises:
            ExpressionError: the word is no unit, or an exponent is not a whole number.
        """
        first = self.tokens[self.position]
        try:
            self._term(1)
            while self._continues():
                sign = -1 if self.tokens[self.position].text == "/" else 1
                self.position += 1
                word = self.tokens[self.position]
                self.joined.append((word.text, word.start))
                self._term(sign)
            self._end()
            return compound(self.terms)
        except UnitError as error:
            hint = error.hint or f"a product is written {self.number}*{first.text[:MAX_QUOTED]}"
            raise ExpressionError(error.message, max(error.offset, first.start), hint) from None

    def _term(self, sign: int) -> None:
        word = self.tokens[self.position]
        unit = named_unit(word.text, word.start)
        self.position += 1
        self.terms.append((unit.symbol, sign * self._exponent(word)))

    def _exponent(self, word: Token) -> int:
        caret = self.tokens[self.position]
        if caret.text not in _POWERS:
            return 1
        last = self.position + 1
        sign = 1
        if self.tokens[last].text == "-":
            sign, last = -1, last + 1
        number = self.tokens[last]
        together = number.end - word.end == sum(
            token.end - token.start for token in self.tokens[self.position : last + 1]
        )
        if not (together and number.kind == "number" and number.text.isdigit()):
            raise _ambiguous(caret)
        self.position = last + 1
        return sign * bounded_exponent(number.text, number.start)

    def _end(self) -> None:
        caret = self.tokens[self.position]
        if caret.text in _POWERS:
            raise _ambiguous(caret)

    def _continues(self) -> bool:
        before, sign = self.tokens[self.position - 1], self.tokens[self.position]
        if sign.text not in ("*", "/"):
            return False
        word = self.tokens[self.position + 1]
        if word.text not in UNITS or not before.end == sign.start == word.start - 1:
            return False
        return self.tokens[self.position + 2].text != "("


def _ambiguous(caret: Token) -> ExpressionError:
    return ExpressionError(
        "ambiguous power behind a unit",
        caret.start,
        "write the exponent of a unit as a whole number without spaces, 5 in^2, "
        "or the power of a value in parentheses, (5 in)^2",
    )


# Tokens to nodes: a precedence-climbing parser (Pratt 1973) with limits on size and depth.
#
# From weakest to strongest: `or`, `and`, `not`, comparisons, `+ -`, `* /`, sign, `^` (right to
# left; `**` is the same), then calls, `.x .y .z`, parentheses and `[a, b, c]`. So `-a^2` is
# `-(a^2)`, `2^-1` is one half and `not a < b and c < d` is `(not (a < b)) and (c < d)`.

_COMPARING = dict.fromkeys(COMPARED, 5)
_BINDING = {"or": 1, "and": 2, **_COMPARING, "+": 10, "-": 10, "*": 20, "/": 20, "^": 40, "**": 40}
_NOT_BINDING = 3
_CALLED = FUNCTIONS | FORMS
_SIGN_BINDING = 30
_COMPONENTS = (".x", ".y", ".z")


def parse_nodes(text: str) -> tuple[Node, ...]:
    """The nodes of an expression in postfix order.

    Raises:
        ExpressionError: the text is not an expression, or exceeds a limit.
    """
    parser = _Parser(tokenize(text))
    parser.expression(0)
    parser.finish()
    return tuple(parser.nodes)


class _Parser:
    def __init__(self, tokens: list[Token]) -> None:
        self.tokens = tokens
        self.position = 0
        self.depth = 0
        self.nodes: list[Node] = []

    @property
    def token(self) -> Token:
        return self.tokens[self.position]

    def take(self) -> Token:
        token = self.token
        self.position += 1
        return token

    def emit(self, node: Node) -> None:
        if len(self.nodes) >= MAX_NODES:
            raise ExpressionError(
                f"the expression has more than {MAX_NODES} numbers, names and operations",
                node.offset,
                "split it into parameters",
            )
        self.nodes.append(node)

    def expression(self, binding: int) -> None:
        """Read operands and operators that bind more strongly than `binding`."""
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise ExpressionError(
                f"the expression is nested more than {MAX_DEPTH} deep",
                self.token.start,
                "split it into parameters",
            )
        self.operand()
        while _BINDING.get(self.token.text, 0) > binding:
            operator = self.take()
            power = operator.text in ("^", "**")
            strength = _BINDING[operator.text]
            self.expression(strength - 1 if power else strength)
            self.emit(OperationNode("^" if power else operator.text, 2, operator.start))
            if operator.text in COMPARED and self.token.text in COMPARED:
                hint = "join two comparisons: a < b and b < c"
                raise ExpressionError("a comparison of a comparison", self.token.start, hint)
        self.depth -= 1

    def operand(self) -> None:
        token = self.take()
        if token.kind == "number":
            self.number(token)
        elif token.kind == "name":
            self.name(token)
        elif token.text in ("-", "+"):
            self.sign(token)
            return
        elif token.text == "not":
            self.expression(_NOT_BINDING)
            self.emit(OperationNode("not", 1, token.start))
            return
        elif token.text == "(":
            self.expression(0)
            self.expect(")", token)
        elif token.text == "[":
            self.vector(token)
        else:
            self.position -= 1
            raise self.misplaced("a number, a name or ( was expected")
        while self.token.kind == "component":
            self.component(self.take())

    def number(self, token: Token) -> None:
        value = float(token.text)
        if not math.isfinite(value):
            raise ExpressionError(
                f"the number {token.text[:MAX_QUOTED]} is too large",
                token.start,
                "the largest is about 1.8e308",
            )
        if vanishes(token.text, value):
            raise ExpressionError(
                f"the number {token.text[:MAX_QUOTED]} is too small",
                token.start,
                "it would be read as zero; the smallest is about 1e-308",
            )
        value = read(value, token.text)
        if self.token.kind == "name":
            reader = UnitReader(self.tokens, self.position)
            unit = reader.read()
            self.position = reader.position
            self.emit(NumberNode(value, unit, token.text, token.start, tuple(reader.joined)))
        else:
            self.emit(NumberNode(value, None, token.text, token.start))

    def name(self, token: Token) -> None:
        if self.token.text == "(":
            self.call(token)
        elif token.text == "pi":
            self.emit(NumberNode(read(math.pi, "pi"), None, "pi", token.start))
        elif token.text in _CALLED:
            raise ExpressionError(
                f"{token.text} is a function", token.start, f"write {token.text}(...)"
            )
        else:
            self.emit(Name(token.text, token.start))

    def sign(self, token: Token) -> None:
        first = len(self.nodes)
        self.expression(_SIGN_BINDING)
        if token.text == "+":
            return
        last = self.nodes[-1]
        if isinstance(last, NumberNode) and len(self.nodes) == first + 1:
            text = last.text.removeprefix("-") if last.text[0] == "-" else "-" + last.text
            self.nodes[-1] = last._replace(value=-last.value, text=text)
        else:
            self.emit(OperationNode("negate", 1, token.start))

    def vector(self, opening: Token) -> None:
        count = self.arguments("]", opening)
        if count not in (2, 3):
            raise ExpressionError(
                f"a vector has three components, in a plane two, not {count}",
                opening.start,
                "write [x, y, z], with plane: xy [x, y]",
            )
        self.emit(OperationNode("[]", count, opening.start))

    def call(self, name: Token) -> None:
        function = _CALLED.get(name.text)
        if function is None:
            raise ExpressionError(
                f"there is no function {name.text[:MAX_QUOTED]}",
                name.start,
                INSTEAD.get(name.text)
                or nearest_hint(name.text, _CALLED)
                or f"functions are {', '.join(_CALLED)}",
            )
        count = self.arguments(")", self.take())
        if not function.accepts(count):
            raise ExpressionError(
                f"{name.text} takes {function.arity_text}, not {count}",
                name.start,
                function.cure(count),
            )
        self.emit(OperationNode(name.text, count, name.start))

    def arguments(self, closing: str, opening: Token) -> int:
        """Read expressions up to the closing bracket; their number."""
        if self.token.text == closing:
            self.take()
            return 0
        count = 1
        self.expression(0)
        while self.token.text == ",":
            self.take()
            self.expression(0)
            count += 1
        self.expect(closing, opening)
        return count

    def component(self, token: Token) -> None:
        if token.text not in _COMPONENTS:
            raise ExpressionError(
                f"there is no component {token.text[:MAX_QUOTED]}",
                token.start,
                "components are .x, .y and .z",
            )
        self.emit(OperationNode(token.text, 1, token.start))

    def expect(self, closing: str, opening: Token) -> None:
        if self.token.text == closing:
            self.take()
        elif self.token.kind == "end":
            raise ExpressionError(
                f"'{opening.text}' is not closed", opening.start, f"add '{closing}'"
            )
        else:
            raise self.misplaced(f"an operator or '{closing}' was expected")

    def finish(self) -> None:
        if self.token.kind != "end":
            raise self.misplaced("an operator was expected")

    def misplaced(self, expected: str) -> ExpressionError:
        token = self.token
        if len(self.tokens) == 1:
            return ExpressionError("the expression is empty", 0, "write a number")
        if token.kind == "end":
            return ExpressionError(f"the expression ends where {expected}", token.start)
        hints = {",": "a decimal point is written as a dot", ")": "there is no ( before it"}
        hint = hints.get(token.text)
        if token.kind in ("number", "name") or token.text in ("(", "["):
            hint = "multiplication is written with *"
        quoted = token.text[:MAX_QUOTED]
        return ExpressionError(f"'{quoted}' stands where {expected}", token.start, hint)
