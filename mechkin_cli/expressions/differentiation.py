"""The derivative of an expression as an expression: the chain rule, operation by operation.

Nothing is differenced: the result is evaluated as any other expression, with its dimensions checked
and in whatever arithmetic it is asked for. Steps (sign, floor, comparisons) are taken for
constants; of min, max, clip and `if` it is the derivative of what is chosen. There is none where
the expression has no value.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from mechkin_cli.expressions.errors import ExpressionError
from mechkin_cli.expressions.limits import MAX_EXPANDED
from mechkin_cli.expressions.nodes import Name, Node, Number, Operation
from mechkin_cli.expressions.parser import parse_nodes

Nodes = tuple[Node, ...]
Rate = Callable[[Name], Nodes | None]
"""The derivative of what a name stands for; None where it does not move."""


class _Moving(NamedTuple):
    """A part of an expression and its derivative, None where it does not move."""

    value: Nodes
    rate: Nodes | None


TERMS: dict[str, tuple[str, ...]] = {
    "+": ("d", "d"),
    "-": ("d", "-d"),
    "*": ("d*b", "a*d"),
    "/": ("d/b", "-a*d/(b*b)"),
    "negate": ("-d",),
    ".x": ("(d).x",),
    ".y": ("(d).y",),
    ".z": ("(d).z",),
    "sin": ("cos(a)*d/(1 rad)",),
    "cos": ("-sin(a)*d/(1 rad)",),
    "tan": ("(1 + tan(a)^2)*d/(1 rad)",),
    "asin": ("d/sqrt((1 - a)*(1 + a))*(1 rad)",),
    "acos": ("-d/sqrt((1 - a)*(1 + a))*(1 rad)",),
    "atan": ("d/(1 + a*a)*(1 rad)",),
    "atan2": ("b*d/(a*a + b*b)*(1 rad)", "-a*d/(a*a + b*b)*(1 rad)"),
    "sqrt": ("d/(2*sqrt(a))",),
    "exp": ("exp(a)*d",),
    "log": ("d/a",),
    "sinh": ("cosh(a)*d",),
    "cosh": ("sinh(a)*d",),
    "tanh": ("d/(cosh(a)*cosh(a))",),
    "asinh": ("d/sqrt(a*a + 1)",),
    "acosh": ("d/sqrt((a - 1)*(a + 1))",),
    "atanh": ("d/((1 - a)*(1 + a))",),
    "^": ("b*pow(a, b - 1)*d", "pow(a, b)*log(a)*d"),
    "pow": ("b*pow(a, b - 1)*d", "pow(a, b)*log(a)*d"),
    "abs": ("sign(a)*d",),
    "wrap": ("d",),
    "mod": ("d", "-floor(a/b)*d"),
    "hypot": ("a*d/hypot(a, b)", "b*d/hypot(a, b)"),
    "dot": ("dot(d, b)", "dot(a, d)"),
    "cross": ("cross(d, b)", "cross(a, d)"),
    "det": ("det(d, b, c)", "det(a, d, c)", "det(a, b, d)"),
    "norm": ("dot(a, d)/norm(a)",),
    "unit_vector": ("(d - dot(a, d)/dot(a, a)*a)/norm(a)",),
}
"""What the derivative d of each operand a, b, c adds to an operation's."""

WHOLE = {
    "[]": "[da, db, dc]",
    "if": "if(a, db, dc)",
    "min": "if(b < a, db, da)",
    "max": "if(b > a, db, da)",
    "clip": "if(c < max(a, b), dc, if(b > a, db, da))",
    "angle_between": (
        "(dot(a, b)*dot(cross(a, b), cross(da, b) + cross(a, db))/norm(cross(a, b)) "
        "- norm(cross(a, b))*(dot(da, b) + dot(a, db)))/(dot(a, a)*dot(b, b))*(1 rad)"
    ),
}
"""Derivatives that need those of all operands, which stand as da, db, dc."""

STEPS = {"sign", "floor", "ceil", "round", "<", "<=", ">", ">=", "==", "!=", "and", "or", "not"}
"""Operations that are taken for constants."""

