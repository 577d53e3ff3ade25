"""The derivative of an expression as an expression: the chain rule, operation by operation.

Nothing is differenced: the result is evaluated as any other expression, with its dimensions checked
and in whatever arithmetic it is asked for. Steps (sign, floor, comparisons) are taken for
constants; of min, max, clip and `if` it is the derivative of what is chosen. There is none where
the expression has no value.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache, reduce
from operator import add
from typing import Any

import numpy as np

from mechkin_cli.expressions import (
    jets,
    jets as slopes,
    operations as conditions,
    operations as scalar_functions,
    operations as steps,
    operations as truths,
)
from mechkin_cli.expressions.expression import Expression, refuse_large
from mechkin_cli.expressions.grammar import parse_nodes
from mechkin_cli.expressions.jets import Jet
from mechkin_cli.expressions.quantity import (
    Name,
    Node,
    NumberNode,
    OperationNode,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.show import Floats
from mechkin_cli.units import conversion

# Derivatives of an expression whose names move: the chain rule, node by node, up to third order.
#
# Each operation and function of expressions has its rule for jets here. Where a derivative does not
# exist (abs and sign at zero, min and max of two that cross, a comparison
# of equals, a step of floor, sqrt at zero) it is nan or infinite.

JetVector = tuple[Jet, ...]


def derivatives(expression: Expression, names: Mapping[str, Jet]) -> Jet:
    """Value and first three derivatives of a scalar expression, in SI, shape (4, rows or 1).

    Args:
        expression: one that `Expression.evaluate` accepts with the same names as scalars.
        names: every name's own value and derivatives.
    """
    stack: list[Any] = []
    with np.errstate(all="ignore"):
        for node in expression.nodes:
            if isinstance(node, OperationNode):
                operands = stack[-node.arity :]
                del stack[-node.arity :]
                stack.append(RULES[node.symbol](*operands))
            elif isinstance(node, NumberNode):
                stack.append(jets.constant_jet(_in_si(node)))
            else:
                stack.append(names[node.text])
    jet: Jet = stack[-1]
    return jet


def _in_si(number: NumberNode) -> float:
    if number.unit is None:
        return number.value
    return conversion(number.unit.factor).apply(number.value)


def _on_each(rule: Callable[[Jet, Jet], Jet]) -> Callable[[Any, Any], Any]:
    """The rule for two numbers, for two vectors component by component, or for one of each."""

    def apply(a: Any, b: Any) -> Any:
        if not isinstance(a, tuple) and not isinstance(b, tuple):
            return rule(a, b)
        count = len(a if isinstance(a, tuple) else b)
        left, right = (each if isinstance(each, tuple) else (each,) * count for each in (a, b))
        return tuple(rule(p, q) for p, q in zip(left, right, strict=True))

    return apply


def _negative(a: Any) -> Any:
    return tuple(-each for each in a) if isinstance(a, tuple) else -a


def _through(outer: Callable[[Floats], tuple[Floats, ...]]) -> Callable[[Jet], Jet]:
    return lambda inner: jets.of(outer(inner[0]), inner)


def _angle_of(y: Jet, x: Jet) -> Jet:
    """atan2(y, x): its rate is (x y' - y x') / (x^2 + y^2), whose jet has one order less."""
    turning = jets.product(x, _rate(y)) - jets.product(y, _rate(x))
    rate = jets.quotient(turning, jets.product(x, x) + jets.product(y, y))
    value = scalar_functions.angle_of(*np.broadcast_arrays(y[0], x[0]))
    still = (turning == 0.0).all(axis=0)
    return np.stack(np.broadcast_arrays(value, *np.where(still, 0.0, rate[:3])))


def _rate(jet: Jet) -> Jet:
    """The derivative's jet; its last order is not known and stands as zero."""
    return np.concatenate([jet[1:], np.zeros_like(jet[:1])])


