"""From the text of an expression to its nodes: tokens, then a precedence-climbing parser.

From weakest to strongest: `or`, `and`, `not`, comparisons, `+ -`, `* /`, sign, `^` (right to left;
`**` is the same), then calls, `.x .y .z`, parentheses and `[a, b, c]`. So `-a^2` is `-(a^2)`,
`2^-1` is one half and `not a < b and c < d` is `(not (a < b)) and (c < d)`. Source: V. Pratt, Top
down operator precedence, 1973; size and depth are limited.

Units stand only behind numbers: `0.5 in`, `10 N*m`, `3 lbm*in/s^2`. The word right after a number
is a unit, with or without a space between. `*` or `/` and another unit word continue the unit only
when no space surrounds the sign, so `2 N * m` is two newtons times a parameter m. `^` and a whole
number right behind a unit word is its exponent.
"""

from __future__ import annotations

import math
import re

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

_SPACE = " \t\r\n"
_TOKEN = re.compile(
    r"""
  ( (?P<number>    (?: [0-9]+ \.? [0-9]* | \. [0-9]+ ) (?: [eE] [+-]? [0-9]+ )? )
  | (?P<word>      (?: and | or | not ) (?! [A-Za-z0-9_.] ) )
  | (?P<name>      [A-Za-z_][A-Za-z0-9_]* (?: \. [A-Za-z_][A-Za-z0-9_]* )* )
  | (?P<component> \. [A-Za-z_][A-Za-z0-9_]* )
  | (?P<symbol>    \*\* | [<>=!]= | [-+*/^()\[\],<>] ) ) [ \t\r\n]*
    """,
    re.VERBOSE,
)

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
"""Message and hint for a number that a change of unit makes zero."""


def vanishes(text: str, value: float) -> bool:
    """Whether the number of a text is not zero although its double is."""
    return value == 0.0 and any(digit in "123456789" for digit in text.lower().partition("e")[0])


class Token(NamedTuple):
    """A piece of text from `start` to `end` (exclusive), both counted from the text's start; `kind`
    is number, name, component, word, symbol or end."""

    kind: str
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
    position = len(text) - len(text.lstrip(_SPACE))
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            character = text[position]
            shown = character if character.isprintable() else f"U+{ord(character):04X}"
            hint = "an expression has numbers, names, + - * / ^ ( ) [ ], comparisons and commas"
            raise ExpressionError(
                f"unexpected character '{shown}'", position, _INSTEAD.get(character, hint)
            )
        kind = next(kind for kind, piece in match.groupdict().items() if piece is not None)
        tokens.append(Token(kind, match[1], match.start(), match.end(1)))
        position = match.end()
    tokens.append(Token("end", "", len(text), len(text)))
    return tokens


_COMPARING = dict.fromkeys(COMPARED, 5)
_BINDING = {"or": 1, "and": 2, **_COMPARING, "+": 10, "-": 10, "*": 20, "/": 20, "^": 40, "**": 40}
_NOT_BINDING = 3
_SIGN_BINDING = 30
_POWERS = ("^", "**")
_CALLED = FUNCTIONS | FORMS
_COMPONENTS = (".x", ".y", ".z")
_ONE_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)*")
_NO_NAMES = {"and", "or", "not", "pi", *_CALLED}


def parse_nodes(text: str) -> tuple[Node, ...]:
    """The nodes of an expression in postfix order.

    Raises:
        ExpressionError: the text is not an expression, or exceeds a limit.
    """
    if _ONE_NAME.fullmatch(text) and text not in _NO_NAMES and len(text) <= MAX_TEXT_LENGTH:
        return (Name(text, 0),)  # as most columns are
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
            power = operator.text in _POWERS
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
            unit, joined = self.unit(token.text[:MAX_QUOTED])
            self.emit(NumberNode(value, unit, token.text, token.start, joined))
        else:
            self.emit(NumberNode(value, None, token.text, token.start))

    def unit(self, number: str) -> tuple[CompoundUnit, tuple[tuple[str, int], ...]]:
        """Read the unit behind a number; also the words joined to its first, with offsets."""
        first = self.token
        joined = []
        try:
            terms = [self.unit_term(1)]
            while self.unit_continues():
                sign = -1 if self.take().text == "/" else 1
                joined.append((self.token.text, self.token.start))
                terms.append(self.unit_term(sign))
            if self.token.text in _POWERS:
                raise _ambiguous_power(self.token)
            return compound(terms), tuple(joined)
        except UnitError as error:
            hint = error.hint or f"a product is written {number}*{first.text[:MAX_QUOTED]}"
            raise ExpressionError(error.message, max(error.offset, first.start), hint) from None

    def unit_term(self, sign: int) -> tuple[str, int]:
        word = self.take()
        unit = named_unit(word.text, word.start)
        caret = self.token
        if caret.text not in _POWERS:
            return unit.symbol, sign
        last = self.position + 1
        if self.tokens[last].text == "-":
            sign, last = -sign, last + 1
        number = self.tokens[last]
        together = number.end - word.end == sum(
            token.end - token.start for token in self.tokens[self.position : last + 1]
        )
        if not (together and number.kind == "number" and number.text.isdigit()):
            raise _ambiguous_power(caret)
        self.position = last + 1
        return unit.symbol, sign * bounded_exponent(number.text, number.start)

    def unit_continues(self) -> bool:
        before, sign = self.tokens[self.position - 1], self.token
        if sign.text not in ("*", "/"):
            return False
        word = self.tokens[self.position + 1]
        if word.text not in UNITS or not before.end == sign.start == word.start - 1:
            return False
        return self.tokens[self.position + 2].text != "("

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
        if token.kind == "number":
            hint = "multiplication is written with *, and a comma separates entries of a list"
        quoted = token.text[:MAX_QUOTED]
        return ExpressionError(f"'{quoted}' stands where {expected}", token.start, hint)


def _ambiguous_power(caret: Token) -> ExpressionError:
    return ExpressionError(
        "ambiguous power behind a unit",
        caret.start,
        "write the exponent of a unit as a whole number without spaces, 5 in^2, "
        "or the power of a value in parentheses, (5 in)^2",
    )
