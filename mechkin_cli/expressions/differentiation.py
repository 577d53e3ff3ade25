"""Derivatives of expressions by the chain rule, operation by operation: as numbers and as nodes.

`derivatives` evaluates an expression whose names move, up to third order, with jets: a jet is an
array of shape (4, rows), or (4, 1) for a constant, of a value and its first three derivatives over
a parameter. Sums, products (Leibniz), quotients and functions of jets (Faa di Bruno) are exact:
nothing is differenced. Source: A. Griewank and A. Walther, Evaluating Derivatives, chapter 13.
Where a derivative does not exist (abs and sign at zero, min and max of two that cross, a comparison
of equals, a step of floor, sqrt at zero) it is nan or infinite.

`differentiated` gives the derivative as an expression, which is evaluated as any other one, with
its dimensions checked and in any arithmetic. Steps (sign, floor, comparisons) are taken for
constants; of min, max, clip and `if` it is the derivative of the chosen one. It has no value where
the expression has none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache, reduce
from itertools import chain
from operator import add
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.expressions import operations
from mechkin_cli.expressions.expression import Expression, stays_in_pi
from mechkin_cli.expressions.grammar import parse_nodes
from mechkin_cli.expressions.quantity import (
    ExpressionError,
    Name,
    Node,
    NumberNode,
    OperationNode,
    Resolve,
    refuse_large,
)
from mechkin_cli.record import NamedTuple
from mechkin_cli.show import Floats
from mechkin_cli.tape import SLOPES
from mechkin_cli.units import conversion

Jet = NDArray[np.float64]

JET_ORDERS = 4
"""The value and three derivatives."""


def constant_jet(value: float) -> Jet:
    """A number that does not move."""
    jet = np.zeros((JET_ORDERS, 1))
    jet[0] = value
    return jet


def product(a: Jet, b: Jet) -> Jet:
    """a b."""
    return _stacked(
        [
            a[0] * b[0],
            a[1] * b[0] + a[0] * b[1],
            (a[2] * b[0] + a[0] * b[2]) + 2.0 * (a[1] * b[1]),
            (a[3] * b[0] + a[0] * b[3]) + 3.0 * (a[2] * b[1] + a[1] * b[2]),
        ]
    )


def quotient(a: Jet, b: Jet) -> Jet:
    """a / b, from a = (a/b) b order by order."""
    q0 = a[0] / b[0]
    q1 = (a[1] - q0 * b[1]) / b[0]
    q2 = (a[2] - 2.0 * (q1 * b[1]) - q0 * b[2]) / b[0]
    q3 = (a[3] - 3.0 * (q2 * b[1] + q1 * b[2]) - q0 * b[3]) / b[0]
    return _stacked([q0, q1, q2, q3])


def composed(outer: Sequence[Floats], inner: Jet) -> Jet:
    """f(inner) from f, f', f'', f''' at inner[0]; what does not move needs no derivative of f."""
    f0, *slopes = outer
    g1, g2, g3 = inner[1], inner[2], inner[3]
    still = (inner[1:] == 0.0).all(axis=0)
    f1, f2, f3 = (np.where(still, 0.0, slope) for slope in slopes)
    return _stacked(
        [
            f0,
            f1 * g1,
            f2 * (g1 * g1) + f1 * g2,
            f3 * (g1 * g1 * g1) + 3.0 * f2 * (g1 * g2) + f1 * g3,
        ]
    )


def _stacked(orders: list[Floats]) -> Jet:
    return np.stack(np.broadcast_arrays(*orders))


# Hyperbolic functions of rows with their first three derivatives, each of shape (rows,). Those of
# other elementary functions are `tape.SLOPES`.


def sinh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic sine."""
    sine, cosine = operations.sinh(x), operations.cosh(x)
    return sine, cosine, sine, cosine  # type: ignore[return-value]


def cosh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic cosine."""
    sine, cosine, *_ = sinh(x)
    return cosine, sine, cosine, sine


def tanh(x: Floats) -> tuple[Floats, ...]:
    """Hyperbolic tangent."""
    tangent: Any = operations.tanh(x)
    slope = 1.0 / (cosh(x)[0] * cosh(x)[0])
    third = slope * (4.0 * tangent * tangent - 2.0 * slope)
    return tangent, slope, -2.0 * tangent * slope, third


def asinh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic sine."""
    slope = 1.0 / np.sqrt(x * x + 1.0)
    cube = slope * slope * slope
    third = cube * (3.0 * (x * slope) * (x * slope) - 1.0)
    return operations.asinh(x), slope, -x * cube, third  # type: ignore[return-value]


