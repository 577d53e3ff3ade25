"""Values and dimensions of expressions, against numbers worked out by hand or by mpmath."""

from __future__ import annotations

import math

import numpy as np
import pytest
from expressions.names import resolve
from mpmath import mp

from mechkin_cli.expressions.expression import parse
from mechkin_cli.expressions.quantity import Rows, Vector
from mechkin_cli.units.dimension import (
    ACCELERATION,
    ANGLE,
    AREA,
    DIMENSIONLESS,
    ENERGY,
    FORCE,
    LENGTH,
    MASS,
    MOMENT,
    POWER,
    TORSIONAL_STIFFNESS,
    VELOCITY,
    VOLUME,
    Dimension,
)


@pytest.mark.parametrize(
    ("text", "value", "dimension"),
    [
        ("1", 1.0, DIMENSIONLESS),
        (".5", 0.5, DIMENSIONLESS),
        ("5.", 5.0, DIMENSIONLESS),
        ("1e-3", 0.001, DIMENSIONLESS),
        ("010", 10.0, DIMENSIONLESS),
        ("+2", 2.0, DIMENSIONLESS),
        ("cos(pi)", -1.0, DIMENSIONLESS),
        ("sin(2*pi*(3 s)/(8 s) - pi/4)", 1.0, DIMENSIONLESS),
        ("tan(-(pi/4) + 0*(4/pi))", -1.0, DIMENSIONLESS),
        ("1 + 2*3", 7.0, DIMENSIONLESS),
        ("(1 + 2)*3", 9.0, DIMENSIONLESS),
        ("8/4/2", 1.0, DIMENSIONLESS),
        ("8 - 4 - 2", 2.0, DIMENSIONLESS),
        ("2 - -3", 5.0, DIMENSIONLESS),
        ("-2^2", -4.0, DIMENSIONLESS),
        ("(-2)^2", 4.0, DIMENSIONLESS),
        ("2^-1", 0.5, DIMENSIONLESS),
        ("2**3", 8.0, DIMENSIONLESS),
        ("2^3^2", 512.0, DIMENSIONLESS),
        ("n^0.5", 2.0, DIMENSIONLESS),
        ("pow(n, 3)", 64.0, DIMENSIONLESS),
        ("-n*2", -8.0, DIMENSIONLESS),
        ("\n 1 \n\t+ 1 ", 2.0, DIMENSIONLESS),
        ("pi", math.pi, DIMENSIONLESS),
        ("0.5 in", 0.0127, LENGTH),
        ("0.5in", 0.0127, LENGTH),
        ("-0.5 in", -0.0127, LENGTH),
        ("10 N*mm", 0.01, MOMENT),
        ("3 kg*mm/s^2", 0.003, FORCE),
        ("3 kg*mm*s^-2", 0.003, FORCE),
        ("5 mm^2", 5e-6, AREA),
        ("(5 mm)^2", 0.005 * 0.005, AREA),
        ("1 turn/s", math.tau, ANGLE / Dimension(time=1)),
        ("P1 + 1 m", 1.5, LENGTH),
        ("2*P1", 1.0, LENGTH),
        ("3*m", 9.0, MASS),
        ("2 N * m", 6.0, FORCE * MASS),
        ("2 m/P2", 1.0, DIMENSIONLESS),
        ("P1/P2", 0.25, DIMENSIONLESS),
        ("P2^3", 8.0, VOLUME),
        ("P2^-1", 0.5, LENGTH**-1),
        ("P2^0", 1.0, DIMENSIONLESS),
        ("sqrt(P1*P2)", 1.0, LENGTH),
        ("abs(-P1)", 0.5, LENGTH),
        ("sign(-P1)", -1.0, DIMENSIONLESS),
        ("sign(P1 - P1) + sign(P2)", 1.0, DIMENSIONLESS),
        ("min(P1, P2, 1 m)", 0.5, LENGTH),
        ("max(P1, P2, 1 m)", 2.0, LENGTH),
        ("alpha*P2", 0.5, LENGTH * ANGLE),
        ("alpha*P2 + P1", 1.0, LENGTH),
        ("alpha*P2/P2", 0.25, ANGLE),
        ("2 N*1 m*alpha + 1 J", 1.5, ENERGY),
        ("8 N/rad*P1*alpha", 1.0, FORCE * LENGTH),
        ("(2 N*1 m)/alpha", 8.0, TORSIONAL_STIFFNESS),
        ("alpha/1 rad", 0.25, DIMENSIONLESS),
        ("(3 rad/s)^2*P2 + 1 m/s^2", 19.0, ACCELERATION),
        ("wrap(alpha)", 0.25, ANGLE),
        ("wrap(180 deg)", math.pi, ANGLE),
        ("wrap(-180 deg)", math.pi, ANGLE),
        ("wrap(1 rad*pi*0)", 0.0, ANGLE),
        ("dot(A, B)", 6.0, DIMENSIONLESS),
        ("cross(A, B).x", 2.5, DIMENSIONLESS),
        ("cross(A, B).y", -5.0, DIMENSIONLESS),
        ("cross(A, B).z", 2.5, DIMENSIONLESS),
        ("det(A, B, C)", 5.0, DIMENSIONLESS),
        ("det([1, 0, 0], [0, 1, 0], [0, 0, 1])", 1.0, DIMENSIONLESS),
        ("norm(p.position)", 13.0, LENGTH),
        ("p.position.y", 4.0, LENGTH),
        ("(2*p.position - p.position/2).z", 18.0, LENGTH),
        ("(-A).x", -1.0, DIMENSIONLESS),
        ("[1, 2 + 1, 4].y", 3.0, DIMENSIONLESS),
        ("(A*P1).z", 1.5, LENGTH),
        ("A.z", 3.0, DIMENSIONLESS),
        ("E1.x", 7.0, LENGTH),
    ],
)
def test_constant(text: str, value: float, dimension: Dimension) -> None:
    quantity = parse(text).evaluate(resolve)
    assert quantity.value == value
    assert quantity.dimension == dimension