_FOLDED = {"min", "max", "hypot"}
"""Operations of two operands or more: of the first two, then of that and the next."""


def differentiated(nodes: Sequence[Node], rate: Rate, unit: str, offset: int) -> Nodes:
    """The nodes of the derivative by a quantity.

    Args:
        nodes: of the expression, in postfix order, without a derivative in it.
        rate: the derivatives of names.
        unit: of the quantity, `rad` or `m`.
        offset: where the result's operations are taken to stand.

    Raises:
        ExpressionError: from `rate`, or the result exceeds a limit.
    """
    stack: list[_Moving] = []
    for node in nodes:
        if isinstance(node, Name):
            stack.append(_Moving((node,), rate(node)))
        elif isinstance(node, Number):
            stack.append(_Moving((node,), None))
        else:
            operands = stack[-node.arity :]
            del stack[-node.arity :]
            stack.append(_operated(node, operands, unit, offset))
        refuse_large(len(stack[-1].value) + len(stack[-1].rate or ()), offset)
    value, found = stack[-1].value, _rate_of(stack[-1], unit, offset)
    if stack[-1].rate is None:
        return found
    # log(x) has none where x < 0, though 1/x has a value, and so for what does not move
    return _filled(f"d + 0*a/(1 {unit})", {"a": value, "d": found}, offset)


def refuse_large(size: int, offset: int) -> None:
    """Refuses an expression that has grown too large.

    Raises:
        ExpressionError: it has more nodes than the limit.
    """
    if size > MAX_EXPANDED:
        text = f"with the quantities in it the expression has more than {MAX_EXPANDED} parts"
        raise ExpressionError(text, offset, "use fewer of them in one another")


def _operated(node: Operation, operands: list[_Moving], unit: str, offset: int) -> _Moving:
    if node.symbol in _FOLDED and node.arity > 2:
        pair = node._replace(arity=2)
        found = operands[0]
        for operand in operands[1:]:
            found = _operated(pair, [found, operand], unit, offset)
        return found
    value = (*(n for operand in operands for n in operand.value), node)
    if node.symbol in STEPS or all(operand.rate is None for operand in operands):
        return _Moving(value, None)
    names = dict(zip("abc", (operand.value for operand in operands), strict=False))
    if node.symbol in WHOLE:
        rates = [_rate_of(operand, unit, offset) for operand in operands]
        names |= dict(zip(("da", "db", "dc"), rates, strict=False))
        return _Moving(value, _filled(WHOLE[node.symbol], names, offset))
    total: Nodes = ()
    for operand, term in zip(operands, _terms_of(node, operands), strict=True):
        if operand.rate is None:
            continue
        found_term = _filled(term, {**names, "d": operand.rate}, offset)
        total = (*total, *found_term, Operation("+", 2, offset)) if total else found_term
    return _Moving(value, total)


def _terms_of(node: Operation, operands: list[_Moving]) -> Sequence[str]:
    """The terms of an operation; of a power that is written, with the exponent below it."""
    exponent = operands[-1].value[-1]
    if node.symbol in ("^", "pow") and isinstance(exponent, Number) and exponent.unit is None:
        return (f"b*a^{float(exponent.value) - 1.0!r}*d", "d")
    return TERMS[node.symbol]


def _rate_of(part: _Moving, unit: str, offset: int) -> Nodes:
    """The derivative, zero in its dimension where the part does not move."""
    if part.rate is not None:
        return part.rate
    return _filled(f"0*a/(1 {unit})", {"a": part.value}, offset)


@cache
def _template(text: str) -> Nodes:
    return parse_nodes(text)


def _filled(text: str, parts: Mapping[str, Nodes], offset: int) -> Nodes:
    """A rule with parts of the expression in the places of its names."""
    found: list[Node] = []
    for node in _template(text):
        if isinstance(node, Name):
            found += parts[node.text]
        else:
            found.append(node._replace(offset=offset))
    return tuple(found)