def acosh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic cosine."""
    slope = 1.0 / np.sqrt((x - 1.0) * (x + 1.0))
    cube = slope * slope * slope
    third = cube * (3.0 * (x * slope) * (x * slope) - 1.0)
    return operations.acosh(x), slope, -x * cube, third  # type: ignore[return-value]


def atanh(x: Floats) -> tuple[Floats, ...]:
    """Inverse of the hyperbolic tangent."""
    slope = 1.0 / ((1.0 - x) * (1.0 + x))
    square = slope * slope
    third = (6.0 * x * x + 2.0) * (square * slope)
    return operations.atanh(x), slope, 2.0 * x * square, third  # type: ignore[return-value]


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
                unit = node.unit
                value = conversion(unit.factor).apply(node.value) if unit else node.value
                stack.append(constant_jet(value))
            else:
                stack.append(names[node.text])
    jet: Jet = stack[-1]
    return jet


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


def _through(outer: Callable[[Floats], Sequence[Floats]]) -> Callable[[Jet], Jet]:
    return lambda inner: composed(outer(inner[0]), inner)


def _angle_of(y: Jet, x: Jet) -> Jet:
    """atan2(y, x): its rate is (x y' - y x') / (x^2 + y^2), whose jet has one order less."""
    turning = product(x, _rate(y)) - product(y, _rate(x))
    rate = quotient(turning, product(x, x) + product(y, y))
    value = operations.angle_of(y[0], x[0])
    still = (turning == 0.0).all(axis=0)
    return np.stack(np.broadcast_arrays(value, *np.where(still, 0.0, rate[:3])))


def _rate(jet: Jet) -> Jet:
    """The derivative's jet; its last order is not known and stands as zero."""
    return np.concatenate([jet[1:], np.zeros_like(jet[:1])])


def _power(base: Jet, exponent: Jet) -> Jet:
    if exponent[1:].any():
        value = operations.power(base[0], exponent[0])
        by_logarithm = product(exponent, composed(SLOPES["LOG"](base[0]), base))
        return composed((value,) * JET_ORDERS, by_logarithm)  # type: ignore[arg-type]
    x, n = map(np.array, np.broadcast_arrays(base[0], exponent[0]))
    orders, factor = [], np.ones_like(x)
    for order in range(JET_ORDERS):
        power = x * x if order == 0 and (n == 2.0).all() else operations.power(x, n - order)
        orders.append(np.where(factor == 0.0, 0.0, factor * power))
        factor = factor * (n - order)
    return composed(orders, base)


def _absolute(a: Jet) -> Jet:
    corner = (a[0] == 0.0) & (a[1:] != 0.0).any(axis=0)
    jet = np.where(a[0] < 0.0, -a, a)
    return np.concatenate([np.abs(a[:1]), np.where(corner, np.nan, jet[1:])])


def _extreme(sign: float) -> Callable[..., Jet]:
    """max for sign 1, min for -1; a corner where two are equal and do not move alike."""

    def of_two(a: Jet, b: Jet) -> Jet:
        a, b = np.broadcast_arrays(a, b)
        corner = (a[0] == b[0]) & (a[1:] != b[1:]).any(axis=0)
        jet = np.where(sign * b[0] > sign * a[0], b, a)
        return np.concatenate([jet[:1], np.where(corner, np.nan, jet[1:])])

    return lambda *operands: reduce(of_two, operands)


def _compared(symbol: str) -> Callable[[Jet, Jet], Jet]:
    """A step where a difference passes zero, else a constant."""
    truth = operations.COMPARED[symbol]

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

    def of_numbers(a: Jet, b: Jet) -> Jet:
        chosen = np.where(truth[0] == 0.0, b, a)
        return np.where(np.isnan(truth).any(axis=0), np.nan, chosen)

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


_sign = _staircase(operations.sign, lambda x: x)
_floor = _staircase(operations.below, lambda x: x - operations.nearest(x))


def _mod(a: Jet, period: Jet) -> Jet:
    return a - product(period, _floor(quotient(a, period)))


