"""Masses on slides against closed forms: springs, dampers, laws of time, tables, kinks."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from response.motions import off, respond
from response.oscillators import MASS, lines, slider

import mechkin_cli as mk

EXACT = 1e-11
SECONDS = "time: {from: 0, to: 3, step: 0.125}"


def run(loads: list[str], response: list[str], mass: float = MASS) -> Any:
    rows = [*response, SECONDS, "tolerance: 1e-13"]
    return respond(slider(lines(*loads), lines(*rows, indent=4), mass))


def damped(k: float, c: float, m: float, x0: float, v0: float, t: Any) -> tuple[Any, Any]:
    """x and its rate of m x'' + c x' + k x = 0, at 40 digits."""
    with mp.workdps(40):
        root = mp.sqrt(mp.mpc(mp.mpf(c) ** 2 - 4 * mp.mpf(k) * m))
        a, b = ((-c + sign * root) / (2 * m) for sign in (1, -1))
        p = (v0 - b * x0) / (a - b)
        q = x0 - p
        x = [mp.re(p * mp.exp(a * s) + q * mp.exp(b * s)) for s in map(mp.mpf, t)]
        v = [mp.re(a * p * mp.exp(a * s) + b * q * mp.exp(b * s)) for s in map(mp.mpf, t)]
    return x, v


@pytest.mark.parametrize("c", [0.0, 1.5, 40.0])
def test_a_spring_and_a_damper(c: float) -> None:
    """Undamped, oscillating and creeping."""
    k = 50.0
    found = run(
        [
            f"- {{type: spring, joint: S, coordinate: s, stiffness: {k}}}",
            f"- {{type: damper, joint: S, coordinate: s, damping: {c}}}",
        ],
        ["start: {S.s: 0.3, S.s_dot: -1}"],
    )
    x, v = damped(k, c, MASS, 0.3, -1.0, found["time"])
    assert off(found["S.s"], x) < EXACT
    assert off(found["S.s_dot"], v) < EXACT
    x, v = (np.array(y, dtype=float) for y in (x, v))
    assert off(found["S.s_ddot"], -(k * x + c * v) / MASS) < 10 * EXACT
    kinetic, potential = MASS * v**2 / 2, k * x**2 / 2
    assert off(found["row.kinetic_energy"], kinetic) < EXACT
    assert off(found["row.potential_energy"], potential) < EXACT
    lost = kinetic[0] + potential[0] - kinetic - potential
    assert off(found["row.dissipated"], lost) < EXACT
    assert off(found["row.work"], 0 * lost) < EXACT


def test_a_stiff_spring_and_damper() -> None:
    """Rates of -20 and -1980 per second: what an explicit method pays for."""
    k, c, m = 8e5, 4e4, 20.0
    found = run(
        [
            f"- {{type: spring, joint: S, coordinate: s, stiffness: {k}}}",
            f"- {{type: damper, joint: S, coordinate: s, damping: {c}}}",
        ],
        ["start: {S.s: 0.3, S.s_dot: -1}"],
        m,
    )
    x, v = damped(k, c, m, 0.3, -1.0, found["time"])
    assert off(found["S.s"], x) < 1e-10
    assert off(found["S.s_dot"], v) < 1e-9


def shaken(k: float, c: float, m: float, force: float, w: float, t: Any) -> tuple[Any, Any]:
    """x and its rate of m x'' + c x' + k x = force sin(w t) from x = 0.01 at rest, at 60 digits."""
    with mp.workdps(60):
        k, c, m, force, w = map(mp.mpf, (k, c, m, force, w))
        far = force / mp.mpc(k - m * w**2, c * w)
        root = mp.sqrt(mp.mpc(c**2 - 4 * k * m))
        a, b = ((-c + sign * root) / (2 * m) for sign in (1, -1))
        x0, v0 = mp.mpf(0.01) - mp.im(far), -w * mp.re(far)
        p = (v0 - b * x0) / (a - b)
        terms = [(p, a), (x0 - p, b), (-1j * far, 1j * w)]
        moments = list(map(mp.mpf, t))
        x = [mp.re(sum(y * mp.exp(r * s) for y, r in terms)) for s in moments]
        v = [mp.re(sum(y * r * mp.exp(r * s) for y, r in terms)) for s in moments]
    return x, v


