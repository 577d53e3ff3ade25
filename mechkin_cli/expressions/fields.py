"""Texts of scalar fields to numbers.

A text that is only a number takes the field's unit; anything else must have the field's dimension.
"""

from __future__ import annotations

import math
import re

from mechkin_cli.expressions.errors import ExpressionError, UnknownName
from mechkin_cli.expressions.expression import Expression, parse
from mechkin_cli.expressions.nodes import Number
from mechkin_cli.expressions.operand import Operand, Resolve, Site
from mechkin_cli.expressions.quantity import Quantity, Scalar, Vector
from mechkin_cli.expressions.tokens import VANISHES, WRITE_ZERO, vanishes
from mechkin_cli.expressions.written import read
from mechkin_cli.tape.scalars import is_finite, is_number
from mechkin_cli.units import Dimension, UnitError, UnitSystem, conversion

_LITERAL = re.compile(
    r"[ \t]*([-+]?)[ \t]*((?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)[ \t]*"
)
_LONGEST_LITERAL = 400


def no_names(name: str) -> Quantity:
    """A resolver that has no names."""
    raise UnknownName(name)


def literal(text: str) -> float | None:
    """The value of a text that is only a finite number with an optional sign; otherwise None.

    Example:
        >>> literal("010"), literal("-1e-3"), literal("0.5 in")
        (10.0, -0.001, None)
    """
    match = _LITERAL.fullmatch(text) if len(text) <= _LONGEST_LITERAL else None
    if match is None:
        return None
    value = float(match[1] + match[2])
    return value if math.isfinite(value) and not vanishes(match[2], value) else None


def number_of(text: str) -> float | None:
    """As `literal`, for a number to compute with: it may be a recorded one (`written`)."""
    value = literal(text)
    return value if value is None else read(value, "".join(text.split()))


def constant(
    text: str, dimension: Dimension, units: UnitSystem, resolve: Resolve = no_names
) -> float:
    """The SI value of a field.

    Raises:
        ExpressionError: the text is no expression, or its value is not one finite number of the
            field's dimension.
    """
    bare = number_of(text)
    if bare is None:
        return _evaluated(parse(text), dimension, units, resolve)
    value = units.to_si(bare, dimension)
    if not is_finite(value):
        raise ExpressionError(f"{text.strip()} {units.label(dimension)} is too large", 0)
    if value == 0.0 and bare != 0.0:
        raise ExpressionError(f"{text.strip()} {units.label(dimension)} {VANISHES}", 0, WRITE_ZERO)
    return value


def constant_in_file_units(
    text: str, dimension: Dimension, units: UnitSystem, resolve: Resolve = no_names
) -> float:
    """The value of a field in the file's units; a number is returned exactly as written.

    A literal with a unit is converted by the exact ratio of the units, so `192 deg` in a file in
    degrees is 192 and `5 cm` in a file in mm is 50.

    Raises:
        ExpressionError: as `constant`.
    """
    bare = number_of(text)
    if bare is not None:
        return bare
    expression = parse(text)
    value = _evaluated(expression, dimension, units, resolve)
    number = expression.number
    if number is not None and number.unit is not None:
        return _ratio(number, dimension, units)
    return units.from_si(value, dimension)


def _ratio(number: Number, dimension: Dimension, units: UnitSystem) -> float:
    assert number.unit is not None
    try:
        ratio = conversion(number.unit.factor / units.unit(dimension).factor)
    except UnitError as error:
        raise ExpressionError(error.message, number.offset, error.hint) from None
    return ratio.apply(number.value)


def _evaluated(
    expression: Expression, dimension: Dimension, units: UnitSystem, resolve: Resolve
) -> float:
    value = scalar(expression, dimension, units, resolve)
    if not is_number(value):
        raise ExpressionError(
            "expected a constant, found a value per row", _start(expression), "use parameters only"
        )
    return value


def scalar(
    expression: Expression, dimension: Dimension, units: UnitSystem, resolve: Resolve
) -> Scalar:
    """The SI value of an expression that must be one number (per row) of a dimension.

    Raises:
        ExpressionError: a vector, another dimension, or as `Expression.evaluate`.
    """
    quantity = expression.evaluate(resolve, units)
    value = quantity.value
    start = _start(expression)
    if isinstance(value, Vector):
        raise ExpressionError(
            f"expected {dimension.phrase}, found {quantity.phrase}",
            start,
            "take a component with .x, .y or .z, or norm(...)",
        )
    if not quantity.dimension.compatible(dimension):
        operand = Operand(quantity, start, expression.number)
        hint = Site("", start, units).unit_hint(operand, dimension)
        raise ExpressionError(f"expected {dimension.phrase}, found {quantity.phrase}", start, hint)
    return value


def _start(expression: Expression) -> int:
    return len(expression.text) - len(expression.text.lstrip())
