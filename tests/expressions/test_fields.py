"""Texts of fields to numbers in SI and in the units of the file."""

from __future__ import annotations

import math

import pytest
from expressions.names import INCH_POUND, resolve

from mechkin_cli.expressions.expression import constant, constant_in_file_units, literal
from mechkin_cli.expressions.quantity import ExpressionError
from mechkin_cli.units.dimension import (
    ANGLE,
    ANGULAR_RATE,
    DIMENSIONLESS,
    LENGTH,
    MASS,
    MOMENT,
    Dimension,
)
from mechkin_cli.units.units import UnitSystem

MILLIMETRE = UnitSystem.from_mapping({"length": "mm"})


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1.0),
        ("-0.5", -0.5),
        ("+.5", 0.5),
        (" 1e-3 ", 0.001),
        ("010", 10.0),
        ("- 4", -4.0),
        ("386.09", 386.09),
    ],
)
def test_literal(text: str, value: float) -> None:
    assert literal(text) == value


@pytest.mark.parametrize(
    "text", ["", "on", "1 2", "0.5 in", "1e", "0x10", "1_000", "nan", ".inf", "--1", "1e999", "٣"]
)
def test_no_literal(text: str) -> None:
    assert literal(text) is None


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("0.5", LENGTH, 0.0127),
        ("-0.5", LENGTH, -0.0127),
        ("0.5 in", LENGTH, 0.0127),
        ("0.5 m", LENGTH, 0.5),
        ("P1*2", LENGTH, 1.0),
        ("alpha*P2", LENGTH, 0.5),
        ("180", ANGLE, math.pi),
        ("0.1", ANGULAR_RATE, 0.1),
        ("1 turn/s", ANGULAR_RATE, math.tau),
        ("2", MASS, 2 * 0.45359237),
        ("cos(0 deg)", DIMENSIONLESS, 1.0),
        ("7", DIMENSIONLESS, 7.0),
    ],
)
def test_constant(text: str, dimension: Dimension, value: float) -> None:
    assert constant(text, dimension, INCH_POUND, resolve) == value


@pytest.mark.parametrize(
    ("text", "units", "dimension", "value"),
    [
        ("192", INCH_POUND, ANGLE, 192.0),
        ("192 deg", INCH_POUND, ANGLE, 192.0),
        ("202.3", INCH_POUND, ANGLE, 202.3),
        ("202.3 deg", INCH_POUND, ANGLE, 202.3),
        ("1.1 turn", INCH_POUND, ANGLE, 1.1 * 360),
        ("-104", INCH_POUND, ANGLE, -104.0),
        ("1.7 in", INCH_POUND, LENGTH, 1.7),
        ("3 ft", INCH_POUND, LENGTH, 36.0),
        ("6 rpm", INCH_POUND, ANGULAR_RATE, math.pi / 5),
        ("0.7 cm", MILLIMETRE, LENGTH, 7.0),
        ("P1", MILLIMETRE, LENGTH, 500.0),
    ],
)
def test_constant_in_file_units(
    text: str, units: UnitSystem, dimension: Dimension, value: float
) -> None:
    assert constant_in_file_units(text, dimension, units, resolve) == value


@pytest.mark.parametrize("function", [constant, constant_in_file_units])
@pytest.mark.parametrize(
    ("text", "dimension", "offset", "words"),
    [
        ("alpha", LENGTH, 0, "expected a length, found an angle; give a value such as 1 in"),
        ("  2*3", LENGTH, 2, "expected a length, found a dimensionless number"),
        ("0*1", LENGTH, 0, "found a dimensionless number; multiply it by 1 in"),
        ("5 in", ANGLE, 0, "expected an angle, found a length; give a value such as 1 deg"),
        ("5 Hz", ANGULAR_RATE, 0, "expected an angular rate, found a frequency"),
        ("P1", DIMENSIONLESS, 0, "expected a dimensionless number, found a length; divide"),
        ("2 N", MOMENT, 0, "expected a moment or energy, found a force"),
        ("p.position", LENGTH, 0, "found a vector (a length); take a component"),
        ("slide.s", LENGTH, 0, "expected a constant, found a value per row"),
        ("1e999", LENGTH, 0, "too large"),
        ("nan", LENGTH, 0, "there is nothing named nan"),
        ("", LENGTH, 0, "empty"),
    ],
)
def test_bad_field(
    function: object, text: str, dimension: Dimension, offset: int, words: str
) -> None:
    with pytest.raises(ExpressionError) as caught:
        function(text, dimension, INCH_POUND, resolve)  # type: ignore[operator]
    assert words in str(caught.value)
    assert caught.value.offset == offset


def test_a_number_too_large_in_si() -> None:
    kilometre = UnitSystem.from_mapping({"length": "km"})
    with pytest.raises(ExpressionError, match="1e308 km is too large"):
        constant("1e308", LENGTH, kilometre)


def test_without_resolver_there_are_no_names() -> None:
    with pytest.raises(ExpressionError, match="nothing named P1"):
        constant("P1", LENGTH, INCH_POUND)
