"""Inputs between rows: their own laws and ties, whatever the rows, the pace and the writing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from random_families.five_bars import FiveBar

import mechkin_cli as mk
from mechkin_cli.plan.layout import home_state
from mechkin_cli.plan.records import TrackEnd
from mechkin_cli.session.session import Session

BAR = FiveBar(2.2, 1.3)
FULL = FiveBar(2.0, 2.0)
"""Turns fully whatever its cranks do."""


def swept(to: float, count: int, tie: str) -> str:
    rows = f"A.theta: {{from: 0, to: {to!r}, count: {count}}}"
    return f'{{inputs: {{{rows}, E.theta: {{with: "{tie}"}}}}}}'


def timed(duration: float, count: int, first: str, second: str) -> str:
    time = f"time: {{from: 0, to: {duration!r}, count: {count}}}"
    return f"{{{time}, inputs: {{A.theta: {first}, E.theta: {second}}}}}"


def run(motion: str, bar: FiveBar = FULL) -> Any:
    return mk.loads(bar.text(motion)).analyze()


TIES = ["-0.7*A.theta", "1.1 rad*sin(1.3*A.theta)", "abs(A.theta - 103 deg)*0.5 - 51.5 deg"]


@pytest.mark.parametrize("tie", TIES)
@pytest.mark.parametrize("to", [360.0, -720.0])
def test_more_rows_between(tie: str, to: float) -> None:
    few, many = run(swept(to, 5, tie)), run(swept(to, 401, tie))
    assert set(few["row.status"]) == {"ok"}
    assert few["C.theta"] == pytest.approx(many["C.theta"][::100], abs=1e-9)


@pytest.mark.parametrize("tie", TIES)
def test_a_sweep_a_law_and_their_pace(tie: str) -> None:
    sweep = run(swept(400.0, 9, tie))["C.theta"]
    for duration in (1e-3, 1.0, 50.0):
        rate = f"{{law: constant-rate, at: 0, rate: {400.0 / duration!r} deg/s}}"
        law = run(timed(duration, 9, rate, f'{{with: "{tie}"}}'))
        assert set(law["row.status"]) == {"ok"}
        assert law["C.theta"] == pytest.approx(sweep, abs=1e-9)


@pytest.mark.parametrize("tie", TIES)
def test_there_and_back(tie: str) -> None:
    """A law that swings to 400 degrees and back: equal answers at equal inputs."""
    law = "{law: polynomial, coefficients: [0 deg, 400 deg/s, -100 deg/s^2]}"
    found = run(timed(4.0, 9, law, f'{{with: "{tie}"}}'))
    assert set(found["row.status"]) == {"ok"}
    assert found["C.theta"][::-1] == pytest.approx(found["C.theta"], abs=1e-9)


@pytest.mark.parametrize(
    "laws", [("harmonic", "cycloidal"), ("cycloidal", "cycloidal"), ("harmonic", "harmonic")]
)
@pytest.mark.parametrize("count", [2, 3, 40])
def test_inputs_that_rest_together(laws: tuple[str, str], count: int) -> None:
    """Both leave and come to rest at once, each in its own way: the pin in closed form."""
    first = f"{{law: {laws[0]}, from: 0, to: 250}}"
    second = f"{{law: {laws[1]}, from: 0, to: -130}}"
    found = run(timed(1.0, count, first, second))
    assert set(found["row.status"]) == {"ok"}
    shapes: dict[str, Callable[[Any], Any]] = {
        "harmonic": lambda u: (1.0 - np.cos(np.pi * u)) / 2.0,
        "cycloidal": lambda u: u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi),
    }
    a, e = shapes[laws[0]], shapes[laws[1]]
    way = FULL.along(lambda s: 250.0 * a(s), lambda s: -130.0 * e(s), count)
    assert found["B.theta"] == pytest.approx(way.angle[way.rows], abs=1e-9)


@pytest.mark.parametrize("turn", [0.9993, 0.9999, 0.0007, 0.0001])
def test_inputs_that_turn_back_next_to_the_first_or_last_row(turn: float) -> None:
    """Both rest at once a moment after the motion begins, or before it ends."""
    # the angle goes from 0 and is largest at the turn
    phase = 90.0 - 360.0 * 2.0 * turn
    start = -120.0 * float(np.sin(np.radians(phase)))
    law = f"{{law: sine, amplitude: 120, frequency: 2, phase: {phase!r}, offset: {start!r}}}"
    found = run(timed(1.0, 5, law, '{with: "-0.4 rad*sin(A.theta)"}'))
    assert set(found["row.status"]) == {"ok"}

    def a(s: Any) -> Any:
        return 120.0 * np.sin(np.radians(720.0 * s + phase)) + start

    def e(s: Any) -> Any:
        return -np.degrees(0.4 * np.sin(np.radians(a(s))))

    way = FULL.along(a, e, 5)
    assert found["B.theta"] == pytest.approx(way.angle[way.rows], abs=1e-9)


def test_a_dead_centre_is_named_with_its_time() -> None:
    """A crank that swings to 170 degrees between rows 1 s apart."""
    law = "{law: harmonic, from: 0, to: 170}"
    motion = (
        f"{{time: {{from: 0, to: 1, step: 1}}, inputs: {{A.theta: {law}, E.theta: {{at: 0}}}}}}"
    )
    found = mk.loads(BAR.text(motion)).analyze()
    assert list(found["row.status"]) == ["ok", "beyond-dead-centre"]
    one, other = mp.hypot(mp.mpf("1.2"), mp.mpf("1.3")), mp.hypot(mp.mpf("1.8"), mp.mpf("1.3"))
    # the ends of the cranks are one + other apart: 17 - 8 cos(t) = (one + other)^2
    angle = mp.degrees(mp.acos((17 - (one + other) ** 2) / 8))
    moment = mp.acos(1 - 2 * angle / 170) / mp.pi
    (note,) = (d for d in found.diagnostics if d.code == "dead-centre")
    named = {number.name: number.value for number in note.numbers}
    assert named["A.theta"] == pytest.approx(float(angle), abs=1e-9)
    assert named["time"] == pytest.approx(float(moment), abs=1e-11)


def test_rows_have_their_own_inputs_bit_for_bit() -> None:
    model = mk.loads(FULL.text(swept(333.0, 14, "0.9 rad*sin(A.theta)")))
    session = Session.of(model.problem)
    assert session.route is not None
    for row, step in ((0, 1), (13, -1), (5, -1)):
        way = session.route.way(row, step)
        assert way.course is not None
        real = way.values[:, way.real]
        assert np.array_equal(real, session.inputs.values[:, row::step])
        for place, parameter in zip(way.real, way.at[way.real], strict=True):
            at = way.course.at(0, way.course.sigma(0, float(parameter)))
            assert at[0] == pytest.approx(way.values[:, place], abs=4e-15)
    followed = session.follow_rows(home_state(session.layout), every_row=True)
    assert followed.end == TrackEnd.FINISHED


@pytest.mark.parametrize(
    "tie", ["-0.5*A.theta", "0.2*A.theta", "abs(A.theta - 50 deg)*0.3 - 15 deg"]
)
def test_ranges_follow_the_tie(tie: str) -> None:
    functions: dict[str, Callable[[Any], Any]] = {
        "-0.5*A.theta": lambda a: -0.5 * a,
        "0.2*A.theta": lambda a: 0.2 * a,
        "abs(A.theta - 50 deg)*0.3 - 15 deg": lambda a: 0.3 * abs(a - 50.0) - 15.0,
    }
    model = mk.loads(BAR.text(swept(40.0, 3, tie)))
    found, tied = model.ranges().ranges, model.ranges("E.theta").ranges
    for sense, ends in ((1.0, "upper"), (-1.0, "lower")):
        way = BAR.along(
            lambda s, d=sense: d * 200.0 * s, lambda s, d=sense: functions[tie](d * 200.0 * s), 2
        )
        first, second = BAR.dead_centre(
            way, lambda s, d=sense: d * 200.0 * s, lambda s, d=sense: functions[tie](d * 200.0 * s)
        )
        for one, other in zip(found, tied, strict=True):
            assert getattr(one, ends).kind == "dead-centre"
            assert getattr(one, ends).value == pytest.approx(first, abs=1e-9)
            values = (other.lower.value, other.upper.value)
            assert min(abs(value - second) for value in values) < 1e-9


def test_a_drawing_serves_whole_turns_away() -> None:
    """A crank that stops at a dead centre short of a turn, drawn at 0."""
    near = run("{inputs: {A.theta: {from: -30, to: 30, step: 10}, E.theta: {at: 0}}}", BAR)
    for turns in (1, -2):
        rows = f"from: {-30 + 360 * turns}, to: {30 + 360 * turns}, step: 10"
        far = run(f"{{inputs: {{A.theta: {{{rows}}}, E.theta: {{at: 0}}}}}}", BAR)
        assert set(far["row.status"]) == {"ok"}
        assert far["C.theta"] == pytest.approx(near["C.theta"], abs=1e-9)


@pytest.mark.parametrize("rows", ["at: 0, rate: 1 rad/s", "at: 0", "from: 5, to: 10, step: 5"])
@pytest.mark.parametrize("height", ["0", "1.5"])
def test_a_locked_input_is_named(rows: str, height: str) -> None:
    """A triangle: `analyze` says what `mobility` says, and gives no rate."""
    model = mk.loads(f"""
format: 1
links: {{a: {{}}, b: {{}}}}
joints:
  A: {{type: R, links: [ground, a], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [a, b], point: [1, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [b, ground], point: [2, {height}, 0], axis: [0, 0, 1]}}
motion: {{inputs: {{A.theta: {{{rows}}}}}}}
""")
    found = model.analyze(["B.theta_dot"])
    said = {d.message for d in found.diagnostics if d.code == "input-locked"}
    assert said == {d.message for d in model.mobility().diagnostics if d.code == "input-locked"}
    assert said
    if "at: 0" in rows and "rate" not in rows:
        # it stands as drawn, and nothing is asked to move
        assert set(found["row.status"]) == {"ok"}
        assert found["B.theta_dot"].tolist() == [0.0]
        return
    assert not {"ok", "near-singular"} & set(found["row.status"])
    assert np.isnan(found["B.theta_dot"]).all()