@pytest.mark.parametrize(
    ("text", "rows", "dimension"),
    [
        ("O1.theta_dot", [8.0, 2.0], ANGLE / Dimension(time=1)),
        ("O1.effort*O1.theta_dot + 1 W", [13.0, -1.0], POWER),
        ("O1.effort*O1.theta_dot/(2 W)", [6.0, -1.0], DIMENSIONLESS),
        ("O1.effort*O1.theta_dot/(2 W*rad)", [6.0, -1.0], DIMENSIONLESS),
        ("O1.effort*O1.theta_dot/(O1.effort*2)", [4.0, 1.0], ANGLE / Dimension(time=1)),
        ("P1*O1.theta/P1", [0.5, -4.0], ANGLE),
        ("p.velocity.x", [1.0, 2.0], VELOCITY),
        ("dot(p.velocity, p.velocity)", [5.0, 20.0], VELOCITY**2),
        ("(2*p.velocity + p.velocity).z", [6.0, 12.0], VELOCITY),
        ("P1*O1.theta", [0.25, -2.0], LENGTH * ANGLE),
        ("min(O1.theta, 0 deg)", [0.0, -4.0], ANGLE),
        ("max(0 deg, O1.theta)", [0.5, 0.0], ANGLE),
        ("abs(O1.theta)", [0.5, 4.0], ANGLE),
        ("sign(O1.theta)", [1.0, -1.0], DIMENSIONLESS),
        ("cross(O3.force, [0, 1, 0]).z", [6.0, 0.0], FORCE),
        ("n^(O1.theta/1 rad)", [2.0, 0.00390625], DIMENSIONLESS),
        ("(O1.theta_dot/2)^2", [16.0, 1.0], (ANGLE / Dimension(time=1)) ** 2),
    ],
)
def test_rows(text: str, rows: list[float], dimension: Dimension) -> None:
    quantity = parse(text).evaluate(resolve)
    assert isinstance(quantity.value, np.ndarray)
    assert quantity.value.tolist() == rows
    assert quantity.dimension == dimension


