"""Stop events against closed forms: their moments to rounding, and what their rows hold."""

from __future__ import annotations

import math
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp
from response.motions import last_time, off, respond
from response.oscillators import lines, slider

import mechkin_cli as mk

EXACT = 1e-12
FALL = """format: 1
name: fall
links:
  stone: {{mass: 2, center_of_mass: [0, 0, 0]}}
joints:
  S: {{type: P, links: [ground, stone], point: [0, 0, 0], axis: [0, 0, 1]}}
points:
  top: {{link: stone, at: [0, 0, 0.25]}}
loads:
  - {{type: gravity, g: [0, 0, -9.81]}}
responses:
  run:
    start: {{S.s: 3, S.s_dot: {rate}}}
    time: {{from: 0, to: 5, step: 0.25}}
    stop: [{stop}]
    tolerance: 1e-12
"""


@pytest.mark.parametrize(
    ("stop", "rate", "moment"),
    [
        ("{value: S.s, at: 0}", 0, math.sqrt(6 / 9.81)),
        ("{value: S.s, at: 3.5, direction: up}", 8, (8 - math.sqrt(64 - 9.81)) / 9.81),
        ("{value: S.s, at: 3.5, direction: down}", 8, (8 + math.sqrt(64 - 9.81)) / 9.81),
        ("{value: top.position.z, at: 1.25}", 0, math.sqrt(4 / 9.81)),
        ("{value: S.s_dot, at: -4}", 0, 4 / 9.81),
        ("{dead_centre: S.s}", 8, 8 / 9.81),
        ("{value: 'S.s - 3 m', at: -1 m}, {value: S.s, at: -1}", 0, math.sqrt(2 / 9.81)),
        (
            "{value: S.s, at: 2.999, direction: down}",
            8,
            8 / 9.81 + math.sqrt(64 + 2 * 9.81e-3) / 9.81,
        ),
    ],
)
def test_a_stone_is_stopped(stop: str, rate: float, moment: float) -> None:
    found = respond(FALL.format(stop=stop, rate=rate))
    assert last_time(found) == pytest.approx(moment, rel=EXACT)
    assert off(found["time"][:-1], 0.25 * np.arange(len(found["time"]) - 1)) == 0
    assert found["S.s"][-1] == pytest.approx(
        3 + rate * moment - 9.81 * moment**2 / 2, abs=EXACT * 10
    )
    assert str(found["row.event"][-1])


APEX = (
    "{dead_centre: S.s}",
    "{dead_centre: S.s, count: 2}",
    "{value: S.s_dot, at: 0, count: 3}",
    "{value: 'max(S.s - 99 m, 0.5 s*S.s_dot)', at: 0 m, count: 2}",
    "{value: '2*S.s_dot', at: 0, direction: down}",
)


@pytest.mark.parametrize(
    "stops",
    [
        stops
        for stops in [*permutations(APEX, 2), *list(permutations(APEX))[::17]]
        if APEX[0] in stops or APEX[4] in stops
    ],
)
def test_of_stops_met_at_one_moment_any_order_ends_there(stops: tuple[str, ...]) -> None:
    """Some of them pass there without ending the motion, which must not move the end."""
    found = respond(FALL.format(stop=", ".join(stops), rate=8))
    assert last_time(found) == pytest.approx(8 / 9.81, rel=EXACT)
    assert found["S.s"][-1] == pytest.approx(3 + 64 / (2 * 9.81), rel=EXACT)
    assert found["S.s_dot"][-1] == pytest.approx(0, abs=EXACT * 10)


def test_what_never_happens_ends_nothing() -> None:
    found = respond(FALL.format(stop="{value: S.s, at: 4, direction: up}", rate=0))
    assert last_time(found) == 5
    assert not any(str(word) for word in found["row.event"])


def test_an_event_at_a_row_is_that_row() -> None:
    """A constant speed passes 0.5 at the row of 0.5 s: no row stands there twice."""
    text = slider(
        "  []",
        lines(
            "start: {S.s: 0, S.s_dot: 1}",
            "time: {from: 0, to: 2, step: 0.25}",
            "stop: [{value: S.s, at: 0.5}]",
            indent=4,
        ),
    ).replace("loads:\n  []", "loads: []")
    found = respond(text)
    assert off(found["time"], [0, 0.25, 0.5]) < 1e-14
    assert str(found["row.event"][-1])


