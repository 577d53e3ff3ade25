"""Scalars of a file: a bare number takes the field's unit, anything else is an expression.

Dimensions are not checked: the oracle reads files that are right.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable

from oracle.numerics import Number, mp
from oracle.units import WORDS, Units

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_WORD = r"(?:" + "|".join(sorted(WORDS, key=len, reverse=True)) + r")(?![A-Za-z0-9_])(?:\^-?\d+)?"
_BARE = re.compile(rf"\s*[+-]?{_NUMBER}\s*")
_LITERAL = re.compile(rf"(?<![A-Za-z0-9_.])({_NUMBER})(?:\s*({_WORD}(?:[*/]{_WORD})*))?")

_OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}
_FUNCTIONS = {
    "sin": mp.sin,
    "cos": mp.cos,
    "tan": mp.tan,
    "asin": mp.asin,
    "acos": mp.acos,
    "atan": mp.atan,
    "atan2": mp.atan2,
    "sqrt": mp.sqrt,
    "abs": abs,
    "sign": mp.sign,
    "max": max,
    "min": min,
    "exp": mp.exp,
    "log": mp.log,
}


Quantities = Callable[[str], Number]
"""The value of a dotted name, such as `O1.theta_dot` or `p.position.x`."""


def no_quantities(name: str) -> Number:
    raise ValueError(f"there is no quantity {name} here")


def is_bare(text: str) -> bool:
    """Whether a scalar is only a number."""
    return _BARE.fullmatch(text) is not None


class Scope:
    """The parameters of a file, evaluated when asked for, in the base of its units."""

    def __init__(self, units: Units, parameters: dict[str, str]) -> None:
        self.units = units
        self._texts = parameters
        self._values: dict[str, Number] = {}

    def scalar(self, text: str, kind: str) -> Number:
        """The value of a scalar in the base; `kind` as in `Units.of`."""
        if is_bare(text):
            return mp.mpf(text.strip()) * self.units.of(kind)
        return self._evaluate(text)

    def law(self, text: str, kind: str) -> Number | Callable[[Quantities], Number]:
        """The value of a scalar, or where it names quantities a function of these."""
        if is_bare(text) or not re.search(r"[A-Za-z_]\w*\.[A-Za-z_]", text):
            return self.scalar(text, kind)
        return lambda quantities: self._evaluate(text, quantities)

    def vector(self, texts: list[str], kind: str) -> list[Number]:
        return [self.scalar(text, kind) for text in texts]

    def _parameter(self, name: str) -> Number:
        if name not in self._values:
            self._values[name] = self.scalar(self._texts[name], "number")
        return self._values[name]

    def _evaluate(self, text: str, quantities: Quantities = no_quantities) -> Number:
        literals: list[Number] = []

        def keep(match: re.Match[str]) -> str:
            unit = self.units.value(match[2]) if match[2] else mp.one
            literals.append(mp.mpf(match[1]) * unit)
            return f"(LITERALS[{len(literals) - 1}])"

        python = _LITERAL.sub(keep, text).replace("^", "**")
        return self._node(ast.parse(python.strip(), mode="eval").body, literals, quantities)

    def _node(self, node: ast.expr, literals: list[Number], quantities: Quantities) -> Number:
        def value(inner: ast.expr) -> Number:
            return self._node(inner, literals, quantities)

        match node:
            case ast.Subscript(slice=ast.Constant(value=index)):
                return literals[index]
            case ast.Name(id="pi"):
                return +mp.pi
            case ast.Name(id=name):
                return self._parameter(name)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -value(operand)
            case ast.BinOp(left=left, op=op, right=right):
                return _OPERATORS[type(op)](value(left), value(right))
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return _FUNCTIONS[name](*map(value, arguments))
            case ast.Attribute():
                return quantities(ast.unparse(node))
        raise ValueError(f"not an expression of the oracle: {ast.dump(node)}")