@pytest.mark.parametrize("power", range(-12, 13, 3))
def test_time_constants_far_from_the_duration(power: int) -> None:
    """m/c and sqrt(m/k), down to and up to 1e12 times the second that the motion takes."""
    m, force, w = 1.0, 100.0, 3.0
    constant = 10.0**power
    for k, c in ((1.0, m / constant), (m / constant**2, 2.1 * m / constant), (1e6, 1e9)):
        found = respond(
            slider(
                lines(
                    f"- {{type: spring, joint: S, coordinate: s, stiffness: {k!r}}}",
                    f"- {{type: damper, joint: S, coordinate: s, damping: {c!r}}}",
                    f'- {{type: force, joint: S, value: "{force} N*sin({w} rad/s*time)"}}',
                ),
                lines("start: {S.s: 0.01}", "time: {from: 0, to: 1, count: 13}", indent=4),
                m,
            )
        )
        x, v = shaken(k, c, m, force, w, found["time"])
        assert off(found["S.s"], x) < 1e-10
        assert off(found["S.s_dot"], v) < 1e-10


def test_a_damper_that_nothing_moves() -> None:
    """Between points of links that are welded together: rate and work are rounding."""
    text = """format: 1
name: damper on a rigid part
links:
  one: {mass: 2, center_of_mass: [0.3, 0.1, 0.4], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
  two: {mass: 1, center_of_mass: [0.2, 0.7, 0.1], inertia: {xx: 0.1, yy: 0.1, zz: 0.1}}
joints:
  A: {type: R, links: [ground, one], point: [0, 0, 0], axis: [0.3, 0.5, 0.7]}
  W: {type: W, links: [one, two]}
points:
  p: {link: one, at: [0.31, 0.77, 0.13]}
  q: {link: two, at: [0.73, -0.41, 0.57]}
loads:
  - {type: gravity, g: [0, 3, -9.81]}
  - {type: damper, between: [p, q], damping: 50}
responses:
  run:
    start: {A.theta: 0}
    time: {from: 0, to: 2, step: 0.25}
    tolerance: 1e-13
"""
    found = respond(text)
    free = respond(text.replace("damping: 50", "damping: 0"))
    assert off(found["A.theta"], free["A.theta"]) < EXACT
    assert np.max(np.abs(found["row.dissipated"])) < 1e-20


def test_resonance_grows_in_proportion_to_time() -> None:
    """m x'' + k x = F cos(w t), w^2 = k / m: x = F t sin(w t) / (2 m w)."""
    k, force = 32.0, 3.0
    w = math.sqrt(k / MASS)
    found = run(
        [f"- {{type: spring, joint: S, coordinate: s, stiffness: {k}}}"],
        ["start: {S.s: 0}", f"efforts: {{S.s: {force} N*cos({w!r} rad/s*time)}}"],
    )
    t = found["time"]
    x = force * t * np.sin(w * t) / (2 * MASS * w)
    v = force * (np.sin(w * t) + w * t * np.cos(w * t)) / (2 * MASS * w)
    assert off(found["S.s"], x) < EXACT
    assert off(found["S.s_dot"], v) < EXACT
    energy = MASS * v**2 / 2 + k * x**2 / 2
    assert off(found["row.work"], energy) < EXACT
    assert off(found["S.effort"], force * np.cos(w * t)) < EXACT