PENDULUM = """format: 1
name: pendulum
units: {angle: rad}
links:
  bob: {mass: 2, center_of_mass: [0, 0, -0.5], inertia: {yy: 0.2}}
joints:
  A: {type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 1, 0]}
loads:
  - {type: gravity, g: [0, 0, -9.81]}
responses:
  run:
    start: {A.theta: 0, A.theta_dot: 5 rad/s}
    time: {from: 0, to: 20, step: 1}
    stop: [{dead_centre: A.theta, count: COUNT}]
    tolerance: 1e-13
"""


@pytest.mark.parametrize("count", [1, 2, 7])
def test_a_pendulum_is_stopped_at_a_dead_centre(count: int) -> None:
    """(2 count - 1) quarters of its period, 4 K(k) / w with k = rate / (2 w)."""
    found = respond(PENDULUM.replace("COUNT", str(count)))
    with mp.workdps(30):
        w = mp.sqrt(mp.mpf("9.81") / mp.mpf("0.7"))
        moment = (2 * count - 1) * mp.ellipk((5 / (2 * w)) ** 2) / w
    assert last_time(found) == pytest.approx(float(moment), rel=1e-12 * (1 + count))
    assert abs(found["A.theta_dot"][-1]) < 1e-10


ROTOR = """format: 1
name: rotor
units: {angle: rad}
links:
  disc: {mass: 2, center_of_mass: [0, 0, 0], inertia: {zz: 0.5}}
joints:
  A: {type: R, links: [ground, disc], point: [0, 0, 0], axis: [0, 0, 1]}
responses:
  run:
    start: {A.theta: 1}
    efforts: {A.theta: EFFORT}
    time: {from: 0, to: 20, step: 1}
    stop: [{turns: A.theta, count: 3}]
"""


@pytest.mark.parametrize("effort", [2.0, -2.0])
def test_a_rotor_is_stopped_after_three_turns(effort: float) -> None:
    found = respond(ROTOR.replace("EFFORT", repr(effort)))
    assert last_time(found) == pytest.approx(math.sqrt(2 * 6 * math.pi / 4), rel=EXACT)
    assert found["A.theta"][-1] == pytest.approx(1 + math.copysign(6 * math.pi, effort), rel=EXACT)


NEARLY_TURNING = """format: 1
name: pendulum
units: {{length: mm, force: N}}
links: {{bob: {{mass: 2, center_of_mass: [0, -250, 0]}}}}
joints: {{A: {{type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}}}
loads: [{{type: gravity, g: [0, -9810, 0]}}]
responses:
  run:
    start: {{A.theta: 80, A.theta_dot: 0 rad/s}}
    time: {{from: 0, to: 3, count: {count}}}
    stop: [{{value: A.theta, at: -{at}}}]
"""


@pytest.mark.parametrize("count", [2, 4, 31, 61, 101, 151, 301, 1501])
@pytest.mark.parametrize("at", ["79.9", "79.9999", "79.9999999"])
def test_a_stop_just_before_a_dead_centre_is_met(at: str, count: int) -> None:
    """Both crossings lie within one step. With k = sin(40 deg) and sin(at/2) = k sin(phi), at is
    met (K(k) + F(phi, k)) / w after the other dead centre."""
    found = respond(NEARLY_TURNING.format(at=at, count=count), energy=1e-10)
    with mp.workdps(30):
        k = mp.sin(mp.radians(40))
        phi = mp.asin(mp.sin(mp.radians(mp.mpf(at)) / 2) / k)
        moment = (mp.ellipk(k**2) + mp.ellipf(phi, k**2)) / mp.sqrt(mp.mpf("9.81") / mp.mpf("0.25"))
    # the angle is known to 1e-10, and nearly turns
    assert found["A.theta"][-1] == pytest.approx(-float(at), abs=1e-9)
    assert last_time(found) == pytest.approx(float(moment), abs=3e-8 if "99999" in at else 1e-9)


