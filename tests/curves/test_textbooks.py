"""Mechanisms of textbooks on slots and arcs, each against its closed form: Scotch yokes
with a straight and a round slot, a Geneva wheel that is indexed and locked, and the quick
return of Whitworth.

Rates come from the closed form's own derivatives at 30 digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import mechkin_cli as mk

HEAD = "format: 1\nunits: {length: mm, angle: deg}\n"
PLANE = HEAD + "plane: xy\n"
RATE, ACCELERATION, JERK = 3, 2, 5
DRIVEN = """
motion:
  inputs:
    A.theta: {from: %s, to: %s, step: %s, rate: 3 rad/s, acceleration: 2 rad/s^2, jerk: 5 rad/s^3}
"""

Law = Callable[[Any], Any]


def assert_follows(result: mk.Result, name: str, law: Law, size: float, atol: float) -> None:
    """A coordinate and its three rates are those of a law of the crank's turn in rad; `size` is a
    radian in its unit, or 1 of a length."""
    assert set(result["row.status"]) == {"ok"}
    turns = np.radians(np.asarray(result["A.theta"]))
    expected: list[list[float]] = [[], [], [], []]
    with mp.workdps(30):
        for turn in turns:
            at = mp.mpf(float(turn))
            one, two, three = (mp.diff(law, at, order) for order in (1, 2, 3))
            w, a, j = RATE, ACCELERATION, JERK
            rates = (one * w, two * w**2 + one * a, three * w**3 + 3 * two * w * a + one * j)
            for known, value in zip(expected, (size * law(at), *rates), strict=True):
                known.append(float(value))
    for order, known in zip(("", "_dot", "_ddot", "_dddot"), expected, strict=True):
        np.testing.assert_allclose(result[name + order], known, rtol=1e-11, atol=atol)


YOKES: dict[str, tuple[str, Law]] = {
    "straight": ("slot: [0, 1]", lambda x: 30 * mp.cos(x) - 30),
    "line": ("curve: {line: [[30, -50], [30, 50]]}", lambda x: 30 * mp.cos(x) - 30),
    # of a slider-crank whose rod is the radius of the slot
    "circle": (
        "curve: {center: [110, 0]}",
        lambda x: 30 * mp.cos(x) + mp.sqrt(80**2 - (30 * mp.sin(x)) ** 2) - 110,
    ),
    "arc": (
        "curve: {arc: [[62, -64], [30, 0], [62, 64]]}",
        lambda x: 30 * mp.cos(x) + mp.sqrt(80**2 - (30 * mp.sin(x)) ** 2) - 110,
    ),
}


@pytest.mark.parametrize(("slot", "law"), YOKES.values(), ids=YOKES.keys())
def test_scotch_yoke(slot: str, law: Law) -> None:
    """A straight slot gives a pure cosine, a round one the slider-crank of its radius."""
    text = f"""
links: {{crank: {{}}, yoke: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  D: {{type: Ps, links: [crank, yoke], point: [30, 0], {slot}}}
  S: {{type: P, links: [ground, yoke], point: [0, -60], axis: [1, 0]}}
"""
    result = mk.loads(PLANE + text + DRIVEN % (0, 360, 10)).analyze()
    assert_follows(result, "S.s", law, 1.0, 1e-10)


def geneva(joint: str, first: float, last: float, step: float) -> mk.Result:
    """A wheel of four slots, 50*sqrt(2) off a crank of 50."""
    text = f"""
parameters: {{c: 50 mm*sqrt(2)}}
links: {{crank: {{}}, wheel: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0]}}
  B: {{type: R, links: [ground, wheel], point: [c, 0]}}
  D: {joint}
"""
    return mk.loads(PLANE + text + DRIVEN % (first, last, step)).analyze()


SLOTS = ("slot: [1, 0]", "curve: {line: [[c, 0], [10, 0]]}")


@pytest.mark.parametrize("slot", SLOTS)
def test_a_geneva_wheel_is_indexed_by_a_quarter(slot: str) -> None:
    """tan(wheel) = -a sin(crank)/(c - a cos(crank)), from 45 deg before the line of centres to 45
    after it, where the wheel stands again."""
    joint = f"{{type: Ps, links: [crank, wheel], point: [50, 0], {slot}}}"
    result = geneva(joint, -45, 45, 5)

    def law(x: Any) -> Any:
        return -mp.atan(50 * mp.sin(x) / (50 * mp.sqrt(2) - 50 * mp.cos(x)))

    assert_follows(result, "B.theta", law, 180.0 / float(mp.pi), 1e-10)
    turned = np.asarray(result["B.theta"])
    assert turned[0] - turned[-1] == pytest.approx(90.0, abs=1e-10)
    np.testing.assert_allclose(np.asarray(result["B.theta_dot"])[[0, -1]], 0.0, atol=1e-12)


def test_a_geneva_wheel_is_locked_by_an_arc_about_the_crank() -> None:
    """A corner of the wheel runs in an arc of 270 deg about the crank's axis; beyond its ends it is
    free, and no row is told as ok."""
    arc = "{arc: [[0, 40], [40, 0], [-40, 0]]}"
    joint = f"{{type: Ps, links: [wheel, crank], point: [24, 32], curve: {arc}}}"
    at = np.degrees(np.arctan2(32.0, 24.0))
    # the arc runs clockwise from 90 deg to -180 deg; the corner stands still at atan(4/3)
    result = geneva(joint, -60, 300, 10)
    turns = np.asarray(result["A.theta"])
    place = (90.0 - (at - turns)) % 360.0
    inside = place <= 270.0
    assert [status == "ok" for status in result["row.status"]] == list(inside)
    for name in ("B.theta", "B.theta_dot", "B.theta_ddot", "B.theta_dddot"):
        np.testing.assert_allclose(np.asarray(result[name])[inside], 0.0, atol=1e-11)


def test_the_quick_return_of_whitworth() -> None:
    """The arm leads to the crank's pin; it goes on half a turn while the crank turns by
    180 deg - 2 asin(d/r), and comes back during the rest."""
    text = """
links: {crank: {}, arm: {}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 20]}
  B: {type: R, links: [ground, arm], point: [0, 0]}
  D: {type: Ps, links: [crank, arm], point: [50, 20], slot: [50, 20]}
"""
    # short of where atan2 jumps by a turn
    result = mk.loads(PLANE + text + DRIVEN % (-20, 130, 10)).analyze()

    def law(x: Any) -> Any:
        return mp.atan2(50 * mp.sin(x) + 20, 50 * mp.cos(x)) - mp.atan2(20, 50)

    assert_follows(result, "B.theta", law, 180.0 / float(mp.pi), 1e-10)
    whole = mk.loads(PLANE + text + DRIVEN % (-20, 340, 10)).analyze()
    turned = np.asarray(whole["B.theta"])
    assert turned[-1] - turned[0] == pytest.approx(360.0, abs=1e-10)
    side = float(np.degrees(np.arcsin(20.0 / 50.0)))
    ends = mk.loads(PLANE + text + DRIVEN % (-side, 180.0 + side, 180.0 + 2.0 * side)).analyze()
    half = np.asarray(ends["B.theta"])
    assert half[-1] - half[0] == pytest.approx(180.0, abs=1e-9)