def test_efforts_add_to_loads() -> None:
    """A load and an effort at one coordinate: the sum is what moves it, the effort is printed."""
    found = run(
        ["- {type: force, joint: S, value: 3}"],
        ["start: {S.s: 0}", "efforts: {S.s: -7}"],
    )
    t = found["time"]
    assert off(found["S.s"], -4 / MASS * t**2 / 2) < EXACT
    assert off(found["S.effort"], 0 * t - 7) < EXACT


def test_two_masses_in_a_row() -> None:
    """Springs k1 to ground and k2 between: the sum of two eigenmodes, at 40 digits."""
    text = """format: 1
name: two masses
links:
  one: {mass: 2, center_of_mass: [0, 0, 0]}
  two: {mass: 3, center_of_mass: [0, 0, 1]}
joints:
  A: {type: P, links: [ground, one], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: P, links: [one, two], point: [0, 0, 1], axis: [0, 0, 1]}
loads:
  - {type: spring, joint: A, coordinate: s, stiffness: 40}
  - {type: spring, joint: B, coordinate: s, stiffness: 25, free: 0.1}
responses:
  run:
    start: {A.s: 0.2, B.s: -0.3, A.s_dot: 0, B.s_dot: 1}
    time: {from: 0, to: 4, step: 0.25}
    tolerance: 1e-13
"""
    found = respond(text)
    with mp.workdps(40):
        k1, k2, m1, m2 = map(mp.mpf, (40, 25, 2, 3))
        # absolute displacements from rest: B rests stretched by its free value
        stiffness = mp.matrix([[k1 + k2, -k2], [-k2, k2]])
        root = mp.diag([mp.sqrt(m1), mp.sqrt(m2)])
        squares, modes = mp.eigsy(root**-1 * stiffness * root**-1)
        at = root * mp.matrix([mp.mpf("0.2"), mp.mpf("0.2") - mp.mpf("0.3") - mp.mpf("0.1")])
        rate = root * mp.matrix([0, 1])
        first, second = [], []
        for t in map(mp.mpf, found["time"]):
            y = mp.matrix(2, 1)
            for i in range(2):
                w, mode = mp.sqrt(squares[i]), modes[:, i]
                share = (mode.T * at)[0] * mp.cos(w * t) + (mode.T * rate)[0] * mp.sin(w * t) / w
                y += share * mode
            x = root**-1 * y
            first.append(x[0])
            second.append(x[1] - x[0] + mp.mpf("0.1"))
    assert off(found["A.s"], first) < EXACT
    assert off(found["B.s"], second) < EXACT


def test_a_table_over_the_coordinate_is_its_spline(tmp_path: Path) -> None:
    """A cubic spline through points of a line is the line: a spring of 50 N/m."""
    rows = "\n".join(f"{x},{-50 * x}" for x in (-2, -1.3, -0.4, 0, 0.7, 1.1, 2))
    (tmp_path / "force.csv").write_text(f"s,force\n{rows}\n", encoding="utf-8")
    loads = lines("- {type: force, joint: S, value: {table: force.csv}}")
    response = lines("start: {S.s: 0.3, S.s_dot: -1}", SECONDS, "tolerance: 1e-13", indent=4)
    path = tmp_path / "table.yaml"
    path.write_text(slider(loads, response), encoding="utf-8")
    found = mk.load(str(path)).respond("run")
    x, v = damped(50, 0, MASS, 0.3, -1.0, found["time"])
    assert off(found["S.s"], x) < EXACT
    assert off(found["S.s_dot"], v) < EXACT


def test_a_table_over_time_is_its_spline(tmp_path: Path) -> None:
    """A cubic spline through points of a cubic is the cubic: F = 1 - 2 t + 3 t^2 - t^3."""
    cubic = np.polynomial.Polynomial([1, -2, 3, -1])
    rows = "\n".join(f"{t!r},{float(cubic(t))!r}" for t in (0.0, 0.5, 1.1, 1.7, 2.4, 3.0))
    (tmp_path / "force.csv").write_text(f"t,force\n{rows}\n", encoding="utf-8")
    loads = lines(
        "- {type: force, link: block, point: [0, 0, 0.1], force: [{table: force.csv}, 0, 0]}"
    )
    response = lines("start: {S.s: 0}", SECONDS, "tolerance: 1e-13", indent=4)
    path = tmp_path / "table.yaml"
    path.write_text(slider(loads, response), encoding="utf-8")
    found = mk.load(str(path)).respond("run")
    t = found["time"]
    assert off(found["S.s_dot"], cubic.integ()(t) / MASS) < EXACT
    assert off(found["S.s"], cubic.integ(2)(t) / MASS) < EXACT


