"""Loads over time on what rests: a block of 1 kg that weighs 10 N, against closed forms."""

from __future__ import annotations

from math import cos, erf, exp, log, pi, sin, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq

import mechkin_cli as mk

BLOCK = """
format: 1
name: block
units: {{length: m, angle: rad, mass: kg, force: N}}
links: {{a: {{mass: 1, center_of_mass: [0, 0, 0]}}}}
joints: {{A: {{type: P, links: [ground, a], point: [0, 0, 0], axis: [1, 0, 0]}}}}
loads:
  - {{type: gravity, g: [0, 0, -10]}}
  - {{type: friction, joint: A, coefficient: {coefficient}}}
  - {{type: force, joint: A, value: "{force}"}}
responses:
  r: {{start: {{A.s: 0 m, A.s_dot: 0 m/s}}, time: {{from: 0, to: 3, count: {count}}}}}
"""
COUNTS = (2, 3, 5, 11, 51, 201)


def rows(coefficient: str, force: str, count: int) -> np.ndarray:
    text = BLOCK.format(coefficient=coefficient, force=force, count=count)
    found = mk.loads(text).respond("r", ["A.s", "A.s_dot"])
    assert (found["row.status"] == "ok").all()
    return np.array([found["A.s"], found["A.s_dot"]]).T


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("coefficient", ["0.33", "{static: 0.33, sliding: 0.33}"])
def test_a_growing_force_moves_a_block_though_friction_does_not_jump(
    coefficient: str, count: int
) -> None:
    starts = (0.33 * 10 + 0.668) / 7.58
    slid = np.maximum(np.linspace(0, 3, count) - starts, 0.0)
    have = rows(coefficient, "-0.668 N + 7.58 N/s*time", count)
    assert np.abs(have[:, 0] - 7.58 * slid**3 / 6).max() < 1e-8
    assert np.abs(have[:, 1] - 7.58 * slid**2 / 2).max() < 1e-8


def swung(static: float, sliding: float, force: float, w: float, times: np.ndarray) -> np.ndarray:
    """Places under force sin(w t) from rest: x'' = force sin(w t) - sense sliding 10, piece by
    piece, whose ends are roots."""
    found, t, x, side = np.zeros(len(times)), 0.0, 0.0, 1
    while True:
        starts = t + next(
            (
                s
                for s in np.arange(0, 2 * pi / w, 1e-5)
                if force * abs(sin(w * (t + s))) > static * 10
            ),
            0.0,
        )
        if starts > t:
            starts = brentq(lambda s: force * abs(sin(w * s)) - static * 10, starts - 1e-5, starts)
        found[(times >= t) & (times <= starts)] = x
        if starts >= times[-1]:
            return found
        side = 1 if sin(w * starts) > 0 else -1
        held = side * sliding * 10

        def rate(s: float, a: float = starts, held: float = held) -> float:
            return force / w * (cos(w * a) - cos(w * s)) - held * (s - a)

        def place(s: float, a: float = starts, held: float = held, x: float = x) -> float:
            swing = cos(w * a) * (s - a) - (sin(w * s) - sin(w * a)) / w
            return x + force / w * swing - held * (s - a) ** 2 / 2

        ends = starts + 1e-4
        while side * rate(ends + 1e-4) > 0:
            ends += 1e-4
        ends = brentq(rate, ends, ends + 1e-4)
        here = (times > starts) & (times <= ends)
        found[here] = [place(float(s)) for s in times[here]]
        t, x = ends, place(ends)
        if t >= times[-1]:
            return found


@pytest.mark.parametrize("w", [5, 10, 20, 50])
@pytest.mark.parametrize("sliding", [0.2, 0.33])
def test_a_swinging_force_moves_a_block_whatever_the_rows(sliding: float, w: int) -> None:
    for count in COUNTS:
        want = swung(0.33, sliding, 3.4, w, np.linspace(0, 3, count))
        coefficient = f"{{static: 0.33, sliding: {sliding}}}"
        have = rows(coefficient, f"3.4 N*sin({w} rad/s*time)", count)
        assert np.abs(have[:, 0] - want).max() < 1e-9, count


@pytest.mark.parametrize("width", [0.1, 0.01, 0.003])
def test_a_short_pulse_in_a_rest_is_not_passed_over(width: float) -> None:
    # slips from where the pulse passes 3.3 N, and comes to rest long after it
    starts = 1.7 - width * sqrt(log(8 / 3.3))

    def pushed(t: float) -> float:
        return 4 * sqrt(pi) * width * (erf((t - 1.7) / width) - erf((starts - 1.7) / width))

    def moved(t: float) -> float:
        def part(s: float) -> float:
            x = (s - 1.7) / width
            return 4 * sqrt(pi) * width * ((s - 1.7) * erf(x) + width / sqrt(pi) * exp(-(x**2)))

        return (
            part(t)
            - part(starts)
            - 4 * sqrt(pi) * width * erf((starts - 1.7) / width) * (t - starts)
        )

    ends = brentq(lambda t: pushed(t) - 2 * (t - starts), 1.7, 2.9)
    want = moved(ends) - (ends - starts) ** 2
    for count in COUNTS:
        force = f"8 N*exp(-((time - 1.7 s)/({width} s))^2)"
        have = rows("{static: 0.33, sliding: 0.2}", force, count)
        assert abs(have[-1, 0] - want) < 1e-9, count
        assert have[-1, 1] == 0.0


