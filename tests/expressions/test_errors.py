"""Expressions that are refused: where the error points and what it says."""

from __future__ import annotations

import pytest
from expressions.names import INCH_POUND, resolve

from mechkin_cli.expressions.expression import parse
from mechkin_cli.expressions.quantity import ExpressionError, Quantity
from mechkin_cli.units.dimension import DIMENSIONLESS


@pytest.mark.parametrize(
    ("text", "offset", "words"),
    [
        ("", 0, "the expression is empty; write a number"),
        ("   ", 0, "empty"),
        ("1 +", 3, "ends where a number, a name or ( was expected"),
        ("* 2", 0, "'*' stands where a number"),
        ("(1 + 2", 0, "'(' is not closed; add ')'"),
        ("[1, 2, 3", 0, "'[' is not closed; add ']'"),
        ("1 + 2)", 5, "there is no ( before it"),
        ("(1, 2)", 2, "decimal point is written as a dot"),
        ("0,5", 1, "decimal point is written as a dot"),
        ("P1 P2", 3, "multiplication is written with *"),
        ("2(P1)", 1, "multiplication is written with *"),
        ("2 P1", 2, "'P1' is not a unit; a product is written 2*P1"),
        ("5 lb", 2, "lbm for a mass or lbf for a force"),
        ("5 degs", 2, "'degs' is not a unit; did you mean deg"),
        ("12°", 2, "write degrees as deg"),
        ("2 − 1", 2, "minus sign as -"),
        ("1 $ 2", 2, "unexpected character '$'"),
        ("P1 = 2", 3, "an expression has no ="),
        ("a\x00b", 1, "U+0000"),
        ("1e999", 0, "too large"),
        ("1 km^99", 5, "exponent 99 of a unit is too large (limit 24)"),
        ("1 km^20*km^20", 2, "add up to 40 (limit 24)"),
        ("5 in ^ 2", 5, "ambiguous power"),
        ("5 in^2^2", 6, "ambiguous power"),
        ("5 in^n", 4, "ambiguous power"),
        ("5 in^2.5", 4, "ambiguous power"),
        ("5 kg/m^", 6, "ambiguous power"),
        ("sin", 0, "sin is a function; write sin(...)"),
        ("sine(1)", 0, "there is no function sine; did you mean sin"),
        ("atan2(1)", 0, "atan2 takes 2 arguments, not 1; write atan2(y, x)"),
        ("min(1)", 0, "at least 2 arguments, not 1"),
        ("sin()", 0, "sin takes 1 argument, not 0"),
        ("[1]", 0, "three components, in a plane two, not 1"),
        ("(A).w", 3, "there is no component .w"),
    ],
)
def test_text_that_is_no_expression(text: str, offset: int, words: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse(text)
    assert words in str(caught.value)
    assert caught.value.offset == offset


@pytest.mark.parametrize(
    ("text", "offset", "words"),
    [
        (
            "P1 + 0.5",
            5,
            "cannot add a length and a dimensionless number; write the number with a unit: 0.5 in",
        ),
        ("0.5 - P1", 0, "cannot subtract a length from a dimensionless number"),
        ("P1 + alpha", 5, "cannot add a length and an angle; both must be of one kind"),
        ("alpha + n", 8, "multiply it by 1 deg if it is in degrees, by 1 rad"),
        ("P1 - n", 5, "multiply it by 1 in"),
        ("A + P1*B", 0, "cannot add a vector (a dimensionless number) and a vector (a length)"),
        ("A + 1", 2, "cannot add a vector"),
        (
            "cos(12)",
            4,
            "cos takes an angle, not a dimensionless number; write the number with a unit: 12 deg",
        ),
        ("cos(-12)", 5, "12 deg"),
        ("sin(90*180/pi)", 4, "by 1 rad if it is in radians"),
        ("sin(sqrt(pi))", 4, "by 1 rad if it is in radians"),
        ("tan(P1)", 4, "tan takes an angle, not a length"),
        ("exp(P1)", 4, "exp takes a dimensionless number, not a length; divide it by 1 in"),
        ("asin(alpha)", 5, "asin takes a dimensionless number, not an angle"),
        ("wrap(P1)", 5, "wrap takes an angle"),
        ("atan2(P1, alpha)", 10, "cannot take atan2 of a length and an angle"),
        ("max(P1, P2, 1)", 12, "write the number with a unit: 1 in"),
        ("[P1, 0, P2]", 5, "write the number with a unit: 0 in"),
        ("[A, 1, 2]", 1, "takes a number, not a vector"),
        ("A*B", 1, "dot(a, b) or cross(a, b)"),
        ("1/A", 2, "takes a number, not a vector"),
        ("A^2", 0, "a vector has no power"),
        ("abs(A)", 4, "norm(...)"),
        ("norm(P1)", 5, "norm takes a vector, not a length; write a vector as [x, y, z]"),
        ("cross(A, P1)", 9, "cross takes a vector"),
        ("dot(2, B)", 4, "dot takes a vector"),
        ("2*P1.x", 4, ".x takes a component of a vector, not of a length"),
        ("(P1).x", 4, ".x takes a component of a vector"),
        ("P1^n", 3, "whole number that is written as such"),
        ("P1^0.5", 3, "write a root as sqrt(...)"),
        ("P1^17", 3, "the exponent is 17 (limit 16)"),
        ("P1^12*P1^12", 5, "exponent above the limit 16"),
        ("2^P1", 2, "an exponent is a dimensionless number, not a length"),
        ("sqrt(sqrt(P1))", 5, "no square root of a quantity of dimension length^(1/2)"),
        ("1 + 1e300 km^9", 4, "1e300 km^9 is too large"),
        ("1/(P1 - P1)", 3, "division by zero"),
        ("p.velocity/0", 11, "division by zero"),
        ("sqrt(0 - 2)", 5, "square root of a negative number (-2 in SI units)"),
        ("1 + asin(2)", 4, "asin has no finite value for 2"),
        ("1e200*1e200", 5, "* has no finite value for 1e+200, 1e+200"),
        ("(0 - 8)^0.5", 7, "^ has no finite value for -8, 0.5"),
        ("P1 + alhpa", 5, "there is nothing named alhpa; did you mean alpha?"),
        ("2*in", 2, "there is nothing named in; a unit stands right behind a number: 1 in"),
        ("q.x", 0, "there is nothing named q.x"),
        ("O1.thet", 0, "did you mean O1.theta"),
        ("q.position.x", 0, "there is nothing named q.position.x; did you mean p.position"),
        ("10 N*m", 5, "ambiguous: m is a unit and a name of this file"),
        ("1 + 2 s/m", 8, "ambiguous: m is a unit"),
    ],
)
def test_expression_without_a_value(text: str, offset: int, words: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse(text).evaluate(resolve, INCH_POUND)
    assert words in str(caught.value)
    assert caught.value.offset == offset


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1" * 4001, "4001 characters (limit 4000)"),
        ("+".join("1" * 501), "more than 1000 numbers"),
        ("(" * 51 + "1" + ")" * 51, "nested more than 50 deep"),
        ("-" * 4000, "nested more than 50 deep"),
        ("sin(" * 1000, "nested more than 50 deep"),
        ("2^" * 1000, "nested more than 50 deep"),
        ("[" * 4000, "nested more than 50 deep"),
    ],
)
def test_limits(text: str, words: str) -> None:
    with pytest.raises(ExpressionError, match=r"limit|nested|more than") as caught:
        parse(text)
    assert words in str(caught.value)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize(
    ("text", "value"),
    [("+".join("1" * 500), 500.0), ("(" * 49 + "1" + ")" * 49, 1.0), ("-" * 49 + "1", -1.0)],
)
def test_just_within_the_limits(text: str, value: float) -> None:
    assert parse(text).evaluate(resolve).value == value


def test_an_error_of_the_resolver_points_at_the_name() -> None:
    def refuse(name: str) -> Quantity:
        raise ExpressionError(f"{name} is a text", 0, "make it a column of its own")

    with pytest.raises(ExpressionError, match="is a text") as caught:
        parse("1 + row.mode").evaluate(refuse)
    assert caught.value.offset == 4
    assert caught.value.hint == "make it a column of its own"


def test_a_plain_mapping_can_be_the_resolver() -> None:
    values = {"a": Quantity(2.0, DIMENSIONLESS)}
    assert parse("a*a").evaluate(values.__getitem__).value == 4.0
    with pytest.raises(ExpressionError, match="nothing named b"):
        parse("b").evaluate(values.__getitem__)
