"""A file's parameters: texts that may use one another in any order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType

from mechkin_cli.expressions.errors import ExpressionError, UnknownName
from mechkin_cli.expressions.expression import Expression, parse
from mechkin_cli.expressions.limits import MAX_CHAIN, MAX_ERRORS
from mechkin_cli.expressions.operand import Resolve
from mechkin_cli.expressions.quantity import Quantity, Vector
from mechkin_cli.units import UnitSystem

Names = dict[str, list[str]]
Move = Callable[[str, Quantity], Quantity]
"""Makes of a parameter and its value another value."""

_NOTHING: Mapping[str, Quantity] = MappingProxyType({})


def lookup(quantities: Mapping[str, Quantity]) -> Resolve:
    """A resolver for the names of a mapping, with the nearest of them as hint for others."""

    def resolve(name: str) -> Quantity:
        try:
            return quantities[name]
        except KeyError:
            raise UnknownName(name, quantities) from None

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
    left out; without one the first is raised. `given` are values instead of some texts; each value
    is taken as `moved` makes it, by those that depend on it, too.

    Raises:
        ExpressionError: a text that is no constant, or parameters that depend on themselves; `name`
            is the parameter, `offset` counts within its text.
    """
    found: list[ExpressionError] = [] if errors is None else errors
    before = len(found)
    expressions = _parsed({n: t for n, t in texts.items() if n not in given}, found)
    needs = {
        name: _unique(used.partition(".")[0] for used in expression.names)
        for name, expression in expressions.items()
    }
    move = moved or _unmoved
    values = {name: move(name, value) for name, value in given.items()}
    for name in in_order(expressions, needs, found):
        if len(found) - before > MAX_ERRORS:
            break
        if any(need in texts and need not in values for need in needs[name]):
            continue
        try:
            value = _scalar(expressions[name], _resolver(values, texts), texts, units)
            values[name] = move(name, value)
        except ExpressionError as error:
            found.append(_named(error, name))
    if errors is None and len(found) > before:
        raise found[before]
    return {name: values[name] for name in texts if name in values}


def _unmoved(name: str, value: Quantity) -> Quantity:
    return value


def _parsed(texts: Mapping[str, str], errors: list[ExpressionError]) -> dict[str, Expression]:
    expressions = {}
    for name, text in texts.items():
        try:
            expressions[name] = parse(text)
        except ExpressionError as error:
            errors.append(_named(error, name))
    return expressions


def _resolver(values: Mapping[str, Quantity], texts: Mapping[str, str]) -> Resolve:
    """Values so far; hints may name every parameter."""

    def resolve(name: str) -> Quantity:
        if name in values:
            return values[name]
        raise UnknownName(name, texts)

    return resolve


def _scalar(
    expression: Expression, resolve: Resolve, texts: Mapping[str, str], units: UnitSystem
) -> Quantity:
    expression.reject_ambiguous_units(texts.__contains__)
    quantity = expression.evaluate(resolve, units)
    if isinstance(quantity.value, Vector):
        raise ExpressionError(
            "a parameter is one number, not a vector", 0, "take a component with .x, .y or .z"
        )
    return quantity


def in_order(
    expressions: Mapping[str, Expression],
    needs: Names,
    errors: list[ExpressionError],
    kind: str = "parameters",
) -> list[str]:
    """Names with what they need before them; the members of a cycle are left out with one error,
    which says of what `kind` they are."""
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
        "give one of them a value"
        if kind == "parameters"
        else "give one of them a value"
        if kind == "parameters"
        else "write one without the others",
        chain[-1],
    )


def _unique(names: Iterable[str]) -> list[str]:
    return sorted(set(names))


def _named(error: ExpressionError, name: str) -> ExpressionError:
    return ExpressionError(error.message, error.offset, error.hint, name)