SLIDER_CRANK = """format: 1
name: slider-crank
units: {{angle: rad}}
links:
  crank: {{mass: 2, center_of_mass: [0, 0.1, 0], inertia: {{zz: 0.1}}}}
  rod: {{mass: 1, center_of_mass: [0.45, 0.1, 0], inertia: {{zz: 0.1}}}}
  slider: {{mass: 1, center_of_mass: [{x}, 0, 0]}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: S, links: [crank, rod], point: [0, 0.2, 0]}}
  C: {{type: C, links: [rod, slider], point: [{x}, 0, 0], axis: [0, 0, 1]}}
  D: {{type: P, links: [ground, slider], point: [{x}, 0, 0], axis: [1, 0, 0]}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
responses:
  run:
    start: {{A.theta: 0, A.theta_dot: {rate}}}
    time: {{from: 0, to: 2, count: {count}}}
    stop: [{{value: D.s, at: {at!r}}}]
"""


@pytest.mark.parametrize("rate", [-9, 9])
@pytest.mark.parametrize("short", [1e-3, 1e-6, 1e-9])
def test_a_slide_is_stopped_just_before_its_end(short: float, rate: int) -> None:
    """The end is r + l; there cos(turn) = (s^2 + r^2 - l^2) / (2 r s), whatever moves it. At every
    spacing of the rows it is met at the first pass."""
    r, length = 0.2, 0.9
    x = math.sqrt(length**2 - r**2)
    s = r + length - short
    with mp.workdps(30):
        cosine = (mp.mpf(s) ** 2 + mp.mpf(r) ** 2 - mp.mpf(length) ** 2) / (2 * mp.mpf(r) * s)
        away = mp.acos(cosine)
    expected = float(-mp.pi / 2 + away) if rate < 0 else float(3 * mp.pi / 2 - away)
    for count in (2, 3, 4, 6, 9, 14, 22, 35, 101, 401):
        found = respond(
            SLIDER_CRANK.format(x=repr(x), rate=rate, count=count, at=s - x), energy=1e-9
        )
        assert found["A.theta"][-1] == pytest.approx(expected, abs=1e-12 / math.sqrt(short))


HELD = """format: 1
name: a pin that the loop holds
units: {{length: m, angle: rad}}
links:
  L1: {{}}
  L2: {{mass: 1.16, center_of_mass: [0.118, -0.375, -0.726],
    inertia: {{xx: 0.17, yy: 0.18, zz: 0.12, xy: -0.02, xz: 0.08, yz: 0.01}}}}
joints:
  J0: {{type: S, links: [ground, L1], point: [-0.53, -0.406, 0.112]}}
  J1: {{type: R, links: [L2, L1], point: [-0.471, -0.067, -0.231], axis: [0.9175, 0.3971, 0.0205]}}
  J2: {{type: E, links: [ground, L2], point: [-0.105, 0.001, -0.427],
    normal: [0.655, -0.7497, 0.0948], x: [-0.7497, -0.655, 0]}}
loads:
  - {{type: torque, joint: J1, value: "5.63 N*m*sin(1.35 rad/s*time)"}}
responses:
  run:
    start: {{J2.x: 0, J2.x_dot: 1.123}}
    time: {{from: 0, to: 1.5, count: {rows}}}
    stop: [{stop}]
"""


@pytest.mark.parametrize("rows", [4, 11, 16, 101])
@pytest.mark.parametrize(
    "stop",
    [
        "{value: J1.theta, at: 0}",
        "{value: J1.theta_dot, at: 0}",
        "{value: J1.theta*J2.x, at: 0}",
        "{dead_centre: J1.theta}",
    ],
)
def test_a_coordinate_that_the_loop_holds_passes_nothing(stop: str, rows: int) -> None:
    """By two of three conditions of S and E the pin cannot turn; its angle is rounding alone."""
    found = respond(HELD.format(stop=stop, rows=rows))
    assert found["time"].tolist() == pytest.approx(np.linspace(0, 1.5, rows).tolist())
    assert not any(found["row.event"])