def _power(base: Jet, exponent: Jet) -> Jet:
    if not jets.is_constant(exponent):
        value = scalar_functions.power(*np.broadcast_arrays(base[0], exponent[0]))
        by_logarithm = jets.product(exponent, jets.of(slopes.log(base[0]), base))
        return jets.of((value,) * jets.ORDERS, by_logarithm)  # type: ignore[arg-type]
    x, n = np.broadcast_arrays(base[0], exponent[0])
    orders, factor = [], np.ones_like(x)
    for order in range(jets.ORDERS):
        power = x * x if order == 0 and (n == 2.0).all() else scalar_functions.power(x, n - order)
        orders.append(np.where(factor == 0.0, 0.0, factor * power))
        factor = factor * (n - order)
    return jets.of(orders, base)


def _absolute(a: Jet) -> Jet:
    corner = (a[0] == 0.0) & (a[1:] != 0.0).any(axis=0)
    jet = jets.chosen(a[0] < 0.0, -a, a)
    return np.concatenate([np.abs(a[:1]), np.where(corner, np.nan, jet[1:])])


def _sign(a: Jet) -> Jet:
    """A step where the argument passes zero, else a constant."""
    jump = (a[0] == 0.0) & (a[1:] != 0.0).any(axis=0)
    still = np.where(jump, np.nan, np.zeros_like(a[1:]))
    return np.concatenate([np.atleast_2d(scalar_functions.sign(a[0])), still])


def _extreme(sign: float) -> Callable[..., Jet]:
    """max for sign 1, min for -1; a corner where two are equal and do not move alike."""

    def one(a: Jet, b: Jet) -> Jet:
        a, b = np.broadcast_arrays(a, b)
        corner = (a[0] == b[0]) & (a[1:] != b[1:]).any(axis=0)
        jet = jets.chosen(sign * b[0] > sign * a[0], b, a)
        return np.concatenate([jet[:1], np.where(corner, np.nan, jet[1:])])

    return lambda *operands: reduce(one, operands)


def _compared(symbol: str) -> Callable[[Jet, Jet], Jet]:
    """A step where a difference passes zero, else a constant."""
    truth = conditions.COMPARED[symbol]

    def apply(a: Jet, b: Jet) -> Jet:
        step = _sign(a - b)
        values = np.broadcast_to(truth(*np.broadcast_arrays(a[0], b[0])), step[:1].shape)
        return np.concatenate([values, step[1:]])

    return apply


def _joined(truth: Callable[[Any, Any], Any]) -> Callable[[Jet, Jet], Jet]:
    """A step where the truth of one that decides steps, else a constant."""

    def apply(a: Jet, b: Jet) -> Jet:
        a, b = np.broadcast_arrays(a, b)
        value = truth(a[0], b[0])
        # 0 of `and`, 1 of `or`: what one condition alone decides
        alone = truth(np.zeros(1), np.ones(1))
        decided = [
            (each == alone) & ~np.isnan(jet).any(axis=0) for each, jet in ((a[0], a), (b[0], b))
        ]
        rates = np.where(decided[0] | decided[1], 0.0, a[1:] + b[1:])
        return np.concatenate([value[None], rates])

    return apply


def _if(truth: Jet, a: Any, b: Any) -> Any:
    """The chosen one; where the choice jumps nothing has a derivative."""

    def of_numbers(one: Jet, other: Jet) -> Jet:
        found = np.where(truth[0] == 0.0, other, one)
        return np.where(np.isnan(truth).any(axis=0), np.nan, found)

    return _on_each(of_numbers)(a, b)


def _staircase(
    value: Callable[[Any], Any], nearest_step: Callable[[Any], Any]
) -> Callable[[Jet], Jet]:
    """Constant between its steps; `nearest_step` is zero on one."""

    def apply(a: Jet) -> Jet:
        jump = (nearest_step(a[0]) == 0.0) & (a[1:] != 0.0).any(axis=0)
        still = np.where(jump, np.nan, np.zeros_like(a[1:]))
        return np.concatenate([np.atleast_2d(value(a[0])), still])

    return apply


_floor = _staircase(steps.below, lambda x: x - steps.nearest(x))


def _mod(a: Jet, period: Jet) -> Jet:
    return a - jets.product(period, _floor(jets.quotient(a, period)))


