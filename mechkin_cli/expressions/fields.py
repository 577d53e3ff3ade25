"""Scalar fields and parameters of a file: from their texts to numbers.

A text that is only a number takes the field's unit; anything else must have the field's dimension.
Parameters are texts that may use one another in any order.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType

from mechkin_cli.expressions.expression import Expression, parse
from mechkin_cli.expressions.grammar import VANISHES, WRITE_ZERO, vanishes
from mechkin_cli.expressions.quantity import (
    MAX_CHAIN,
    MAX_ERRORS,
    ExpressionError,
    Operand,
    Quantity,
    Resolve,
    Scalar,
    Site,
    UnknownName,
    Vector,
    read,
)
from mechkin_cli.tape import is_finite, is_number
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
    if number is None or number.unit is None:
        return units.from_si(value, dimension)
    try:
        return conversion(number.unit.factor / units.unit(dimension).factor).apply(number.value)
    except UnitError as error:
        raise ExpressionError(error.message, number.offset, error.hint) from None


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


Move = Callable[[str, Quantity], Quantity]
"""Changes the value of a parameter, of which it takes name and value."""

_NOTHING: Mapping[str, Quantity] = MappingProxyType({})


def lookup(quantities: Mapping[str, Quantity], known: Iterable[str] | None = None) -> Resolve:
    """A resolver for the names of a mapping; its hints for others are names of `known` (None: of
    the mapping)."""

    def resolve(name: str) -> Quantity:
        try:
            return quantities[name]
        except KeyError:
            raise UnknownName(name, quantities if known is None else known) from None

    return resolve


def evaluate_parameters(
    texts: Mapping[str, str],
    units: UnitSystem,
    errors: list[ExpressionError] | None = None,
    given: Mapping[str, Quantity] = _NOTHING,
    moved: Move | None = None,
) -> dict[str, Quantity]:
    """The values of all parameters in SI, in the order of `texts`.

    A number without unit is dimensionless. With a list `errors`, every independent error (up to
    a little over `MAX_ERRORS`) is appended to it and the parameters that cannot be evaluated are
    left out; without one the first is raised. `given` are values instead of some texts. `moved`
    changes each value, and so those that depend on it.

    Raises:
        ExpressionError: a text that is no constant, or parameters that depend on themselves; `name`
            is the parameter, `offset` counts within its text.
    """
    all_errors: list[ExpressionError] = [] if errors is None else errors
    before = len(all_errors)
    expressions = {}
    for name, text in texts.items():
        if name not in given:
            try:
                expressions[name] = parse(text)
            except ExpressionError as error:
                all_errors.append(_named(error, name))
    needs = {
        name: sorted({used.partition(".")[0] for used in expression.names})
        for name, expression in expressions.items()
    }
    move = moved or (lambda _, value: value)
    values = {name: move(name, value) for name, value in given.items()}
    resolve = lookup(values, texts)
    for name in in_order(expressions, needs, all_errors):
        if len(all_errors) - before > MAX_ERRORS:
            break
        if any(need in texts and need not in values for need in needs[name]):
            continue
        try:
            expressions[name].reject_ambiguous_units(texts.__contains__)
            quantity = expressions[name].evaluate(resolve, units)
            if isinstance(quantity.value, Vector):
                hint = "take a component with .x, .y or .z"
                raise ExpressionError("a parameter is one number, not a vector", 0, hint)
            values[name] = move(name, quantity)
        except ExpressionError as error:
            all_errors.append(_named(error, name))
    if errors is None and len(all_errors) > before:
        raise all_errors[before]
    return {name: values[name] for name in texts if name in values}


def in_order(
    expressions: Mapping[str, Expression],
    needs: Mapping[str, list[str]],
    errors: list[ExpressionError],
    kind: str = "parameters",
) -> list[str]:
    """Names with what they need before them; the members of a cycle are left out with one error,
    in which `kind` is the noun for them."""
    order: list[str] = []
    finished: set[str] = set()
    for root in expressions:
        path: dict[str, Iterator[str]] = {} if root in finished else {root: iter(needs[root])}
        while path:
            name = next(reversed(path))
            need = next(path[name], None)
            if need is None:
                del path[name]
                if name not in finished:
                    finished.add(name)
                    order.append(name)
            elif need in path:
                chain = list(path)[list(path).index(need) :]
                errors.append(_cycle(expressions[name], chain, kind))
                finished.update(chain)
            elif need in expressions and need not in finished:
                path[need] = iter(needs[need])
    return order


def _cycle(expression: Expression, chain: list[str], kind: str) -> ExpressionError:
    shown = chain
    if len(chain) > MAX_CHAIN:
        shown = [*chain[: MAX_CHAIN - 1], f"... ({len(chain)} names)"]
    return ExpressionError(
        f"{kind} depend on themselves: {' -> '.join([*shown, chain[0]])}",
        expression.offset_of(chain[0]),
        "give one of them a value" if kind == "parameters" else "write one without the others",
        chain[-1],
    )


def _named(error: ExpressionError, name: str) -> ExpressionError:
    return ExpressionError(error.message, error.offset, error.hint, name)
