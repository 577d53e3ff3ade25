"""Values that vary with time and motion, as functions of floats in the base of the file's units."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable
from typing import Any

from oracle.expressions import _LITERAL, Scope, is_bare

Quantity = Callable[[str], float]
"""The value of `time` or of a dotted name."""
Law = Callable[[Quantity], float]

_VARIES = re.compile(r"[A-Za-z_]\w*\.[A-Za-z_]|(?<![\w.])time(?!\w)")
_FUNCTIONS: dict[str, Any] = {
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "asin", "acos", "atan")},
    **{name: getattr(math, name) for name in ("atan2", "sqrt", "exp", "log")},
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: math.copysign(1.0, x) if x else 0.0,
    "wrap": lambda x: math.remainder(x, 2 * math.pi),
}


def law(scope: Scope, text: str, kind: str) -> Law:
    """A scalar's function; bare numbers take the unit of the kind."""
    if is_bare(text) or not _VARIES.search(text):
        constant = float(scope.scalar(text, kind))
        return lambda quantity: constant
    code = compile(
        ast.fix_missing_locations(_Names(scope).visit(_parsed(scope, text))), text, "eval"
    )
    return lambda quantity: float(eval(code, {"__builtins__": {}, **_FUNCTIONS, "Q": quantity}))


def _parsed(scope: Scope, text: str) -> ast.Expression:
    def literal(match: re.Match[str]) -> str:
        unit = float(scope.units.value(match[2])) if match[2] else 1.0
        return f"({float(match[1]) * unit!r})"

    return ast.parse(_LITERAL.sub(literal, text).replace("^", "**").strip(), mode="eval")


class _Names(ast.NodeTransformer):
    """Parameters become numbers, quantities calls of Q."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope

    def visit_Call(self, node: ast.Call) -> ast.AST:
        node.args = [self.visit(argument) for argument in node.args]
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        return _call(ast.unparse(node))

    def visit_Name(self, node: ast.Name) -> ast.AST:
        if node.id == "time":
            return _call("time")
        value = math.pi if node.id == "pi" else float(self.scope._parameter(node.id))
        return ast.Constant(value)


def _call(name: str) -> ast.Call:
    return ast.Call(ast.Name("Q", ast.Load()), [ast.Constant(name)], [])
