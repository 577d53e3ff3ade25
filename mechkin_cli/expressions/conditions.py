"""Comparisons of operands, what is made of them, and the choice between two values."""

from __future__ import annotations

from collections.abc import Callable

from mechkin_cli.expressions import truths
from mechkin_cli.expressions.arithmetic import common_dimension, elementwise
from mechkin_cli.expressions.operand import Operand, Site
from mechkin_cli.expressions.quantity import Quantity, Scalar

COMPARED: dict[str, Callable[[Scalar, Scalar], Scalar]] = {
    "<": truths.less,
    "<=": lambda a, b: truths.opposite(truths.more(a, b)),
    ">": truths.more,
    ">=": lambda a, b: truths.opposite(truths.less(a, b)),
    "==": lambda a, b: truths.opposite(truths.differs(a, b)),
    "!=": truths.differs,
}
"""The truth of each comparison, by its sign."""

_JOINED: dict[str, Callable[[Scalar, Scalar], Scalar]] = {
    "and": truths.both,
    "or": truths.either,
}


def compare(site: Site, left: Operand, right: Operand) -> Quantity:
    """Whether a comparison of two scalars of one dimension holds."""
    values = site.scalar(left), site.scalar(right)
    common_dimension(site, "compare {left} with {right}", left, right)
    return _truth(COMPARED[site.symbol](*values))


def join(site: Site, left: Operand, right: Operand) -> Quantity:
    """Whether both conditions hold, or at least one."""
    return _truth(_JOINED[site.symbol](_condition(site, left), _condition(site, right)))


def deny(site: Site, operand: Operand) -> Quantity:
    """Whether a condition does not hold."""
    return _truth(truths.opposite(_condition(site, operand)))


def choose(site: Site, condition: Operand, value: Operand, other: Operand) -> Quantity:
    """One of two values of one dimension, scalars or vectors; both are computed."""
    truth = _condition(site, condition)
    dimension = common_dimension(site, "choose between {left} and {right}", value, other)
    found = elementwise(lambda a, b: truths.chosen(truth, a, b), value.value, other.value)
    return Quantity(found, dimension, truth=value.quantity.truth and other.quantity.truth)


def _truth(value: Scalar) -> Quantity:
    return Quantity(value, truth=True)


def _condition(site: Site, operand: Operand) -> Scalar:
    """The truth of an operand that must be a condition.

    Raises:
        ExpressionError: it is a number or a vector.
    """
    if not operand.quantity.truth:
        raise site.error(
            f"{site.symbol} takes a condition, not {operand.phrase}",
            "write a comparison such as a > b",
            operand,
        )
    return site.scalar(operand)
