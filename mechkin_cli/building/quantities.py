"""`quantities:` to named expressions; each is checked where it is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mechkin_cli.building.columns import Sample, quantities_of
from mechkin_cli.building.run_names import runs_of
from mechkin_cli.expressions import ExpressionError, parse
from mechkin_cli.expressions.nodes import Name, Node, Operation
from mechkin_cli.expressions.parameters import in_order

if TYPE_CHECKING:
    from mechkin_cli.building.fields import Fields
    from mechkin_cli.expressions import Expression, Quantity
    from mechkin_cli.mechanism.problem import Problem
    from mechkin_cli.schema.file import MechanismFile


def read_quantities(fields: Fields, texts: Mapping[str, str]) -> None:
    """Puts the named expressions into `fields.definitions`; those that depend on themselves or are
    no expressions are refused, with a message."""
    expressions: dict[str, Expression] = {}
    for name, text in texts.items():
        try:
            expressions[name] = parse(text)
        except ExpressionError as error:
            fields.expression_error(("quantities", name), error)
    needs = {
        name: sorted({used.partition(".")[0] for used in expression.names} & texts.keys())
        for name, expression in expressions.items()
    }
    errors: list[ExpressionError] = []
    for name in in_order(expressions, needs, errors, "quantities"):
        if any(need not in fields.definitions.named for need in needs[name]):
            continue
        try:
            found = fields.definitions.expanded(expressions[name])
        except ExpressionError as error:
            fields.expression_error(("quantities", name), error)
            continue
        fields.definitions = fields.definitions.adding(name, found)
    for circle in errors:
        fields.expression_error(("quantities", circle.name or ""), circle)
    fields.refused |= texts.keys() - fields.definitions.named.keys()


def take_derivatives(fields: Fields) -> None:
    """Writes out the derivatives in the named expressions; one that is not known is refused, with a
    message."""
    named = fields.definitions.named
    fields.definitions = replace(fields.definitions, named={})
    for name, expression in named.items():
        try:
            found = fields.definitions.expanded(expression)
        except ExpressionError as error:
            fields.expression_error(("quantities", name), error)
            fields.refused.add(name)
            continue
        fields.definitions = fields.definitions.adding(name, found)


def check_quantities(fields: Fields, file: MechanismFile, problem: Problem) -> None:
    """Notes what is wrong with a quantity in every run of the file, at its place; what uses it gets
    no message of its own."""
    runs = runs_of(file)
    samples = [_Named(Sample(fields, quantities_of(problem, run), run), {}) for run in runs]
    for name in fields.definitions.named:
        expression = parse(file.quantities[name])
        if _uses(expression) & fields.refused:
            fields.refused.add(name)
            continue
        wrong = [_error_of(fields, name, expression, sample) for sample in samples]
        if all(error is not None for error in wrong) and wrong[0] is not None:
            fields.expression_error(("quantities", name), wrong[0])
            fields.refused.add(name)


def _uses(expression: Expression) -> set[str]:
    names = (node.text for node in expression.nodes if isinstance(node, Name))
    return {name.partition(".")[0] for name in names}


@dataclass(frozen=True)
class _Named:
    """A run's sample with the values of named expressions, so that each is evaluated once."""

    sample: Sample
    known: dict[str, Quantity]

    def __call__(self, name: str) -> Quantity:
        return self.known[name] if name in self.known else self.sample(name)


def _error_of(
    fields: Fields, name: str, expression: Expression, sample: _Named
) -> ExpressionError | None:
    """What is wrong with a named expression whose names are known; else keeps its value."""
    try:
        if any(map(_is_derivative, expression.nodes)):
            whole = fields.definitions.expanded(expression)
            sample.known[name] = whole.evaluate(sample.sample, fields.units)
        else:
            sample.known[name] = expression.evaluate(sample, fields.units)
    except ExpressionError as error:
        return error
    return None


def _is_derivative(node: Node) -> bool:
    return isinstance(node, Operation) and node.symbol == "derivative"
