"""Factors, composition and conversion of units, against definitions written out by hand."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp

from mechkin_cli.units.dimension import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_RATE,
    DAMPING,
    DIMENSIONLESS,
    ENERGY,
    FORCE,
    FREQUENCY,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    POWER,
    STIFFNESS,
    TIME,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
    VELOCITY,
    Dimension,
)
from mechkin_cli.units.units import UnitError, UnitSystem, conversion, parse_unit

INCH_POUND = UnitSystem.from_mapping(
    {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbm*in/s^2"}
)
MILLIMETRE = UnitSystem.from_mapping(
    {"length": "mm", "force": "kN", "time": "ms", "angular_rate": "rpm"}
)


@pytest.mark.parametrize(
    ("text", "factor"),
    [
        ("in", "0.0254"),
        ("ft", "0.3048"),
        ("yd", "0.9144"),
        ("mil", "0.0000254"),
        ("um", "0.000001"),
        ("lbm", "0.45359237"),
        ("oz", "0.028349523125"),
        ("t", "1000"),
        ("lbf", "4.4482216152605"),
        ("ozf", "0.27801385095378125"),
        ("kgf", "9.80665"),
        ("pdl", "0.138254954376"),
        ("dyn", "0.00001"),
        ("lbm*in/s^2", "0.011521246198"),
        ("lbf*s^2/ft", Fraction("4.4482216152605") / Fraction("0.3048")),
        ("slug", Fraction("4.4482216152605") / Fraction("0.3048")),
        ("psi", Fraction("4.4482216152605") / Fraction("0.00064516")),
        ("N*m", "1"),
        ("kg*m^2", "1"),
        ("1/s", "1"),
        ("m/min", Fraction(1, 60)),
        ("km/h", Fraction(5, 18)),
        ("g0", "9.80665"),
        ("in**2", "0.00064516"),
        (" N * mm ", "0.001"),
        ("m*s^-2", "1"),
        ("turn/rev", "1"),
    ],
)
def test_factor_is_the_exact_rational(text: str, factor: str | Fraction) -> None:
    assert parse_unit(text).factor == Fraction(factor)


@pytest.mark.parametrize(
    ("text", "angle"),
    [
        ("deg", lambda: mp.pi / 180),
        ("turn", lambda: 2 * mp.pi),
        ("rev", lambda: 2 * mp.pi),
        ("arcmin", lambda: mp.pi / 10800),
        ("arcsec", lambda: mp.pi / 648000),
        ("rpm", lambda: mp.pi / 30),
        ("deg^2", lambda: (mp.pi / 180) ** 2),
    ],
)
def test_factor_with_pi_is_the_true_value_rounded_once(text: str, angle: object) -> None:
    with mp.workdps(50):
        expected = float(angle())  # type: ignore[operator]
    assert float(parse_unit(text).factor) == expected


@pytest.mark.parametrize(
    ("text", "dimension"),
    [
        ("lbm*in/s^2", FORCE),
        ("N*m/rad", TORSIONAL_STIFFNESS),
        ("J", MOMENT),
        ("W", POWER),
        ("rad/s^2", ANGULAR_ACCELERATION),
        ("rpm", ANGULAR_RATE),
        ("N*s/m", DAMPING),
        ("Hz", FREQUENCY),
        ("in/ft", DIMENSIONLESS),
        ("Pa", Dimension(mass=1, length=-1, time=-2)),
    ],
)
def test_dimension_of_a_unit(text: str, dimension: Dimension) -> None:
    assert parse_unit(text).dimension == dimension


@pytest.mark.parametrize(
    ("text", "offset", "words"),
    [
        ("", 0, "not a unit"),
        ("lb", 0, "lbm for a mass or lbf for a force"),
        ("N*Mm", 2, "did you mean mm"),
        ("inch", 0, "write in"),
        ("N m", 2, "join units with * and /"),
        ("N*", 2, "not a unit"),
        ("/s", 0, "not a unit"),
        ("m*1", 2, "not a unit"),
        ("2*m", 0, "not a unit"),
        ("m^x", 1, "unexpected '^'"),
        ("m^2.5", 3, "unexpected '.'"),
        ("m^999999999", 2, "limit 24"),
        ("m^20*s^20", 0, "add up to 40 (limit 24)"),
        ("m" * 300, 0, "300 characters"),
    ],
)
def test_bad_unit(text: str, offset: int, words: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_unit(text)
    assert caught.value.offset == offset
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("units", "dimension", "label"),
    [
        (UnitSystem(), DIMENSIONLESS, ""),
        (UnitSystem(), ANGLE, "deg"),
        (UnitSystem(), MOMENT, "N*m"),
        (UnitSystem(), POWER, "N*m/s"),
        (UnitSystem(), DAMPING, "N*s/m"),
        (UnitSystem(), TORSIONAL_STIFFNESS, "N*m/rad"),
        (UnitSystem(), TORSIONAL_DAMPING, "N*m*s/rad"),
        (UnitSystem(), INERTIA, "kg*m^2"),
        (UnitSystem(), DIMENSIONLESS / ANGLE, "1/rad"),
        (UnitSystem(), ANGLE**2, "deg^2"),
        (MILLIMETRE, DIMENSIONLESS / ANGLE**2, "1/rad^2"),
        (INCH_POUND, LENGTH, "in"),
        (INCH_POUND, ANGULAR_RATE, "rad/s"),
        (INCH_POUND, ANGULAR_ACCELERATION, "rad/s^2"),
        (INCH_POUND, ACCELERATION, "in/s^2"),
        (INCH_POUND, FORCE, "lbm*in/s^2"),
        (INCH_POUND, ENERGY, "lbm*in^2/s^2"),
        (INCH_POUND, INERTIA, "lbm*in^2"),
        (INCH_POUND, LENGTH**2 * ANGLE / TIME, "in^2/s"),
        (INCH_POUND, LENGTH / ANGLE, "in/rad"),
        (INCH_POUND, LENGTH ** Fraction(1, 2), "in^(1/2)"),
        (MILLIMETRE, VELOCITY, "mm/ms"),
        (MILLIMETRE, ANGULAR_RATE, "rpm"),
        (MILLIMETRE, ANGULAR_ACCELERATION, "rpm/s"),
        (MILLIMETRE, FREQUENCY, "1/ms"),
        (MILLIMETRE, POWER, "kN*mm/ms"),
        (MILLIMETRE, STIFFNESS, "kN/mm"),
        (MILLIMETRE, DAMPING, "kN*ms/mm"),
        (MILLIMETRE, MOMENT * ANGLE, "kN*mm"),
        (MILLIMETRE, MASS, "kg"),
        (MILLIMETRE, TORSIONAL_DAMPING, "kN*mm*s/rad"),
        (MILLIMETRE, TORSIONAL_STIFFNESS, "kN*mm/rad"),
    ],
)
def test_label(units: UnitSystem, dimension: Dimension, label: str) -> None:
    assert units.label(dimension) == label


@pytest.mark.parametrize(
    ("units", "dimension", "factor"),
    [
        (INCH_POUND, MOMENT, Fraction("0.45359237") * Fraction("0.0254") ** 2),
        (INCH_POUND, INERTIA, Fraction("0.45359237") * Fraction("0.0254") ** 2),
        (INCH_POUND, LENGTH ** Fraction(2), Fraction("0.0254") ** 2),
        (INCH_POUND, ANGULAR_RATE, 1),
        (MILLIMETRE, ACCELERATION, 1000),
        (MILLIMETRE, MOMENT, 1),
        (MILLIMETRE, DAMPING, 1000),
    ],
)
def test_factor_of_a_system(
    units: UnitSystem, dimension: Dimension, factor: Fraction | int
) -> None:
    assert units.factor(dimension) == float(factor)


def test_factor_of_a_square_root() -> None:
    with mp.workdps(40):
        expected = float(mp.sqrt(mp.mpf("0.0254")))
    assert INCH_POUND.factor(LENGTH ** Fraction(1, 2)) == expected


def test_same_unit_returns_the_same_object() -> None:
    rows = np.array([0.1, 0.2])
    system = UnitSystem()
    assert system.to_si(rows, LENGTH) is rows
    assert system.from_si(rows, MOMENT) is rows


@pytest.mark.parametrize("written", ["0.1", "0.3", "12.7", "192.4", "1e-7"])
def test_metric_conversion_is_correctly_rounded(written: str) -> None:
    """A quotient by 1000 is rounded once; the double 0.001 would be rounded beforehand."""
    value = float(written)
    exact = Fraction(value) / 1000
    assert MILLIMETRE.to_si(value, LENGTH) == float(exact)


def test_rows_and_numbers_convert_to_the_same_bits() -> None:
    values = [0.1, 37.231, -104.0, 202.0]
    rows = INCH_POUND.from_si(np.array(values), ANGLE)
    assert rows.tolist() == [INCH_POUND.from_si(value, ANGLE) for value in values]


@pytest.mark.parametrize("factor", [Fraction(10) ** 400, Fraction(10) ** -400])
def test_factor_out_of_range(factor: Fraction) -> None:
    with pytest.raises(UnitError, match="outside the range"):
        conversion(factor)


@pytest.mark.parametrize(
    ("texts", "key", "words"),
    [
        ({"length": "deg"}, "length", "measures an angle; give a unit of a length, such as m"),
        ({"force": "lbm"}, "force", "measures a mass"),
        ({"angular_rate": "deg"}, "angular_rate", "give a unit of an angular rate, such as rad/s"),
        ({"length": "1"}, "length", "measures a dimensionless number"),
        ({"mass": "lb"}, "mass", "lbm for a mass"),
        ({"time": "qqq"}, "time", "units of a time are s, ms, min, h"),
        ({"lenght": "in"}, "lenght", "entries are length, angle, mass, force, time"),
        ({"length": "km^12/m^11"}, "length", "1e+36 in SI (limit 1e+30"),
    ],
)
def test_bad_system(texts: dict[str, str], key: str, words: str) -> None:
    with pytest.raises(UnitError) as caught:
        UnitSystem.from_mapping(texts)
    assert caught.value.key == key
    assert words in str(caught.value)


def test_entries_left_out_keep_their_defaults() -> None:
    assert UnitSystem.from_mapping({"length": "m", "angle": None}) == UnitSystem()


@pytest.mark.parametrize(
    ("left", "right", "compatible"),
    [
        (LENGTH * ANGLE, LENGTH, True),
        (MOMENT * ANGLE, ENERGY, True),
        (LENGTH * ANGULAR_RATE**2, ACCELERATION, True),
        (INERTIA * ANGULAR_RATE**2, ENERGY, True),
        (INERTIA * ANGULAR_ACCELERATION, MOMENT, True),
        (TORSIONAL_STIFFNESS * ANGLE, MOMENT, True),
        (ANGLE, DIMENSIONLESS, False),
        (ANGULAR_RATE, FREQUENCY, False),
        (VELOCITY / LENGTH, ANGULAR_RATE, False),
        (LENGTH / ANGLE, LENGTH, False),
        (TORSIONAL_STIFFNESS, MOMENT, False),
        (MASS * ANGLE, MASS, False),
    ],
)
def test_angle_counts_except_in_arcs_and_work(
    left: Dimension, right: Dimension, compatible: bool
) -> None:
    assert left.compatible(right) is compatible
    assert right.compatible(left) is compatible


@pytest.mark.parametrize(
    ("dimension", "phrase"),
    [
        (LENGTH, "a length"),
        (LENGTH * ANGLE, "a length"),
        (ANGULAR_RATE, "an angular rate"),
        (LENGTH**4 / TIME, "a quantity of dimension length^4/time"),
        (TIME**-3, "a quantity of dimension 1/time^3"),
    ],
)
def test_phrase(dimension: Dimension, phrase: str) -> None:
    assert dimension.phrase == phrase
