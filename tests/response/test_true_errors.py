"""True errors of responses: the repetition against closed forms at 40 digits, and what is said
where there is none."""

from __future__ import annotations

import os
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from response.test_pendulums import PENDULUM

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

DIGITS = 40
KNOWN = 1e-20
"""What the repetition may be off by in parts of the largest value: far below 1e-16."""

MEASURED = 0.01
"""What a measured error may be off by in parts of it."""

SLIDER = """format: 1
name: slider
units: {{length: m}}
links: {{block: {{mass: 2, center_of_mass: [0, 0, 0]}}}}
joints:
  S: {{type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}
loads: {loads}
responses:
  run:
    start: {{S.s: 0.3, S.s_dot: 1.1}}
    time: {{from: 0, to: 2, step: 0.25}}
    tolerance: {tolerance}
"""


def true_values(r: Any, name: str) -> Any:
    """The repeated numbers of a quantity, as mpmath's."""
    value = r.errors.repeated.quantity(name).value
    return [mp.mpf(float(h)) + mp.mpf(float(x)) for h, x in zip(value.high, value.low, strict=True)]


def check(r: Any, name: str, exact: list[Any]) -> None:
    """The repetition and the errors that it tells, against exact values in SI and file units."""
    size = max(abs(x) for x in exact)
    repeated = true_values(r, name)
    assert max(abs(a - b) for a, b in zip(repeated, exact, strict=True)) < KNOWN * size
    off = [abs(mp.mpf(float(x)) - y) for x, y in zip(r[name], exact, strict=True)]
    told = r.errors[name]
    for one, other in zip(told, off, strict=True):
        assert abs(one - other) <= MEASURED * other + 1e-18 * size


def moments(count: int) -> list[Any]:
    return [mp.mpf(k) / 4 for k in range(count)]


@pytest.mark.parametrize("tolerance", ["1e-13", "1e-5", *(["1e-9"] if TIMES > 1 else [])])
def test_a_pendulum(tolerance: str) -> None:
    """From rest: sin(theta/2) = k cd(w t), k = sin(start/2); the start is the text's 2.1 rad."""
    text = PENDULUM.format(angle="2.1", rate=0).replace("1e-13", tolerance)
    r = mk.loads(text).respond("run")
    with mp.workdps(DIGITS):
        inertia, pull = mp.mpf("0.7"), mp.mpf("9.81")
        w, k = mp.sqrt(pull / inertia), mp.sin(mp.mpf("2.1") / 2)
        cd, sd = mp.ellipfun("cd"), mp.ellipfun("sd")
        nd = mp.ellipfun("nd")
        at = [w * t for t in moments(17)]
        angles = [2 * mp.asin(k * cd(u, m=k * k)) for u in at]
        # (sin(theta/2))' = -k w k'^2 sd nd
        rates = [
            -2 * k * w * (1 - k * k) * sd(u, m=k * k) * nd(u, m=k * k) / mp.cos(a / 2)
            for u, a in zip(at, angles, strict=True)
        ]
        check(r, "A.theta", angles)
        check(r, "A.theta_dot", rates)
        check(r, "A.theta_ddot", [-w * w * mp.sin(a) for a in angles])
        check(r, "row.kinetic_energy", [inertia * v * v / 2 for v in rates])


@pytest.mark.parametrize("tolerance", ["1e-13", "1e-6"])
def test_a_spring_a_damper_and_a_force_of_time(tolerance: str) -> None:
    """m x'' + c x' + k x = F cos(w t): the particular solution and a decaying oscillation; what is
    dissipated and the work are integrals of squares and products of them."""
    at = "joint: S, coordinate: s"
    loads = (
        f"[{{type: spring, {at}, stiffness: 50 N/m}}, {{type: damper, {at}, damping: 1.7 N*s/m}},"
        " {type: force, joint: S, value: '0.7 N*cos(3.3 rad/s*time)'}]"
    )
    r = mk.loads(SLIDER.format(loads=loads, tolerance=tolerance)).respond("run")
    with mp.workdps(DIGITS):
        m, k, c, f, w = (mp.mpf(x) for x in ("2", "50", "1.7", "0.7", "3.3"))
        steady = f / (k - m * w * w + 1j * c * w)
        root = (-c + mp.sqrt(c * c - 4 * m * k)) / (2 * m)
        x0, v0 = mp.mpf("0.3") - steady.real, mp.mpf("1.1") - (1j * w * steady).real
        # x = Re(a e^(root t)) + Re(steady e^(i w t))
        a = x0 + 1j * (x0 * root.real - v0) / root.imag

        def x(t: Any) -> Any:
            return (a * mp.exp(root * t) + steady * mp.expj(w * t)).real

        def v(t: Any) -> Any:
            return (a * root * mp.exp(root * t) + 1j * w * steady * mp.expj(w * t)).real

        times = moments(9)
        check(r, "S.s", [x(t) for t in times])
        check(r, "S.s_dot", [v(t) for t in times])
        for name, power in (
            ("row.dissipated", lambda t: c * v(t) ** 2),
            ("row.work", lambda t: f * mp.cos(w * t) * v(t)),
        ):
            parts = [mp.quad(power, [s, t]) for s, t in pairwise(times)]
            check(r, name, [mp.fsum(parts[:n]) for n in range(len(times))])


def test_a_kink_is_passed_exactly() -> None:
    """-F sign(s): parabolas by turns, whose corners no node of a step lies on."""
    loads = "[{type: force, joint: S, value: '-6 N*sign(S.s)'}]"
    r = mk.loads(SLIDER.format(loads=loads, tolerance="1e-12")).respond("run")
    with mp.workdps(DIGITS):
        a, x0, v0 = mp.mpf(3), mp.mpf("0.3"), mp.mpf("1.1")
        top = mp.sqrt(v0**2 + 2 * a * x0)
        begin = (top - v0) / a
        exact = []
        for t in moments(9):
            half = mp.floor((t + begin) / (2 * top / a))
            left = t + begin - half * 2 * top / a
            exact.append((1 - 2 * (half % 2)) * (top * left - a * left**2 / 2))
        repeated = true_values(r, "S.s")
        assert max(abs(p - q) for p, q in zip(repeated, exact, strict=True)) < KNOWN
        check(r, "S.s", exact)


RUBBING = "[{type: friction, joint: S, coefficient: 0.2}, {type: gravity, g: [0, 0, -9.81]}]"


def test_friction_is_not_repeated_and_says_so() -> None:
    r = mk.loads(SLIDER.format(loads=RUBBING, tolerance="1e-9")).respond("run")
    why = "friction of S: when what rubs sticks and slips is found in doubles"
    assert set(r.errors.why.values()) == {why, "words"}
    assert r.errors.digits is None


def test_the_row_of_a_stop_is_not_measured() -> None:
    text = SLIDER.format(loads="[]", tolerance="1e-9") + "    stop: [{value: S.s, at: 1 m}]\n"
    r = mk.loads(text).respond("run")
    column = next(c for c in r.errors.columns if c.label == "S.s")
    assert column.lost == 1
    assert column.lost_why == "the moment of a stop"
    assert np.isfinite(column.error[:-1]).all()