@pytest.mark.parametrize("rows", [2, 31])
def test_a_motion_that_begins_at_a_stop_leaves_it_without_a_word(rows: int) -> None:
    """Let go at rest at a dead centre of the angle, at its value and at that of its rate: each is
    met where it comes back to it, after half a swing or a whole one."""
    text = """format: 1
name: let go
units: {{length: m, angle: rad}}
links:
  bob: {{mass: 2, center_of_mass: [0, -0.25, 0]}}
joints:
  A: {{type: R, links: [ground, bob], point: [0, 0, 0], axis: [0, 0, 1]}}
loads:
  - {{type: gravity, g: [0, -9.81, 0]}}
responses:
  run:
    start: {{A.theta: 1.2}}
    time: {{from: 0, to: 3, count: {rows}}}
    tolerance: 1e-12
    stop: [{stop}]
"""
    half = 2 * mp.ellipk(mp.sin(mp.mpf("0.6")) ** 2) / mp.sqrt(mp.mpf("9.81") / mp.mpf("0.25"))
    for stop in (
        "{dead_centre: A.theta}",
        "{value: A.theta_dot, at: 0}",
        "{value: A.theta, at: -1.1999999}",
    ):
        found = respond(text.format(stop=stop, rows=rows))
        assert last_time(found) == pytest.approx(float(half), abs=2e-4 if "-1.19" in stop else 1e-9)


FALLING = Path(__file__).parent / "ends" / "stops_that_jump.yaml"
TO_ONE = math.sqrt(0.8)


@pytest.mark.parametrize(
    ("run", "moment"),
    [
        ("plain", TO_ONE),
        ("iff", TO_ONE),
        ("iff1", TO_ONE),
        ("cond", TO_ONE),
        ("andd", TO_ONE),
        # the floor comes to 2 where the stone passes 3 m
        ("flo", math.sqrt(0.4)),
        ("flo25", math.sqrt(0.4)),
        ("sgn", 1.0),
        ("window", TO_ONE),
        ("kink", TO_ONE),
        ("kink2", math.sqrt(0.7998)),
        ("kink3", math.sqrt(0.79999998)),
    ],
)
def test_values_that_jump_or_bend_stop_where_they_pass(run: str, moment: float) -> None:
    falling = mk.load(FALLING).respond(run)
    assert off(falling["time"][-1], moment) < EXACT
    assert off(falling["P.s"][-1], 5 - 5 * moment**2) < 1e-11
    assert falling["row.event"][-1]


@pytest.mark.parametrize(
    ("stop", "moment"),
    [
        ("{value: S.s < 1 m}", math.sqrt(4 / 9.81)),
        ("{value: S.s < 5 m}", 0.0),
        ("{value: 'S.s < 2 m and time > 0.5 s'}", 0.5),
        ("{value: 'not (S.s > 2 m or time < 0.1 s)'}", math.sqrt(2 / 9.81)),
        ("{value: 'floor(S.s/(1 m)) == 1'}", math.sqrt(2 / 9.81)),
        ("{value: 'sin(20 rad*time/(1 s))', at: 0.5, count: 4}", (math.pi * 17 / 6) / 20),
        (
            "{value: 'sin(20 rad*time/(1 s))', at: 0.5, direction: up, count: 2}",
            (math.pi * 13 / 6) / 20,
        ),
        ("{value: 'sin(20 rad*time/(1 s)) > 0.5', count: 2}", (math.pi * 13 / 6) / 20),
    ],
)
def test_conditions_and_counted_passages(stop: str, moment: float) -> None:
    stopped = mk.loads(FALL.format(rate=0, stop=stop)).respond("run")
    assert off(stopped["time"][-1], moment) < EXACT
    assert stopped["row.event"][-1]


@pytest.mark.parametrize(
    ("value", "moment"),
    [
        ("abs(S.s - 1 m)", math.sqrt(4 / 9.81)),
        ("(S.s - 2 m)^2/(1 m)", math.sqrt(2 / 9.81)),
        ("max(S.s - 1 m, 1 m - S.s)", math.sqrt(4 / 9.81)),
        # where a row is
        ("(time - 1 s)^2/(1 s)", 1.0),
        ("abs(time - 1.25 s)", 1.25),
    ],
)
def test_a_value_that_only_touches_is_named(value: str, moment: float) -> None:
    touched = mk.loads(FALL.format(rate=0, stop=f"{{value: '{value}', at: 0}}")).respond("run")
    assert off(touched["time"][-1], 5.0) < EXACT
    (note,) = [one for one in touched.diagnostics if one.code == "stop-touched"]
    assert f"touched at {moment:.6g} s" in note.message


