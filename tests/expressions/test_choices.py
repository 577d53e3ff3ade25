"""Choices, comparisons and steps: values in rows, dimensions, truth, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from expressions.names import resolve
from mpmath import mp

from mechkin_cli.expressions.expression import parse
from mechkin_cli.expressions.quantity import ExpressionError, Quantity, Vector, lookup
from mechkin_cli.units.dimension import ANGLE, DIMENSIONLESS, FORCE, LENGTH, Dimension

NAN = float("nan")
ROWS = {
    "x": Quantity(np.array([-1.0, 0.0, 2.0, NAN])),
    "y": Quantity(np.array([1.0, 0.0, NAN, NAN])),
}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x < 0", [1, 0, 0, NAN]),
        ("x <= 0", [1, 1, 0, NAN]),
        ("x > 0", [0, 0, 1, NAN]),
        ("x >= 0", [0, 1, 1, NAN]),
        ("x == 0", [0, 1, 0, NAN]),
        ("x != 0", [1, 0, 1, NAN]),
        ("not x < 0", [0, 1, 1, NAN]),
        ("x > 0 and log(x) > 0", [0, 0, 1, NAN]),
        ("x <= 0 or log(x) > 0", [1, 1, 1, NAN]),
        ("x < 0 and y > 0", [1, 0, 0, NAN]),
        ("x > 0 or y > 0", [1, 0, 1, NAN]),
        ("x < 0 or x > 1 and 1 > 2", [1, 0, 0, NAN]),
        ("not x < 0 and x < 1", [0, 1, 0, NAN]),
        ("if(x < 0, 10, 20)", [10, 20, 20, NAN]),
        ("if(x > 0, 1/x, 0)", [0, 0, 0.5, NAN]),
        ("if(x >= 0, sqrt(x), -sqrt(-x))", [-1, 0, np.sqrt(2.0), NAN]),
        ("if(x < 0, 1, if(x == 0, 2, 3))", [1, 2, 3, NAN]),
        ("if(1 < 2, x, y)", [-1, 0, 2, NAN]),
        ("3*(x < 0)", [3, 0, 0, NAN]),
        ("clip(x, -0.5, 1)", [-0.5, 0, 1, NAN]),
        ("floor(x/4)", [-1, 0, 0, NAN]),
        ("ceil(x/4)", [0, 0, 1, NAN]),
        ("round(x/4 + 1)", [1, 1, 2, NAN]),
        ("mod(x, 3)", [2, 0, 2, NAN]),
        ("mod(x, -3)", [-1, 0, -1, NAN]),
        ("floor(x*1e300)", [NAN, 0, NAN, NAN]),
    ],
)
def test_rows(text: str, expected: list[float]) -> None:
    found = parse(text).evaluate(lookup(ROWS)).value
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(
    ("text", "value", "dimension"),
    [
        ("if(P1 < P2, 5 N, 2 N)", 5.0, FORCE),
        ("mod(-1 m, 3 m)", 2.0, LENGTH),
        ("clip(5 m, P1, P2)", 2.0, LENGTH),
        ("hypot(3 m, 4 m, 12 m)", 13.0, LENGTH),
        ("hypot(3, 4)", 5.0, DIMENSIONLESS),
        ("angle_between([0 m, 2 m, 0 m], [0 m, 0 m, 3 m])", np.pi / 2, ANGLE),
        ("norm(unit_vector([3 m, 4 m, 12 m]))", 1.0, DIMENSIONLESS),
        ("round(2.5)", 2.0, DIMENSIONLESS),
        ("round(3.5)", 4.0, DIMENSIONLESS),
        ("floor(-2)", -2.0, DIMENSIONLESS),
        ("ceil(-2.5)", -2.0, DIMENSIONLESS),
        ("acosh(1)", 0.0, DIMENSIONLESS),
    ],
)
def test_constants(text: str, value: float, dimension: Dimension) -> None:
    found = parse(text).evaluate(resolve)
    assert found.value == value
    assert found.dimension == dimension


def test_a_choice_between_vectors() -> None:
    found = parse("if(x < 0, [1, 2, 3], [x, x, x])").evaluate(lookup(ROWS)).value
    assert isinstance(found, Vector)
    np.testing.assert_array_equal(found.y, [2.0, 0.0, 2.0, NAN])


@pytest.mark.parametrize(
    "text", ["x < 0", "not x < 0", "x < 0 and y > 0", "if(x < 0, x < 1, x > 2)"]
)
def test_what_is_a_condition(text: str) -> None:
    assert parse(text).evaluate(lookup(ROWS)).truth
    assert not parse(f"2*({text})").evaluate(lookup(ROWS)).truth


@pytest.mark.parametrize("name", ["sinh", "cosh", "tanh", "asinh", "acosh", "atanh"])
def test_hyperbolic_functions_to_a_few_roundings(name: str) -> None:
    """Relative errors over twelve decades, against 40 digits."""
    sizes = np.concatenate(
        [10.0 ** np.arange(-11, 1.0), np.linspace(0.01, 3.0, 300), [20.0, 300.0]]
    )
    x = np.concatenate([-sizes, sizes])
    domain = {"acosh": np.abs(x) + 1.0, "atanh": np.tanh(x[np.abs(x) < 5.0])}
    rows = domain.get(name, x)
    found = parse(f"{name}(x)").evaluate({"x": Quantity(rows)}.__getitem__).value
    with mp.workdps(40):
        function = getattr(mp, name)
        expected = [function(mp.mpf(one)) for one in rows]
        worst = max(abs((mp.mpf(f) - e) / e) for f, e in zip(found, expected, strict=True) if e)
    assert worst < 8 * 2.0**-52


@pytest.mark.parametrize(
    ("text", "offset", "words"),
    [
        ("1 < 2 < 3", 6, "join two comparisons: a < b and b < c"),
        ("P1 = P2", 3, "an expression has no =; write == to compare"),
        ("P1 < 3", 5, "cannot compare a length with a dimensionless number; write the number with"),
        ("P1 < alpha", 5, "cannot compare a length with an angle"),
        ("if(n, 1, 2)", 3, "if takes a condition, not a dimensionless number; write a comparison"),
        ("if(n < 1, P1, n)", 14, "cannot choose between a length and a dimensionless number"),
        ("n and n > 1", 0, "and takes a condition"),
        ("not n", 4, "not takes a condition"),
        ("if(n < 1, 2)", 0, "if takes 3 arguments, not 2; write if(condition, a, b)"),
        ("n < 1 && n > 2", 6, "write and"),
        ("n ≤ 1", 2, "write <="),
        ("n ? 1", 2, "if(condition, a, b)"),
        ("A < B", 0, "< takes a number, not a vector"),
        ("floor(P1)", 6, "floor takes a dimensionless number, not a length; divide it by 1 m"),
        ("floor(1e16)", 6, "floor has no finite value"),
        ("mod(P1, 2)", 8, "write the number with a unit: 2 m"),
        ("mod(n, 0)", 7, "mod of zero"),
        ("acosh(0.5)", 6, "acosh has no finite value for 0.5"),
        ("atanh(1)", 6, "atanh has no finite value for 1"),
        ("ln(2)", 0, "the natural logarithm is log(x)"),
        ("log10(2)", 0, "write log(x)/log(10)"),
        ("clamp(n, 1, 2)", 0, "write clip(x, least, most)"),
        ("and", 0, "'and' stands where a number, a name or ( was expected"),
        ("n or", 4, "ends where"),
    ],
)
def test_what_is_refused(text: str, offset: int, words: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse(text).evaluate(resolve)
    assert words in str(caught.value)
    assert caught.value.offset == offset


@pytest.mark.parametrize("opening", ["not ", "if(", "1 < (", "1 and ("])
def test_nesting_has_its_limit(opening: str) -> None:
    with pytest.raises(ExpressionError, match="nested more than 50 deep"):
        parse((opening * 600)[:4000])