@pytest.mark.parametrize("count", COUNTS)
def test_a_force_that_jumps_within_a_rest_moves_a_block(count: int) -> None:
    # 4 N from 1 s to 1.5 s: 2 m/s2, then -2 m/s2 until 2 s
    force = "2 N*sign(time - 1 s) - 2 N*sign(time - 1.5 s)"
    have = rows("{static: 0.33, sliding: 0.2}", force, count)
    assert have[-1, 0] == pytest.approx(0.5, abs=1e-9)
    assert have[-1, 1] == 0.0


KINKED = {
    # force in words, and the place over time of a block that starts from rest at once
    "-3 N + 1 N*(time > 9 s)": lambda t: -(t**2) / 2,
    "-3 N - 1 N*(time < 9 s)": lambda t: -(t**2),
    "3 N + 1 N*(time < 9 s)": lambda t: t**2,
    "-3 N - 2 N/s*min(time, 9 s)": lambda t: -(t**2) / 2 - t**3 / 3,
    "clip(-3 N/m*A.s, -99 N, 99 N) - 3 N": lambda t: (cos(sqrt(3) * t) - 1) / 3,
    "-abs(3 N + 1 N/m*A.s)": lambda t: cos(t) - 1,
    "if(A.s > 5 m, 9 N, -3 N)": lambda t: -(t**2) / 2,
    "9 N*sign(time - 9 s) + 6 N": lambda t: -(t**2) / 2,
}


@pytest.mark.parametrize("sliding", ["0.2", "{static: 0.25, sliding: 0.2}"])
@pytest.mark.parametrize("force", KINKED)
def test_what_a_load_with_kinks_pushes_from_the_start_goes_at_once(
    force: str, sliding: str
) -> None:
    """On which side of its kinks a load starts decides what sticks, and is known before it."""
    text = BLOCK.format(coefficient=sliding, force=force, count=31).replace("to: 3", "to: 1.2")
    found = mk.loads(text).respond("r", ["A.s", "A.s_ddot"])
    assert (found["row.status"] == "ok").all()
    right = np.array([KINKED[force](t) for t in np.linspace(0, 1.2, 31)])
    assert np.abs(found["A.s"] - right).max() < 1e-8
    second = {True: 1.0, False: -1.0}[right[-1] > 0] * (2 if "< 9" in force else 1)
    assert found["A.s_ddot"][0] == pytest.approx(second, abs=1e-12)


KINKS = ["sign(time - 1 s)", "-sign(1 s - time)", "if(time < 1 s, -1, 1)"]


@pytest.mark.parametrize("kink", KINKS)
def test_a_force_that_a_later_jump_ends_moves_a_block_from_the_start(kink: str) -> None:
    # 5 N for 1 s: 1.7 m/s2, then -3.3 m/s2 to rest
    have = rows("0.33", f"2.5 N*(1 - {kink})", 7)
    time = np.linspace(0, 3, 7)
    late = np.clip(time - 1, 0, 1.7 / 3.3)
    want = 1.7 * np.minimum(time, 1) ** 2 / 2 + 1.7 * late - 3.3 * late**2 / 2
    assert np.abs(have[:, 0] - want).max() < 1e-10
    assert (have[-2:, 1] == 0.0).all()


def test_a_force_that_begins_with_a_later_jump_leaves_a_block_at_rest_until_then() -> None:
    have = rows("0.33", "2.5 N*(1 + sign(time - 1 s))", 7)
    want = 1.7 * np.maximum(np.linspace(0, 3, 7) - 1, 0) ** 2 / 2
    assert np.abs(have[:, 0] - want).max() < 1e-10


@pytest.mark.parametrize("stop", ["A.s_dot <= 0 m/s", "not (A.s_dot > 0 m/s)"])
@pytest.mark.parametrize("count", [2, 4, 7, 8])
def test_a_condition_on_a_rate_holds_where_friction_brings_it_to_rest(
    stop: str, count: int
) -> None:
    text = BLOCK.format(coefficient="0.2", force="0 N", count=count).replace("0 m/s", "3 m/s")
    end = f"count: {count}}}"
    text = text.replace(end, f'{end}, stop: [{{value: "{stop}"}}]')
    found = mk.loads(text).respond("r", ["A.s", "A.s_dot"])
    assert found["time"][-1] == pytest.approx(1.5, abs=1e-12)
    assert found["A.s"][-1] == pytest.approx(2.25, abs=1e-10)
    assert str(found["row.event"][-1])