def halves(w: tuple[float, float], v0: float, times: Any) -> tuple[Any, Any]:
    """Half oscillations of rates w to either side of zero, from zero upwards at v0."""
    x, v = [], []
    turn = [math.pi / w[0], math.pi / w[1]]
    for t in times:
        left = math.fmod(t, sum(turn))
        side = int(left >= turn[0])
        left -= side * turn[0]
        sign = 1 - 2 * side
        x.append(sign * v0 / w[side] * math.sin(w[side] * left))
        v.append(sign * v0 * math.cos(w[side] * left))
    return x, v


def test_a_spring_with_a_kink() -> None:
    """-k s - d |s|: two half oscillations by turns, 12 kinks."""
    found = run(
        ["- {type: force, joint: S, value: '-200 N/m*S.s - 120 N/m*abs(S.s)'}"],
        ["start: {S.s: 0, S.s_dot: 1.5}"],
    )
    w = (math.sqrt(320 / MASS), math.sqrt(80 / MASS))
    x, v = halves(w, 1.5, found["time"])
    assert off(found["S.s"], x) < 1e-10
    assert off(found["S.s_dot"], v) < 1e-10


def test_a_force_that_changes_its_sign() -> None:
    """-F sign(s): parabolas by turns; every half lasts 2 m v / F."""
    force, v0 = 6.0, 1.5
    found = run(
        [f"- {{type: force, joint: S, value: '-{force} N*sign(S.s)'}}"],
        ["start: {S.s: 0.001, S.s_dot: 1.5}"],
    )
    a = force / MASS
    v0 = math.sqrt(v0**2 + 2 * a * 0.001)
    begin = (v0 - 1.5) / a
    x, v = [], []
    for t in found["time"]:
        half, left = divmod(t + begin, 2 * v0 / a)
        sign = 1 - 2 * (half % 2)
        x.append(sign * (v0 * left - a * left**2 / 2))
        v.append(sign * (v0 - a * left))
    assert off(found["S.s"], x) < 1e-10
    assert off(found["S.s_dot"], v) < 1e-10


def test_a_force_between_limits() -> None:
    """min and max: a spring that yields. Energy of a saturating spring, and both pieces' forces."""
    found = run(
        ["- {type: force, joint: S, value: 'max(-2 N, min(2 N, -50 N/m*S.s))'}"],
        ["start: {S.s: 0, S.s_dot: 1}"],
    )
    # within 0.04 m an oscillator of rate 5 rad/s, beyond it a parabola
    w, a, edge = 5.0, 1.0, 0.04
    inside = math.asin(edge * w) / w
    v1 = math.sqrt(1 - (edge * w) ** 2)
    beyond = 2 * v1 / a
    half = 2 * inside + beyond
    x, v = [], []
    for t in found["time"]:
        count, left = divmod(t, half)
        sign = 1 - 2 * (count % 2)
        if left < inside or left > inside + beyond:
            left = left if left < inside else left - half
            # the way back mirrors the way out
            x.append(sign * abs(math.sin(w * left)) / w)
            v.append(sign * math.cos(w * left) * (1 if left >= 0 else -1))
        else:
            left -= inside
            x.append(sign * (edge + v1 * left - a * left**2 / 2))
            v.append(sign * (v1 - a * left))
    assert off(found["S.s"], x) < 1e-10
    assert off(found["S.s_dot"], v) < 1e-10