def _hypot(*sides: Jet) -> Jet:
    square = reduce(lambda a, b: a + b, (jets.product(side, side) for side in sides))
    return jets.of(slopes.sqrt(square[0]), square)


def _norm(a: JetVector) -> Jet:
    return _hypot(*a)


def _wrap(a: Jet) -> Jet:
    return np.concatenate([np.atleast_2d(scalar_functions.wrap(a[0])), a[1:]])


def _dot(a: JetVector, b: JetVector) -> Jet:
    return reduce(add, (jets.product(p, q) for p, q in zip(a, b, strict=True)))


def _cross(a: JetVector, b: JetVector) -> Any:
    def minor(i: int, j: int) -> Jet:
        return jets.product(a[i], b[j]) - jets.product(a[j], b[i])

    return minor(0, 1) if len(a) == 2 else (minor(1, 2), minor(2, 0), minor(0, 1))


def _size(normal: Any) -> Jet:
    """Of a vector product, which in a plane is one number."""
    return _norm(normal) if isinstance(normal, tuple) else _absolute(normal)


def _zero_of(a: JetVector) -> Jet:
    """Zero, and no number in rows where a vector has no direction."""
    return jets.quotient(jets.constant_jet(0.0), _dot(a, a))


RULES: dict[str, Callable[..., Any]] = {
    "+": _on_each(lambda a, b: a + b),
    "-": _on_each(lambda a, b: a - b),
    "*": _on_each(jets.product),
    "/": _on_each(jets.quotient),
    "^": _power,
    "negate": _negative,
    "[]": lambda *components: components,
    ".x": lambda a: a[0],
    ".y": lambda a: a[1],
    ".z": lambda a: a[2],
    "sin": _through(slopes.sin),
    "cos": _through(slopes.cos),
    "tan": _through(slopes.tan),
    "asin": _through(slopes.asin),
    "acos": _through(slopes.acos),
    "atan": _through(slopes.atan),
    "atan2": _angle_of,
    "sqrt": _through(slopes.sqrt),
    "exp": _through(slopes.exp),
    "log": _through(slopes.log),
    "pow": _power,
    "abs": _absolute,
    "sign": _sign,
    "min": _extreme(-1.0),
    "max": _extreme(1.0),
    "wrap": _wrap,
    "dot": _dot,
    "cross": _cross,
    "det": lambda a, b, c: _dot(a, _cross(b, c)),
    "norm": _norm,
    "unit_vector": lambda a: _on_each(jets.quotient)(a, _norm(a)),
    "angle_between": lambda a, b: (
        _angle_of(_size(_cross(a, b)), _dot(a, b)) + (_zero_of(a) + _zero_of(b))
    ),
    **{symbol: _compared(symbol) for symbol in conditions.COMPARED},
    "and": _joined(truths.both),
    "or": _joined(truths.either),
    "not": lambda a: jets.constant_jet(1.0) - a,
    "if": _if,
    "clip": lambda a, least, most: _extreme(-1.0)(_extreme(1.0)(a, least), most),
    "hypot": _hypot,
    "floor": _floor,
    "ceil": _staircase(steps.above, lambda x: x - steps.nearest(x)),
    "round": _staircase(steps.nearest, lambda x: x - steps.below(x) - 0.5),
    "mod": _mod,
    "sinh": _through(slopes.sinh),
    "cosh": _through(slopes.cosh),
    "tanh": _through(slopes.tanh),
    "asinh": _through(slopes.asinh),
    "acosh": _through(slopes.acosh),
    "atanh": _through(slopes.atanh),
}
"""Every operation's rule for jets; a vector is a tuple of jets."""


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
        elif isinstance(node, NumberNode):
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


def _operated(node: OperationNode, operands: list[_Moving], unit: str, offset: int) -> _Moving:
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
        total = (*total, *found_term, OperationNode("+", 2, offset)) if total else found_term
    return _Moving(value, total)


def _terms_of(node: OperationNode, operands: list[_Moving]) -> Sequence[str]:
    """The terms of an operation; of a power that is written, with the exponent below it."""
    exponent = operands[-1].value[-1]
    if node.symbol in ("^", "pow") and isinstance(exponent, NumberNode) and exponent.unit is None:
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
