"""Rows of inputs as the text says them, with their rates, against closed forms at 80 digits."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from session.tapes import STEMS, model, mp

import mechkin_cli as mk
from mechkin_cli.proofs.boxes import input_rounding
from mechkin_cli.session.double_double import PreciseInputs, enclosed_inputs, precise_inputs
from mechkin_cli.tape.exact import ExactRows

DEGREE = mp.pi / 180
ORDERS = ("values", "rates", "accelerations", "jerks")

ARM = """
format: 1
units: {{length: mm, time: {time}}}
parameters: {{a: 0.7, speed: 33.3 rpm, half: 90 deg}}
links: {{arm: {{}}, slide: {{}}}}
joints:
  O: {{type: R, links: [ground, arm], point: [0, 0, 0], axis: [0, 0, 1]}}
  Q: {{type: P, links: [arm, slide], point: [1, 0, 0], axis: [1, 0, 0]}}
motion:
{motion}
"""


def inputs_of(motion: str, time: str = "s", folder: Path | None = None) -> PreciseInputs:
    text = ARM.format(motion=motion, time=time)
    if folder is None:
        made = mk.loads(text)
    else:
        file = folder / "arm.yaml"
        file.write_text(text, encoding="utf-8")
        made = mk.load(file)
    return made.session.precise.inputs(made.session)


def jets(function: Callable[[Any], Any], at: Any) -> list[Any]:
    """Value and three derivatives; differences at 200 digits lose none that matter."""
    with mp.workdps(200):
        series = mp.taylor(function, mp.mpf(at), 3)
        return [mp.factorial(k) * one for k, one in enumerate(series)]


def agree(found: PreciseInputs, number: int, row: int, true: list[Any], unit: Any = 1) -> None:
    for name, one in zip(ORDERS, true, strict=True):
        high, low = getattr(found, name)[number, :, row]
        scale = max(abs(one / unit), mp.mpf(1))
        assert abs(mp.mpf(high) + mp.mpf(low) - one / unit) <= mp.mpf(10) ** -29 * scale, name


def test_degrees_of_a_turn_are_whole() -> None:
    found = inputs_of("  inputs: {O.theta: {from: 0, to: 360, step: 1}, Q.s: {at: 0.3}}")
    for row in range(361):
        agree(found, 0, row, [row * DEGREE, 0, 0, 0])
        assert found.written["O.theta"][:, row].tolist() == [row, 0.0]


SWEPT = [
    ("{from: 0.1, to: 77.7, count: 13}", lambda k: mp.mpf("0.1") + k * mp.mpf("77.6") / 12, 13),
    ("{from: 5, to: -3, step: 0.7}", lambda k: 5 - k * mp.mpf("0.7"), 12),
    ("{from: half/3, to: 0.7 rad, count: 4}", lambda k: 30 + k * (70 / DEGREE / 100 - 30) / 3, 4),
    ("{values: [10, 0.2 rad, (1 turn)/3]}", lambda k: [10, 1 / DEGREE / 5, 120][k], 3),
    ("{at: asin(0.3)}", lambda k: mp.asin(mp.mpf("0.3")) / DEGREE, 1),
]


@pytest.mark.parametrize(("text", "degrees", "rows"), SWEPT)
def test_rows_of_their_own(text: str, degrees: Callable[[int], Any], rows: int) -> None:
    rate = "rate: 33.3 rpm, acceleration: 0.1, jerk: 1e-3 rad/s^3}"
    motion = f"  inputs: {{O.theta: {text[:-1]}, {rate}, Q.s: {{at: 1 in, rate: 0.1 in/s}}}}"
    found = inputs_of(motion)
    assert found.values.shape == (2, 2, rows)
    made = mk.loads(ARM.format(motion=motion, time="s"))
    length = made.session.layout.length
    for row in range(rows):
        rates = [mp.mpf("33.3") * mp.pi / 30, mp.mpf("0.1"), mp.mpf("0.001")]
        agree(found, 0, row, [degrees(row) * DEGREE, *rates])
        inch = mp.mpf("0.0254")
        agree(found, 1, row, [inch, inch / 10, 0, 0], mp.mpf(length))


LAWS = [
    ("{law: constant-rate, at: 5, rate: speed}", lambda t: 5 * DEGREE + t * mp.mpf("1.11") * mp.pi),
    (
        "{law: constant-acceleration, at: 0.1 rad, rate: 0.2, acceleration: 0.3}",
        lambda t: (1 + 2 * t + mp.mpf("1.5") * t * t) / 10,
    ),
    (
        "{law: polynomial, coefficients: [1, 2 deg/s, 0.3 deg/s^2, 1/30 * 1 deg/s^3]}",
        lambda t: DEGREE * (1 + 2 * t + mp.mpf("0.3") * t**2 + t**3 / 30),
    ),
    (
        "{law: harmonic, from: 3, to: 40, start: 0, duration: 2.1 s}",
        lambda t: DEGREE * (3 + 37 * (1 - mp.cos(mp.pi * t / mp.mpf("2.1"))) / 2),
    ),
    (
        "{law: cycloidal, from: 3, to: -40.1, start: 0, duration: 2.1 s}",
        lambda t: (
            DEGREE
            * (
                3
                - mp.mpf("43.1")
                * (t / mp.mpf("2.1") - mp.sin(2 * mp.pi * t / mp.mpf("2.1")) / (2 * mp.pi))
            )
        ),
    ),
    (
        "{law: 3-4-5, from: 3, to: 40, start: 0, duration: 2.1 s}",
        lambda t: DEGREE * (3 + 37 * powers(t / mp.mpf("2.1"), 0, 0, 0, 10, -15, 6)),
    ),
    (
        "{law: 4-5-6-7, from: 3, to: 40, start: 0, duration: 2.1 s}",
        lambda t: DEGREE * (3 + 37 * powers(t / mp.mpf("2.1"), 0, 0, 0, 0, 35, -84, 70, -20)),
    ),
    (
        "{law: modified-sine, from: 3, to: 40, start: -4 s, duration: 9 s}",
        lambda t: DEGREE * (3 + 37 * slow_sine((t + 4) / 9)),
    ),
    (
        "{law: modified-trapezoid, from: 3, to: 40, start: -1.2 s, duration: 9 s}",
        lambda t: DEGREE * (3 + 37 * flat((t + mp.mpf("1.2")) / 9)),
    ),
    (
        '{law: expression, value: "0.7 deg*exp(-time/(3 s)) + 1.1 rad/s*time"}',
        lambda t: mp.mpf("0.7") * DEGREE * mp.exp(-t / 3) + mp.mpf("1.1") * t,
    ),
    (
        "{law: sine, amplitude: 0.7, frequency: 0.3 Hz, phase: 25, offset: 4}",
        lambda t: DEGREE * (4 + mp.mpf("0.7") * mp.sin(mp.mpf("0.6") * mp.pi * t + 25 * DEGREE)),
    ),
]


def powers(u: Any, *coefficients: int) -> Any:
    """The polynomial of u."""
    return sum(c * u**k for k, c in enumerate(coefficients))


def slow_sine(u: Any) -> Any:
    """The middle of a modified sine as Norton's handbook has it."""
    return (2 + mp.pi * u - mp.mpf(9) / 4 * mp.sin(mp.pi / 3 + 4 * mp.pi * u / 3)) / (4 + mp.pi)