def test_vector_value() -> None:
    quantity = parse("[P1, P2, 1 m] + p.position").evaluate(resolve)
    assert isinstance(quantity.value, Vector)
    assert quantity.value.components == (3.5, 6.0, 13.0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("sin(12 deg)", lambda: mp.sin(mp.pi / 15)),
        ("cos(12 deg)", lambda: mp.cos(mp.pi / 15)),
        ("tan(0.25 rad)", lambda: mp.tan(mp.mpf("0.25"))),
        ("asin(0.25)", lambda: mp.asin(mp.mpf("0.25"))),
        ("acos(0.25)", lambda: mp.acos(mp.mpf("0.25"))),
        ("atan(0.25)", lambda: mp.atan(mp.mpf("0.25"))),
        ("atan2(P1, -P2)", lambda: mp.atan2(mp.mpf("0.5"), -2)),
        ("exp(0.25)", lambda: mp.exp(mp.mpf("0.25"))),
        ("log(0.25)", lambda: mp.log(mp.mpf("0.25"))),
        ("0.25^0.75", lambda: mp.mpf("0.25") ** mp.mpf("0.75")),
    ],
)
def test_transcendental_functions(text: str, expected: object) -> None:
    with mp.workdps(40):
        value = float(expected())  # type: ignore[operator]
    assert parse(text).evaluate(resolve).value == pytest.approx(value, rel=4.5e-16, abs=0)


@pytest.mark.parametrize("turns", [-3_000_000, -7, -1, 1, 2, 1000, 2_000_001])
@pytest.mark.parametrize("remainder", [-3.0, -0.5, 0.0, 1.0, 3.125])
def test_wrap_takes_off_whole_turns(turns: int, remainder: float) -> None:
    with mp.workdps(40):
        angle = float(2 * mp.pi * turns + mp.mpf(remainder))
        expected = float(mp.mpf(angle) - 2 * mp.pi * turns)
    wrapped = parse(f"wrap({angle!r} rad)").evaluate(resolve).value
    assert wrapped == pytest.approx(expected, rel=0, abs=5e-16)


@pytest.mark.parametrize(
    "text", ["wrap(O1.theta)", "sqrt(O1.theta)", "O1.theta^2", "sin(O1.theta)"]
)
def test_a_row_alone_has_the_bits_that_it_has_among_others(text: str) -> None:
    expression = parse(text)
    values = np.array([0.1, 3.7, 9.4, 200.125])
    together = _with_theta(values, expression)
    assert [_with_theta(values[i : i + 1], expression)[0] for i in range(4)] == together.tolist()


def _with_theta(values: Rows, expression: object) -> Rows:
    from mechkin_cli.expressions.quantity import Quantity, lookup

    quantity = expression.evaluate(lookup({"O1.theta": Quantity(values, ANGLE)}))  # type: ignore[attr-defined]
    assert isinstance(quantity.value, np.ndarray)
    return quantity.value


@pytest.mark.parametrize(
    ("text", "finite"),
    [
        ("1 m/slide.s", [True, False]),
        ("slide.s/(0 m)", [False, False]),
        ("sqrt(O1.theta)", [True, False]),
        ("log(slide.s/1 m)", [True, False]),
        ("acos(O1.theta/1 rad)", [True, False]),
        ("min(1 m/slide.s - 1 m/slide.s, 1)", [True, False]),
        ("min(1, 1 m/slide.s - 1 m/slide.s)", [True, False]),
        ("(O3.force/slide.s).x", [True, False]),
    ],
)
def test_rows_outside_a_domain_are_not_finite(
    text: str, finite: list[bool], recwarn: pytest.WarningsRecorder
) -> None:
    value = parse(text).evaluate(resolve).value
    assert not isinstance(value, Vector)
    assert np.isfinite(value).tolist() == finite
    assert not recwarn.list


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("2*P1 + sin(alpha)*P1", {"P1", "alpha"}),
        ("det(O3.force, C, D)/det(B, C, D)", {"O3.force", "B", "C", "D"}),
        ("pm1.position.x + B.x", {"pm1.position", "B.x"}),
        ("cross(a, b).x - 10 N*m", {"a", "b"}),
        ("O1.theta.effort", {"O1.theta.effort"}),
        ("2*pi", set()),
    ],
)
def test_names(text: str, names: set[str]) -> None:
    assert parse(text).names == names


def test_units_may_be_names_of_parameters_elsewhere() -> None:
    """`m` is 3 kg here: behind a number it is the metre, as a name it is the parameter."""
    assert parse("2 m").evaluate(resolve).dimension == LENGTH
    assert parse("2*m").evaluate(resolve).dimension == MASS
