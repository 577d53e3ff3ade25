"""Parameters that use one another."""

from __future__ import annotations

import math

import pytest

from mechkin_cli.expressions.expression import evaluate_parameters, parse
from mechkin_cli.expressions.quantity import ExpressionError, lookup
from mechkin_cli.units.dimension import ANGLE, DIMENSIONLESS, LENGTH, MASS
from mechkin_cli.units.units import UnitSystem

INCH = UnitSystem.from_mapping({"length": "in"})


def test_values_in_any_order() -> None:
    values = evaluate_parameters(
        {"c": "a + b/2", "b": "2*a", "a": "1 m", "m": "2 kg", "k": "3", "angle": "180 deg"}, INCH
    )
    assert {name: quantity.value for name, quantity in values.items()} == {
        "c": 2.0,
        "b": 2.0,
        "a": 1.0,
        "m": 2.0,
        "k": 3.0,
        "angle": math.pi,
    }
    assert list(values) == ["c", "b", "a", "m", "k", "angle"]
    assert values["c"].dimension == LENGTH
    assert values["k"].dimension == DIMENSIONLESS
    assert values["m"].dimension == MASS
    assert values["angle"].dimension == ANGLE


def test_a_long_chain_needs_no_recursion() -> None:
    texts = {f"a{i}": f"a{i + 1} + 1" for i in range(5000)} | {"a5000": "0"}
    assert evaluate_parameters(texts, INCH)["a0"].value == 5000.0


@pytest.mark.parametrize(
    ("texts", "name", "offset", "words"),
    [
        ({"a": "b", "b": "2*c", "c": "1 + a"}, "c", 4, "a -> b -> c -> a; give one of them"),
        ({"a": "1", "b": "b + a"}, "b", 0, "b -> b"),
        ({"a": "b.x", "b": "a"}, "b", 0, "a -> b -> a"),
        ({"P1": "1 in", "P2": "P1 + 0.5"}, "P2", 5, "write the number with a unit: 0.5 in"),
        ({"alpha": "1", "b": "alhpa"}, "b", 0, "did you mean alpha?"),
        ({"a": "2 +"}, "a", 3, "ends where"),
        ({"a": "O1.theta"}, "a", 0, "nothing named O1.theta"),
        ({"a": "1", "b": "a.x"}, "b", 1, ".x takes a component of a vector"),
        ({"a": "[1, 2, 3]"}, "a", 0, "one number, not a vector"),
        ({"m": "10 N*m"}, "m", 5, "ambiguous: m is a unit and a name"),
        ({"a": "1/(b - 1)", "b": "1"}, "a", 3, "division by zero"),
    ],
)
def test_bad_parameters(texts: dict[str, str], name: str, offset: int, words: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        evaluate_parameters(texts, INCH)
    assert words in str(caught.value)
    assert (caught.value.name, caught.value.offset) == (name, offset)


def test_independent_errors_are_collected_once() -> None:
    errors: list[ExpressionError] = []
    texts = {
        "good": "1",
        "typed": "2 +",
        "uses_typed": "typed",
        "left": "right",
        "right": "left",
        "uses_left": "left*2",
        "unknown": "nothing",
    }
    values = evaluate_parameters(texts, INCH, errors)
    assert list(values) == ["good"]
    assert [error.name for error in errors] == ["typed", "right", "unknown"]


def test_a_resolver_of_values_hints_at_the_nearest() -> None:
    values = evaluate_parameters({"alpha1": "12 deg", "P1": "1 in"}, INCH)
    with pytest.raises(ExpressionError, match="did you mean alpha1"):
        parse("cos(alpha)").evaluate(lookup(values))