def flat(u: Any) -> Any:
    """The stretch of constant acceleration of a modified trapezoid; there the largest acceleration
    is 8 pi/(2 + pi), from a quarter of a sine over an eighth."""
    largest = 8 * mp.pi / (2 + mp.pi)
    rate, value = largest / (4 * mp.pi), largest / (4 * mp.pi) * (mp.mpf(1) / 8 - 1 / (4 * mp.pi))
    w = u - mp.mpf(1) / 8
    return value + rate * w + largest * w * w / 2


@pytest.mark.parametrize(("law", "function"), LAWS)
@pytest.mark.parametrize(("time", "step"), [("s", "0.3"), ("ms", "300")])
def test_laws(law: str, function: Callable[[Any], Any], time: str, step: str) -> None:
    to = "2.1" if time == "s" else "2100"
    motion = (
        f"  time: {{from: 0, to: {to}, step: {step}}}\n  inputs: {{O.theta: {law}, Q.s: {{at: 1}}}}"
    )
    found = inputs_of(motion, time)
    assert found.time is not None
    for row in range(8):
        t = row * mp.mpf("0.3")
        assert abs(mp.mpf(found.time[0, row]) + mp.mpf(found.time[1, row]) - t) < 1e-31
        agree(found, 0, row, jets(function, t))


def test_a_rise_rests_before_and_behind_it() -> None:
    law = "{law: harmonic, from: 3, to: 40, start: 0.5, duration: 1}"
    found = inputs_of(
        f"  time: {{from: 0, to: 2, step: 0.2}}\n  inputs: {{O.theta: {law}, Q.s: {{at: 1}}}}"
    )
    agree(found, 0, 1, [3 * DEGREE, 0, 0, 0])
    agree(found, 0, 9, [40 * DEGREE, 0, 0, 0])
    rise = lambda t: DEGREE * (3 + 37 * (1 - mp.cos(mp.pi * (t - mp.mpf("0.5")))) / 2)  # noqa: E731
    agree(found, 0, 4, jets(rise, mp.mpf("0.8")))