def _hypot(*sides: Jet) -> Jet:
    square = reduce(lambda a, b: a + b, (product(side, side) for side in sides))
    return composed(SLOPES["SQUARE_ROOT"](square[0]), square)


def _wrap(a: Jet) -> Jet:
    return np.concatenate([np.atleast_2d(operations.wrap(a[0])), a[1:]])


def _dot(a: JetVector, b: JetVector) -> Jet:
    return reduce(add, (product(p, q) for p, q in zip(a, b, strict=True)))


def _cross(a: JetVector, b: JetVector) -> Any:
    def minor(i: int, j: int) -> Jet:
        return product(a[i], b[j]) - product(a[j], b[i])

    return minor(0, 1) if len(a) == 2 else (minor(1, 2), minor(2, 0), minor(0, 1))


def _size(normal: Any) -> Jet:
    """Of a vector product, which in a plane is one number."""
    return _hypot(*normal) if isinstance(normal, tuple) else _absolute(normal)


def _zero_of(a: JetVector) -> Jet:
    """Zero, and no number in rows where a vector has no direction."""
    return quotient(constant_jet(0.0), _dot(a, a))


_ELEMENTARY = ("sin", "cos", "tan", "asin", "acos", "atan", "exp", "log")

RULES: dict[str, Callable[..., Any]] = {
    "+": _on_each(lambda a, b: a + b),
    "-": _on_each(lambda a, b: a - b),
    "*": _on_each(product),
    "/": _on_each(quotient),
    "^": _power,
    "negate": _negative,
    "[]": lambda *components: components,
    ".x": lambda a: a[0],
    ".y": lambda a: a[1],
    ".z": lambda a: a[2],
    **{name: _through(SLOPES[name.upper()]) for name in _ELEMENTARY},
    "atan2": _angle_of,
    "sqrt": _through(SLOPES["SQUARE_ROOT"]),
    "pow": _power,
    "abs": _absolute,
    "sign": _sign,
    "min": _extreme(-1.0),
    "max": _extreme(1.0),
    "wrap": _wrap,
    "dot": _dot,
    "cross": _cross,
    "det": lambda a, b, c: _dot(a, _cross(b, c)),
    "norm": lambda a: _hypot(*a),
    "unit_vector": lambda a: _on_each(quotient)(a, _hypot(*a)),
    "angle_between": lambda a, b: (
        _angle_of(_size(_cross(a, b)), _dot(a, b)) + (_zero_of(a) + _zero_of(b))
    ),
    **{symbol: _compared(symbol) for symbol in operations.COMPARED},
    "and": _joined(operations.both),
    "or": _joined(operations.either),
    "not": lambda a: constant_jet(1.0) - a,
    "if": _if,
    "clip": lambda a, least, most: _extreme(-1.0)(_extreme(1.0)(a, least), most),
    "hypot": _hypot,
    "floor": _floor,
    "ceil": _staircase(operations.above, lambda x: x - operations.nearest(x)),
    "round": _staircase(operations.nearest, lambda x: x - operations.below(x) - 0.5),
    "mod": _mod,
    "sinh": _through(sinh),
    "cosh": _through(cosh),
    "tanh": _through(tanh),
    "asinh": _through(asinh),
    "acosh": _through(acosh),
    "atanh": _through(atanh),
}
"""Every operation's rule for jets; a vector is a tuple of jets."""


Nodes = tuple[Node, ...]
Rate = Callable[[Name], Nodes | None]
"""The derivative of a name; None where it does not move."""


class _Part(NamedTuple):
    """A part of an expression, its derivative, None where it does not move, and whether it is in
    parts of pi."""

    value: Nodes
    rate: Nodes | None
    in_pi: bool


