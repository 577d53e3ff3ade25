"""Tokens to nodes: a precedence-climbing parser (Pratt 1973) with limits on size and depth.

From weakest to strongest: `or`, `and`, `not`, comparisons, `+ -`, `* /`, sign, `^` (right to left;
`**` is the same), then calls, `.x .y .z`, parentheses and `[a, b, c]`. So `-a^2` is `-(a^2)`,
`2^-1` is one half and `not a < b and c < d` is `(not (a < b)) and (c < d)`.
"""

from __future__ import annotations

import math

from mechkin_cli.expressions.conditions import COMPARED
from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.functions import FORMS, FUNCTIONS, INSTEAD
from mechkin_cli.expressions.limits import MAX_DEPTH, MAX_NODES, MAX_QUOTED
from mechkin_cli.expressions.nodes import Name, Node, Number, Operation
from mechkin_cli.expressions.number_unit import UnitReader
from mechkin_cli.expressions.tokens import Token, tokenize, vanishes
from mechkin_cli.expressions.written import read
from mechkin_cli.nearest import nearest_hint

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
            self.emit(Operation("^" if power else operator.text, 2, operator.start))
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
            self.emit(Operation("not", 1, token.start))
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
            self.emit(Number(value, unit, token.text, token.start, tuple(reader.joined)))
        else:
            self.emit(Number(value, None, token.text, token.start))

    def name(self, token: Token) -> None:
        if self.token.text == "(":
            self.call(token)
        elif token.text == "pi":
            self.emit(Number(read(math.pi, "pi"), None, "pi", token.start))
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
        if isinstance(last, Number) and len(self.nodes) == first + 1:
            text = last.text.removeprefix("-") if last.text[0] == "-" else "-" + last.text
            self.nodes[-1] = last._replace(value=-last.value, text=text)
        else:
            self.emit(Operation("negate", 1, token.start))

    def vector(self, opening: Token) -> None:
        count = self.arguments("]", opening)
        if count not in (2, 3):
            raise ExpressionError(
                f"a vector has three components, in a plane two, not {count}",
                opening.start,
                "write [x, y, z], with plane: xy [x, y]",
            )
        self.emit(Operation("[]", count, opening.start))

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
        self.emit(Operation(name.text, count, name.start))

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
        self.emit(Operation(token.text, 1, token.start))

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