KNOTS = (("0", "1.1"), ("0.3", "2.7"), ("1.1", "0.4"), ("1.7", "5.5"), ("2.1", "5.3"))


def true_spline() -> Callable[[Any], Any]:
    """The not-a-knot spline as linear equations for the cubics of all pieces."""
    x, y = ([mp.mpf(pair[k]) for pair in KNOTS] for k in (0, 1))
    pieces = len(x) - 1
    matrix, right = mp.zeros(4 * pieces), mp.zeros(4 * pieces, 1)
    line = 0

    def row(terms: dict[int, Any], value: Any) -> None:
        nonlocal line
        for column, factor in terms.items():
            matrix[line, column] = factor
        right[line] = value
        line += 1

    for p in range(pieces):
        h = x[p + 1] - x[p]
        row({4 * p: 1}, y[p])
        row({4 * p + k: h**k for k in range(4)}, y[p + 1])
        if p + 1 < pieces:
            row({4 * p + 1: 1, 4 * p + 2: 2 * h, 4 * p + 3: 3 * h**2, 4 * p + 5: -1}, 0)
            row({4 * p + 2: 2, 4 * p + 3: 6 * h, 4 * p + 6: -2}, 0)
    row({3: 1, 7: -1}, 0)
    row({4 * pieces - 5: 1, 4 * pieces - 1: -1}, 0)
    found = mp.lu_solve(matrix, right)

    def spline(t: Any) -> Any:
        p = max(k for k in range(pieces) if x[k] <= t or k == 0)
        u = t - x[p]
        return DEGREE * sum(found[4 * p + k] * u**k for k in range(4))

    return spline


def test_tables(tmp_path: Path) -> None:
    rows = "".join(f"{x},{y}\n" for x, y in KNOTS)
    (tmp_path / "law.csv").write_text("time,value\n" + rows, encoding="utf-8")
    motion = (
        "  time: {from: 0.05, to: 2, count: 8}\n"
        "  inputs: {O.theta: {law: table, file: law.csv}, Q.s: {at: 1}}"
    )
    found, spline = inputs_of(motion, folder=tmp_path), true_spline()
    for row in range(8):
        t = mp.mpf("0.05") + row * mp.mpf("1.95") / 7
        agree(found, 0, row, jets(spline, t))


FOLLOWED = [
    ("sin(2*T)^2/(1.5 + cos(T))", lambda x, t: mp.sin(2 * x) ** 2 / (1.5 + mp.cos(x))),
    ("sqrt(1.25 - cos(T))*tan(T/3)", lambda x, t: mp.sqrt(1.25 - mp.cos(x)) * mp.tan(x / 3)),
    ("(a + 1)*abs(sin(T) - 2)", lambda x, t: mp.mpf("1.7") * (2 - mp.sin(x))),
    ("atan2(sin(T), 2 + cos(T))/1 rad", lambda x, t: mp.atan2(mp.sin(x), 2 + mp.cos(x))),
    ("exp(-T/1 rad)*log(2 + T/1 rad)", lambda x, t: mp.exp(-x) * mp.log(2 + x)),
    ("(2 + sin(T))^-3", lambda x, t: (2 + mp.sin(x)) ** -3),
    ("pow(2 + sin(T), 0.7)", lambda x, t: (2 + mp.sin(x)) ** mp.mpf("0.7")),
    ("pow(2, sin(T))", lambda x, t: 2 ** mp.sin(x)),
    ("wrap(7*T)/1 rad", lambda x, t: 7 * x - 2 * mp.pi * mp.nint(7 * x / (2 * mp.pi))),
    ("max(sin(T), 0.3)", lambda x, t: max(mp.sin(x), mp.mpf("0.3"))),
    ("asin(0.5*sin(T))/1 rad", lambda x, t: mp.asin(mp.sin(x) / 2)),
    ("norm([cos(T), 2, sin(3*T)])", lambda x, t: mp.norm([mp.cos(x), 2, mp.sin(3 * x)])),
    ("(time/1 s)^2*T/1 rad", lambda x, t: t * t * x),
]
"""Hundredths of a metre, of T = O.theta."""


