"""Derivatives of an expression whose names move: the chain rule, node by node, up to third order.

Each operation and function of expressions has its rule for jets here. Where a derivative does not
exist (abs and sign at zero, min and max of two that cross, sqrt at zero) it is nan or infinite.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.expressions import jets, scalar_functions
from mechkin_cli.expressions.expression import Expression
from mechkin_cli.expressions.jets import Jet
from mechkin_cli.expressions.nodes import Number, Operation
from mechkin_cli.kernel import functions as kernel
from mechkin_cli.units import conversion

JetVector = tuple[Jet, Jet, Jet]


def derivatives(expression: Expression, names: Mapping[str, Jet]) -> Jet:
    """Value and first three derivatives of a scalar expression, in SI, shape (4, rows or 1).

    Args:
        expression: one that `Expression.evaluate` accepts with the same names as scalars.
        names: every name's own value and derivatives.
    """
    stack: list[Any] = []
    with np.errstate(all="ignore"):
        for node in expression.nodes:
            if isinstance(node, Operation):
                operands = stack[-node.arity :]
                del stack[-node.arity :]
                stack.append(RULES[node.symbol](*operands))
            elif isinstance(node, Number):
                stack.append(jets.constant(_in_si(node)))
            else:
                stack.append(names[node.text])
    jet: Jet = stack[-1]
    return jet


def _in_si(number: Number) -> float:
    if number.unit is None:
        return number.value
    return conversion(number.unit.factor).apply(number.value)


def _on_each(rule: Callable[[Jet, Jet], Jet]) -> Callable[[Any, Any], Any]:
    """The rule for two numbers, for two vectors component by component, or for one of each."""

    def apply(a: Any, b: Any) -> Any:
        if not isinstance(a, tuple) and not isinstance(b, tuple):
            return rule(a, b)
        left, right = (each if isinstance(each, tuple) else (each,) * 3 for each in (a, b))
        return tuple(rule(p, q) for p, q in zip(left, right, strict=True))

    return apply


def _negative(a: Any) -> Any:
    return tuple(-each for each in a) if isinstance(a, tuple) else -a


def _through(outer: Callable[[Floats], tuple[Floats, ...]]) -> Callable[[Jet], Jet]:
    return lambda inner: jets.of(outer(inner[0]), inner)


def _sin(x: Floats) -> tuple[Floats, ...]:
    sine, cosine = kernel.sin(x), kernel.cos(x)
    return sine, cosine, -sine, -cosine


def _cos(x: Floats) -> tuple[Floats, ...]:
    sine, cosine = kernel.sin(x), kernel.cos(x)
    return cosine, -sine, -cosine, sine


def _tan(x: Floats) -> tuple[Floats, ...]:
    tangent = kernel.tan(x)
    square = tangent * tangent
    return (
        tangent,
        1.0 + square,
        2.0 * tangent * (1.0 + square),
        (1.0 + square) * (2.0 + 6 * square),
    )


def _asin(x: Floats) -> tuple[Floats, ...]:
    slope = 1.0 / np.sqrt((1.0 - x) * (1.0 + x))
    cube = slope * slope * slope
    return kernel.asin(x), slope, x * cube, cube * (1.0 + 3.0 * (x * slope) * (x * slope))


def _acos(x: Floats) -> tuple[Floats, ...]:
    _, first, second, third = _asin(x)
    return kernel.acos(x), -first, -second, -third


def _atan(x: Floats) -> tuple[Floats, ...]:
    slope = 1.0 / (1.0 + x * x)
    square = slope * slope
    return kernel.atan(x), slope, -2.0 * x * square, (6.0 * x * x - 2.0) * (square * slope)


def _sqrt(x: Floats) -> tuple[Floats, ...]:
    root = np.sqrt(x)
    first = 0.5 / root
    second = -0.5 * first / x
    return root, first, second, -1.5 * second / x


def _exp(x: Floats) -> tuple[Floats, ...]:
    value = kernel.exp(x)
    return value, value, value, value


def _log(x: Floats) -> tuple[Floats, ...]:
    slope = 1.0 / x
    return kernel.log(x), slope, -(slope * slope), 2.0 * (slope * slope * slope)


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
        by_logarithm = jets.product(exponent, jets.of(_log(base[0]), base))
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


def _wrap(a: Jet) -> Jet:
    return np.concatenate([np.atleast_2d(scalar_functions.wrap(a[0])), a[1:]])


def _dot(a: JetVector, b: JetVector) -> Jet:
    x, y, z = (jets.product(p, q) for p, q in zip(a, b, strict=True))
    return x + y + z


def _cross(a: JetVector, b: JetVector) -> JetVector:
    def minor(i: int, j: int) -> Jet:
        return jets.product(a[i], b[j]) - jets.product(a[j], b[i])

    return minor(1, 2), minor(2, 0), minor(0, 1)


RULES: dict[str, Callable[..., Any]] = {
    "+": _on_each(lambda a, b: a + b),
    "-": _on_each(lambda a, b: a - b),
    "*": _on_each(jets.product),
    "/": _on_each(jets.quotient),
    "^": _power,
    "negate": _negative,
    "[]": lambda x, y, z: (x, y, z),
    ".x": lambda a: a[0],
    ".y": lambda a: a[1],
    ".z": lambda a: a[2],
    "sin": _through(_sin),
    "cos": _through(_cos),
    "tan": _through(_tan),
    "asin": _through(_asin),
    "acos": _through(_acos),
    "atan": _through(_atan),
    "atan2": _angle_of,
    "sqrt": _through(_sqrt),
    "exp": _through(_exp),
    "log": _through(_log),
    "pow": _power,
    "abs": _absolute,
    "sign": _sign,
    "min": _extreme(-1.0),
    "max": _extreme(1.0),
    "wrap": _wrap,
    "dot": _dot,
    "cross": _cross,
    "det": lambda a, b, c: _dot(a, _cross(b, c)),
    "norm": lambda a: jets.of(_sqrt(_dot(a, a)[0]), _dot(a, a)),
}
"""Every operation's rule for jets; a vector is a tuple of three jets."""