PASSING = """format: 1
links: {{block: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{S: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}}}
responses:
  run:
    start: {{S.s: -1.3, S.s_dot: 1}}
    time: {{from: 0, to: 5, count: {rows}}}
    stop: [{{value: "{value}", at: 0, direction: {direction}}}]
"""


def _passing(value: str, direction: str, rows: int = 6) -> tuple[float, set[str]]:
    """When a block of 1 m/s ends, in s from where it passes S.s = 0, and the codes of its notes."""
    found = mk.loads(PASSING.format(value=value, direction=direction, rows=rows)).respond("run")
    return found["time"][-1] - 1.3, {one.code for one in found.diagnostics}


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-10, 1e-11, 1e-12])
@pytest.mark.parametrize(
    ("value", "down", "up"),
    [("abs(S.s) - {}*1 m", -1.0, 1.0), ("S.s + 2*abs(S.s - {0}*1 m) - {0}*1.5 m", 0.5, 7 / 6)],
)
def test_passages_however_close_to_the_kink_between_them(
    value: str, down: float, up: float, gap: float
) -> None:
    for direction, part in (("down", down), ("up", up)):
        moment, codes = _passing(value.format(gap), direction)
        assert abs(moment - part * gap) < 4e-15
        assert "stop-touched" not in codes


@pytest.mark.parametrize("rows", [6, 51])
@pytest.mark.parametrize(
    ("value", "order"),
    [
        # its kink lies beyond where it is passed, or before, or there
        ("S.s + abs(S.s - 1e-10 m)/2 - 0.5e-10 m", 1),
        ("S.s + abs(S.s + 1e-10 m)/2 - 0.5e-10 m", 1),
        ("S.s + abs(S.s)/2", 1),
        ("S.s*abs(S.s)/(1 m)", 2),
        ("S.s^3/(1 m^2)", 3),
    ],
)
def test_what_is_passed_the_other_way_is_not_touched(value: str, order: int, rows: int) -> None:
    """The value rises all along; with 51 rows one lies where it passes. A zero of an order is met
    as far as 1e-12 of the values tells."""
    assert _passing(value, "down", rows) == (5.0 - 1.3, set())
    assert abs(_passing(value, "up", rows)[0]) < (4e-15 if order == 1 else 1e-12 ** (1 / order))


BAR = """format: 1
plane: xy
units: {{length: m, angle: rad}}
links: {{bar: {{mass: 1, center_of_mass: [0, 0], inertia: 1}}}}
joints: {{A: {{type: R, links: [ground, bar], point: [0, 0]}}}}
responses:
  run:
    start: {{A.theta: 0.1, A.theta_dot: 20}}
    time: {{from: 0, to: 5, count: {rows}}}
    stop: [{{value: "{value}", at: {at}, direction: {direction}, count: {count}}}]
"""


@pytest.mark.parametrize("rows", [2, 41])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 9])
@pytest.mark.parametrize(
    ("value", "at", "direction", "angle"),
    [
        ("wrap(A.theta)", "3 rad", "up", 3.0),
        ("wrap(A.theta)", "3 rad", "down", math.pi),
        ("wrap(-A.theta)", "-3 rad", "down", 3.0),
        ("wrap(A.theta)", "-3 rad", "up", 2 * math.pi - 3),
        ("mod(A.theta, 360 deg)", "3 rad", "up", 3.0),
        ("mod(A.theta, 360 deg)", "3 rad", "down", 2 * math.pi),
        ("sin(A.theta)", "0.99", "up", math.asin(0.99)),
        ("cos(5*A.theta)", "0.3", "down", math.acos(0.3) / 5),
    ],
)
def test_passages_of_what_turns_are_counted(
    value: str, at: str, direction: str, angle: float, count: int, rows: int
) -> None:
    """What comes again with each turn, and jumps between; the angle is 0.1 rad + 20 rad/s t."""
    file = BAR.format(value=value, at=at, direction=direction, count=count, rows=rows)
    period = 2 * math.pi / (5 if "5*" in value else 1)
    passed = angle + period * (count - 1)
    found = mk.loads(file).respond("run")
    assert last_time(found) == pytest.approx((passed - 0.1) / 20, rel=1e-10)
    assert found["A.theta"][-1] == pytest.approx(passed, rel=1e-10)