TERMS: dict[str, tuple[str, ...]] = {
    "+": ("d", "d"),
    "-": ("d", "-d"),
    "*": ("d*b", "a*d"),
    "/": ("d/b", "-a*d/(b*b)"),
    "negate": ("-d",),
    ".x": ("(d).x",),
    ".y": ("(d).y",),
    ".z": ("(d).z",),
    "sin": ("cos(a)*d/r",),
    "cos": ("-sin(a)*d/r",),
    "tan": ("(1 + tan(a)^2)*d/r",),
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
"""The terms of an operation's derivative, for the derivative d of each operand a, b, c; r is the
radian in which a is read: 1 rad of an angle, 1 of a number."""

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

_OF_ANGLES = {"sin", "cos", "tan"}
"""Operations that also take a number in parts of pi, in radians."""

_FOLDED = {"min", "max", "hypot"}
"""Operations of two operands or more: of the first two, then of that and the next."""


def differentiated(
    nodes: Sequence[Node], rate: Rate, unit: str, offset: int, resolve: Resolve
) -> Nodes:
    """The nodes of the derivative by a quantity.

    Args:
        nodes: of the expression, in postfix order, without a derivative in it.
        rate: the derivatives of names.
        unit: of the quantity, `rad` or `m`.
        offset: where the result's operations are taken to stand.
        resolve: one row, shape (1,), of a name: it tells an angle from a number in parts of pi.

    Raises:
        ExpressionError: from `rate`, or the result exceeds a limit.
    """
    stack: list[_Part] = []
    for node in nodes:
        if isinstance(node, Name):
            stack.append(_Part((node,), rate(node), in_pi=False))
        elif isinstance(node, NumberNode):
            stack.append(_Part((node,), None, node.in_pi))
        else:
            operands = stack[-node.arity :]
            del stack[-node.arity :]
            stack.append(_operated(node, operands, unit, offset, resolve))
        refuse_large(len(stack[-1].value) + len(stack[-1].rate or ()), offset)
    whole = stack[-1]
    if whole.rate is None:
        return _rate_of(whole, unit, offset)
    # log(x) has none where x < 0, though 1/x has a value, and so for what does not move
    return _filled(f"d + 0*a/(1 {unit})", {"a": whole.value, "d": whole.rate}, offset)


def _operated(
    node: OperationNode, operands: list[_Part], unit: str, offset: int, resolve: Resolve
) -> _Part:
    if node.symbol in _FOLDED and node.arity > 2:
        pair = node._replace(arity=2)
        return reduce(lambda a, b: _operated(pair, [a, b], unit, offset, resolve), operands)
    values, rates, in_pi = zip(*operands, strict=True)
    value = (*chain.from_iterable(values), node)
    is_in_pi = stays_in_pi(node.symbol, in_pi)
    if node.symbol in STEPS or all(rate is None for rate in rates):
        return _Part(value, None, is_in_pi)
    names = dict(zip("abc", values, strict=False))
    if node.symbol in WHOLE:
        all_rates = [_rate_of(operand, unit, offset) for operand in operands]
        names |= dict(zip(("da", "db", "dc"), all_rates, strict=False))
        return _Part(value, _filled(WHOLE[node.symbol], names, offset), is_in_pi)
    terms: Sequence[str] = TERMS[node.symbol]
    exponent = values[-1][-1]
    if node.symbol in ("^", "pow") and isinstance(exponent, NumberNode) and exponent.unit is None:
        # a literal exponent has its derivative's exponent as a literal, too
        terms = (f"b*a^{float(exponent.value) - 1.0!r}*d", "d")
    if node.symbol in _OF_ANGLES:
        names["r"] = _template("1" if in_pi[0] and _is_number(values[0], resolve) else "1 rad")
    total: Nodes = ()
    for rate, text in zip(rates, terms, strict=True):
        if rate is not None:
            term = _filled(text, {**names, "d": rate}, offset)
            total = (*total, *term, OperationNode("+", 2, offset)) if total else term
    return _Part(value, total, is_in_pi)


def _is_number(nodes: Nodes, resolve: Resolve) -> bool:
    """Whether a part has no dimension."""
    try:
        return Expression("", nodes).evaluate(resolve).dimension.dimensionless
    except ExpressionError:
        return False  # told where the derivative is evaluated, which has the part in it


def _rate_of(part: _Part, unit: str, offset: int) -> Nodes:
    """The derivative, zero in its dimension where the part does not move."""
    if part.rate is not None:
        return part.rate
    return _filled(f"0*a/(1 {unit})", {"a": part.value}, offset)


_template = cache(parse_nodes)


def _filled(text: str, parts: Mapping[str, Nodes], offset: int) -> Nodes:
    """A rule with parts of the expression in the places of its names."""
    nodes: list[Node] = []
    for node in _template(text):
        if isinstance(node, Name):
            nodes += parts[node.text]
        else:
            nodes.append(node._replace(offset=offset))
    return tuple(nodes)
