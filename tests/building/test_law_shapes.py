"""Rises of cams and oscillations against their definitions: the acceleration, integrated twice at
40 digits; tables of textbooks to their digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk
from mechkin_cli.mechanism.motion import DrivenInput

FILE = """format: 1
units: {length: mm}
links: {a: {}}
joints: {O: {type: P, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
motion:
  time: {from: 0, to: 60, ROWS}
  inputs: {O.s: {law: LAW, KEYS}}
"""
Numbers = Callable[[Any], Any]


def driven(law: str, keys: str, rows: str) -> DrivenInput:
    text = FILE.replace("LAW", law).replace("KEYS", keys).replace("ROWS", rows)
    return mk.loads(text).problem.motion.inputs[0]


def modified_sine(u: Any) -> Any:
    largest = 4 * mp.pi**2 / (4 + mp.pi)
    if u > mp.mpf(1) / 2:
        return -modified_sine(1 - u)
    if u <= mp.mpf(1) / 8:
        return largest * mp.sin(4 * mp.pi * u)
    return largest * mp.sin(4 * mp.pi * u / 3 + mp.pi / 3)


def modified_trapezoid(u: Any) -> Any:
    largest = 8 * mp.pi / (2 + mp.pi)
    if u > mp.mpf(1) / 2:
        return -modified_trapezoid(1 - u)
    if u <= mp.mpf(1) / 8:
        return largest * mp.sin(4 * mp.pi * u)
    return largest if u <= mp.mpf(3) / 8 else largest * mp.sin(4 * mp.pi * u - mp.pi)


# the acceleration of a rise from 0 to 1 over u from 0 to 1, and the places where it bends
ACCELERATIONS: dict[str, tuple[Numbers, list[Any]]] = {
    "harmonic": (lambda u: mp.pi**2 / 2 * mp.cos(mp.pi * u), []),
    "cycloidal": (lambda u: 2 * mp.pi * mp.sin(2 * mp.pi * u), []),
    "3-4-5": (lambda u: 60 * u - 180 * u**2 + 120 * u**3, []),
    "4-5-6-7": (lambda u: 420 * u**2 - 1680 * u**3 + 2100 * u**4 - 840 * u**5, []),
    "modified-sine": (modified_sine, [1, 7]),
    "modified-trapezoid": (modified_trapezoid, [1, 3, 5, 7]),
}


def true_orders(law: str, u: Any) -> list[Any]:
    """Value and three derivatives of the rise from 0 to 1 at u, not where it bends."""
    acceleration, bends = ACCELERATIONS[law]
    to = [mp.mpf(0), *(mp.mpf(k) / 8 for k in bends if mp.mpf(k) / 8 < u), u]
    rate = mp.quad(acceleration, to)
    value = mp.quad(lambda t: (u - t) * acceleration(t), to)
    return [value, rate, acceleration(u), mp.diff(acceleration, u)]


@pytest.mark.parametrize("law", ACCELERATIONS)
def test_a_rise_is_its_acceleration_integrated_twice(law: str) -> None:
    found = driven(law, "from: -3, to: 17.3, start: 7, duration: 41", "step: 0.75").written_orders
    times = [0.75 * k for k in range(81)]
    rise = mp.mpf("20.3")
    with mp.workdps(40):
        for k, time in enumerate(times):
            u = (mp.mpf(time) - 7) / 41
            if u < 0 or u > 1:
                expected = [-3 if u < 0 else mp.mpf("17.3"), 0, 0, 0]
            else:
                orders = true_orders(law, u)
                expected = [rise * order / mp.mpf(41) ** n for n, order in enumerate(orders)]
                expected[0] -= 3
            for n, size in enumerate((1, 2, 8, 80)):
                near = 4e-15 * size * float(rise) / 41**n
                assert abs(found[n, k] - expected[n]) <= near, (time, n)


@pytest.mark.parametrize("law", ACCELERATIONS)
def test_a_rise_leaves_and_reaches_its_ends_exactly(law: str) -> None:
    orders = driven(law, "from: 10, to: 100.1, start: 7, duration: 35", "step: 1").written_orders
    assert set(orders[0, :8]) == {10.0}
    assert set(orders[0, 42:]) == {100.1}
    assert not orders[1, :8].any()
    assert not orders[1, 42:].any()
    assert not orders[:, 43:][1:].any()
    assert orders[0, 7 + 17] + orders[0, 7 + 18] == pytest.approx(110.1, rel=1e-15)
    assert (np.diff(orders[0, 7:43]) > 0.0).all()


# R. L. Norton, Cam Design and Manufacturing Handbook, table 3-1: largest velocity, acceleration
# and jerk, the last two of the modified sine and trapezoid from their closed forms
PEAKS = {
    "cycloidal": (2.0, 6.2832, 39.478),
    "3-4-5": (1.875, 5.7735, 60.0),
    "4-5-6-7": (2.1875, 7.5132, 52.5),
    "modified-sine": (1.7596, 5.5280, 69.466),
    "modified-trapezoid": (2.0, 4.8881, 61.426),
}


@pytest.mark.parametrize("law", PEAKS)
def test_largest_rates_of_textbooks(law: str) -> None:
    orders = driven(law, "from: 0, to: 20", "count: 6001").written_orders
    for n, (peak, digits) in enumerate(zip(PEAKS[law], (4, 4, 3), strict=True), start=1):
        assert np.abs(orders[n]).max() * 60.0**n / 20.0 == pytest.approx(
            peak, abs=0.6 * 0.1**digits
        )


# a rise of 20 mm over 60 deg at 5, 10 and 30 deg: displacement in mm, velocity in mm/deg,
# acceleration in mm/deg^2
TABLES = {
    "cycloidal": (
        (5, 0.075117, 0.044658, 0.017453),
        (10, 0.576689, 0.166667, 0.030230),
        (30, 10.0, 0.666667, 0.0),
    ),
    "3-4-5": (
        (5, 0.101755, 0.058353, 0.021219),
        (10, 0.709877, 0.192901, 0.030864),
        (30, 10.0, 0.625, 0.0),
    ),
    "modified-sine": (
        (5, 0.126843, 0.073317, 0.026596),
        (30, 10.0, 0.586534, 0.0),
    ),
}


@pytest.mark.parametrize("law", TABLES)
def test_tables_of_textbooks(law: str) -> None:
    orders = driven(law, "from: 0, to: 20", "step: 5").written_orders
    for at, *row in TABLES[law]:
        assert orders[:3, at // 5].tolist() == pytest.approx(row, abs=0.6e-6)


SINES = [
    ("amplitude: 7, frequency: 0.3 Hz", 7, 0.3, lambda t: 7 * mp.sin(mp.mpf("0.6") * mp.pi * t)),
    (
        "amplitude: -2 cm, period: 7, phase: 30 deg, offset: 4",
        20,
        1 / 7,
        lambda t: 4 - 20 * mp.sin(2 * mp.pi * t / 7 + mp.pi / 6),
    ),
    (
        "amplitude: 1, frequency: 17/(1 min), phase: -1 rad",
        1,
        17 / 60,
        lambda t: mp.sin(mp.pi * 17 * t / 30 - 1),
    ),
]


@pytest.mark.parametrize(("keys", "amplitude", "frequency", "closed_form"), SINES)
def test_a_sine_and_its_derivatives(
    keys: str, amplitude: float, frequency: float, closed_form: Numbers
) -> None:
    found = driven("sine", keys, "step: 1.5").written_orders
    # the argument is rounded to parts of itself
    argument = 2.0 * np.pi * frequency * 60.0
    near = [2e-16 * (argument + 4.0) * amplitude * (2.0 * np.pi * frequency) ** n for n in range(4)]
    with mp.workdps(40):
        for k in range(41):
            series = mp.taylor(closed_form, mp.mpf(1.5 * k), 3)
            for n, one in enumerate(series):
                assert abs(found[n, k] - one * mp.factorial(n)) <= near[n] + 1e-15 * (n == 0)


EXPRESSIONS = [
    ("20 mm*sin(360 deg*time/(7 s))", lambda t: 20 * mp.sin(2 * mp.pi * t / 7)),
    ("20 mm*sin(2*pi*time/(7 s))", lambda t: 20 * mp.sin(2 * mp.pi * t / 7)),
    (
        "3 mm*exp(-time/(20 s))*cos(0.3 rad/s*time) + 1 mm",
        lambda t: 3 * mp.exp(-t / 20) * mp.cos(mp.mpf("0.3") * t) + 1,
    ),
    ("5 mm/(1 + (time/(9 s) - 2)^2)", lambda t: 5 / (1 + (t / 9 - 2) ** 2)),
    ("sqrt(time/(1 s) + 1)*1 mm", lambda t: mp.sqrt(t + 1)),
]


@pytest.mark.parametrize(("value", "closed_form"), EXPRESSIONS)
def test_an_expression_and_its_derivatives(value: str, closed_form: Numbers) -> None:
    found = driven("expression", f'value: "{value}"', "step: 1.5").written_orders
    with mp.workdps(40):
        for k in range(41):
            series = mp.taylor(closed_form, mp.mpf(1.5 * k), 3)
            expected = [float(one * mp.factorial(n)) for n, one in enumerate(series)]
            # the sine's argument, up to 54 rad, is rounded to parts of itself
            assert found[:, k] == pytest.approx(expected, rel=2e-14, abs=2e-13)


def test_an_expression_without_time_rests() -> None:
    for value in ("3 cm", "30", '"half*2"'):
        text = FILE.replace("links:", "parameters: {half: 15 mm}\nlinks:", 1).replace(
            "LAW", "expression"
        )
        model = mk.loads(text.replace("KEYS", f"value: {value}").replace("ROWS", "step: 10"))
        orders = model.problem.motion.inputs[0].written_orders
        assert orders[0].tolist() == [30.0] * 7
        assert not orders[1:].any()


def test_rows_between_which_an_expression_bends_see_its_bend() -> None:
    """A block pushed forth and back by |t - 31 s|: it turns between two rows."""
    text = FILE.replace("LAW", "expression").replace("KEYS", 'value: "1 mm/s*abs(time - 31 s)"')
    course = mk.loads(text.replace("ROWS", "step: 20")).problem.motion.course
    assert course is not None
    assert course.edges.tolist() == pytest.approx([0.0, 31.0, 60.0], abs=1e-12)


BAD = [
    ("sine", "amplitude: 1", "missing-key", "a frequency or a period"),
    ("sine", "amplitude: 1, period: 1, frequency: 1", "two-choices", "keep one"),
    ("sine", "amplitude: 1, period: -2", "no-period", "the period of a sine is positive: -2 s"),
    ("sine", "amplitude: 1, frequency: 0", "no-period", "the frequency of a sine is positive"),
    ("sine", "amplitude: 1, frequency: 3 rpm", "expression", "expected a frequency"),
    ("sine", "amplitude: 1 deg, period: 1", "expression", "expected a length"),
    ("sine", "amplitude: 1, period: 1, omega: 3", "unknown-key", "write frequency: 2 Hz"),
    ("sine", "amplitude: 1, period: 1, mean: 3", "unknown-key", "write offset: 5 deg"),
    ("cycloidal", "from: 0, to: 1, beta: 2 s", "unknown-key", "write duration: 0.5 s"),
    ("modified-sine", "from: 0, to: 1, begin: 2 s", "unknown-key", "write start: 0.1 s"),
    ("expression", "value: 0, formula: time", "unknown-key", "write value: 20 mm*time/(1 s)"),
    ("3-4-5", "from: 0, to: 1, duration: -1", "no-duration", "a positive time"),
    ("expression", 'value: "time"', "expression", "expected a length, found a time"),
    ("expression", 'value: "1 mm*sin(2*time/(1 s))"', "expression", "by 1 rad if it is in rad"),
    ("expression", 'value: "1 mm*tiem/(1 s)"', "expression", "an expression of time"),
    ("expression", 'value: "2*O.s"', "expression", "{with: ...} follows other inputs"),
    ("expression", 'value: "2 mm*("', "expression", ""),
    (
        "expression",
        'value: "1 mm*sqrt(time/(1 s) - 3)"',
        "undefined-value",
        "O.s has no finite value in row 1: time = 0 s; write an expression that is smooth",
    ),
    (
        "expression",
        'value: "1 mm*sqrt(time/(1 s))"',
        "undefined-rate",
        "O.s has no finite rate in row 1: time = 0 s",
    ),
]


@pytest.mark.parametrize("bad", BAD, ids=[f"{law} {keys}" for law, keys, *_ in BAD])
def test_bad_laws(bad: tuple[str, ...]) -> None:
    law, keys, code, words = bad
    with pytest.raises(mk.InvalidFile) as caught:
        driven(law, keys, "step: 1")
    (error,) = caught.value.diagnostics
    assert error.code == code
    assert error.place is not None
    assert error.place.line == 7
    assert words in str(error)