@pytest.mark.parametrize(("text", "function"), FOLLOWED)
def test_inputs_that_follow(text: str, function: Callable[[Any, Any], Any]) -> None:
    law = "{law: constant-acceleration, at: 10, rate: 0.3, acceleration: 0.2}"
    motion = f"  time: {{from: 0, to: 2, step: 0.25}}\n  inputs: {{O.theta: {law}, "
    motion += f"Q.s: {{with: '1 cm*{text.replace('T', 'O.theta')}'}}}}"
    made = mk.loads(ARM.format(motion=motion, time="s"))
    found = made.session.precise.inputs(made.session)
    unit = mp.mpf(made.session.layout.length)

    def course(t: Any) -> Any:
        x = 10 * DEGREE + mp.mpf("0.3") * t + mp.mpf("0.1") * t * t
        return function(x, t) / 100

    for row in range(9):
        agree(found, 1, row, jets(course, row * mp.mpf("0.25")), unit)


def test_whole_turns_are_taken_off_exactly() -> None:
    found = inputs_of("  inputs: {O.theta: {from: 36000, to: 36370, step: 37}, Q.s: {at: 1}}")
    for row in range(11):
        degrees = 37 * row if 37 * row <= 180 else 37 * row - 360
        high, low = found.reduced[0, :, row]
        assert abs(mp.mpf(high) + mp.mpf(low) - degrees * DEGREE) <= 1e-31
        assert found.whole[0, row] == (100 if degrees == 37 * row else 101)


def test_proofs_know_how_far_inputs_are_from_the_text() -> None:
    """An expression that cancels is farther off than its size tells."""
    text = "1e8 mm*(sin(O.theta)^2 + cos(O.theta)^2 - 1)"
    motion = f"  inputs: {{O.theta: {{from: 1, to: 50, count: 20}}, Q.s: {{with: '{text}'}}}}"
    session = mk.loads(ARM.format(motion=motion, time="s")).session
    off = np.abs(session.inputs.values[1])
    assert off.max() > 1e-12
    assert (input_rounding(session, session.inputs.values)[1] >= off).all()
    assert (input_rounding(session, session.inputs.values)[0] <= 1e-15).all()


def test_rates_of_ties() -> None:
    motion = (
        "  inputs: {O.theta: {from: 0, to: 40, step: 5},"
        " Q.s: {with: '10 mm*sin(2*O.theta)', drive: tie}}"
    )
    made = mk.loads(ARM.format(motion=motion, time="s"))
    session = made.session
    found = session.precise.inputs(session).constraint_rates
    assert found is not None
    assert session.constraint_rates is not None
    for row in range(9):
        true = mp.mpf(2) / 100 * mp.cos(2 * 5 * row * DEGREE) / mp.mpf(session.layout.length)
        assert abs(mp.mpf(found[0, 0, row]) + mp.mpf(found[0, 1, row]) - true) <= 1e-30
        assert abs(session.constraint_rates[0, row] - true) <= 1e-14


@pytest.mark.parametrize("stem", STEMS)
def test_rows_of_every_mechanism(stem: str) -> None:
    """High parts are the doubles; both evaluations and the enclosures agree."""
    session = model(stem).session
    if session.problem.motion.rest is not None:
        pytest.skip("no text says where loads balance")
    found, boxes = session.precise.inputs(session), enclosed_inputs(session.precise, session)
    for name in (*ORDERS, "reduced"):
        values, inside = getattr(found, name), getattr(boxes, name)
        doubles = getattr(session.inputs, name)
        size = np.abs(doubles).max(initial=1.0)
        assert np.abs(values[:, 0] - doubles).max(initial=0.0) <= 4e-16 * size
        off = np.abs((values[:, 0] - inside[:, 0]) + (values[:, 1] - inside[:, 1]))
        assert (off <= inside[:, 2] + 1e-30 * size).all()
        assert inside[:, 2].max(initial=0.0) <= 1e-31 * size


def test_a_tape_over_rows_is_the_same_by_decimals(monkeypatch: pytest.MonkeyPatch) -> None:
    session = model("stewart").session
    found = precise_inputs(session.precise, session)
    monkeypatch.setattr(ExactRows, "double_doubles", lambda self, numbers: self.rounded(numbers))
    other = precise_inputs(session.precise, session)
    for name in ORDERS:
        a, b = getattr(found, name), getattr(other, name)
        assert np.abs((a[:, 0] - b[:, 0]) + (a[:, 1] - b[:, 1])).max() <= 1e-31


def test_places_that_a_call_names_are_its_doubles() -> None:
    made = model("rcsr")
    session = made.session
    motion = session.problem.motion
    driven = motion.inputs[0]
    orders = driven.written_orders.copy()
    orders[0] += 0.1
    other = session.moved(
        session.problem.moved(motion._replace(inputs=(driven._replace(written_orders=orders),)))
    )
    found = other.precise.inputs(other)
    true = mp.mpf(orders[0][3]) * DEGREE
    assert abs(mp.mpf(found.values[0, 0, 3]) + mp.mpf(found.values[0, 1, 3]) - true) <= 1e-31
