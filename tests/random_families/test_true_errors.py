"""Errors that are told, against true ones: random slider-cranks and four-bars by closed forms at
50 digits."""

from __future__ import annotations

import random
from typing import Any

import pytest
from mpmath import mp
from random_families.four_bars import cases

import mechkin_cli as mk

DIGITS = 50
MEASURED = 0.01
"""What a told error may be off by in parts of the true one."""

NOTHING = 1e-19
"""The same in parts of the column's largest: a thousandth of what a double rounds by."""

SLIDER_CRANK = """format: 1
name: slider-crank
units: {{length: mm, angle: deg}}
parameters: {{r: {r} mm, l: {l} mm, e: {e} mm, x: r + sqrt(l^2 - e^2)}}
links: {{crank: {{}}, rod: {{}}, block: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, rod], point: [r, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [rod, block], point: [x, e, 0], axis: [0, 0, 1]}}
  D: {{type: P, links: [ground, block], point: [x, e, 0], axis: [1, 0, 0]}}
motion:
  inputs:
    A.theta:
      {{from: {first}, to: 400, step: {step}, rate: {rate} rad/s, acceleration: {second} rad/s^2}}
"""
NAMES = ("D.s", "D.s_dot", "D.s_ddot")


def drawn(rng: random.Random) -> dict[str, Any]:
    """Decimals, most of which are no doubles."""
    r = rng.uniform(5, 50)
    e = rng.uniform(-0.5, 0.5) * r
    return {
        "r": f"{r:.3f}",
        "e": f"{e:.3f}",
        "l": f"{(r + abs(e)) * rng.uniform(1.02, 4):.3f}",
        "first": f"{rng.uniform(-30, 30):.2f}",
        "step": f"{rng.uniform(5, 20):.2f}",
        "rate": f"{rng.uniform(-3, 3):.3f}",
        "second": f"{rng.uniform(-5, 5):.3f}",
    }


def exact(given: dict[str, Any], row: int) -> tuple[Any, Any, Any]:
    """Slide, rate and acceleration in the file's units."""
    r, length, e, first, step, rate, second = (
        mp.mpf(given[key]) for key in ("r", "l", "e", "first", "step", "rate", "second")
    )
    t = (first + row * step) * mp.pi / 180
    s, c = mp.sin(t), mp.cos(t)
    y, root = r * s - e, mp.sqrt(length**2 - (r * s - e) ** 2)
    by_angle = -r * s - y * r * c / root
    bend = -r * c - ((r * c) ** 2 - y * r * s) / root - (y * r * c) ** 2 / root**3
    slide = r * c + root - (r + mp.sqrt(length**2 - e**2))
    return slide, by_angle * rate, by_angle * second + bend * rate**2


FOUR_BAR = """format: 1
name: four-bar
units: {{length: mm, angle: deg}}
parameters:
  a: {a} mm
  b: {b} mm
  c: {c} mm
  d: {d} mm
  x: a + ((d - a)^2 + b^2 - c^2)/(2*(d - a))
  y: sqrt(b^2 - (x - a)^2)
links: {{crank: {{}}, rod: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}}
  B: {{type: R, links: [crank, rod], point: [a, 0, 0], axis: [0, 0, 1]}}
  C: {{type: R, links: [rod, rocker], point: [x, y, 0], axis: [0, 0, 1]}}
  D: {{type: R, links: [ground, rocker], point: [d, 0, 0], axis: [0, 0, 1]}}
motion:
  inputs:
    A.theta:
      {{from: {first}, to: 400, step: {step}, rate: {rate} rad/s, acceleration: {second} rad/s^2}}
"""
ROCKER = ("D.theta", "D.theta_dot", "D.theta_ddot")


def drawn_four_bar(rng: random.Random) -> dict[str, Any]:
    """Of Grashof: the crank is the shortest and turns, the ground the longest."""
    a = rng.uniform(5, 20)
    b, c = (a * rng.uniform(2, 4) for _ in "bc")
    d = max(b, c) + rng.uniform(0.1, 0.9) * (min(b, c) - a)
    motion = {key: drawn(rng)[key] for key in ("first", "step", "rate", "second")}
    return {"a": f"{a:.3f}", "b": f"{b:.3f}", "c": f"{c:.3f}", "d": f"{d:.3f}"} | motion


def exact_four_bar(given: dict[str, Any], row: int) -> tuple[Any, Any, Any]:
    """Rocker's angle, rate and acceleration in the file's units, by Freudenstein's equation."""
    a, b, c, d, first, step, rate, second = (
        mp.mpf(given[key]) for key in ("a", "b", "c", "d", "first", "step", "rate", "second")
    )

    def rocker(t: Any) -> Any:
        p, q = d - a * mp.cos(t), -a * mp.sin(t)
        square = p**2 + q**2
        return mp.atan2(q, p) + mp.acos((b**2 - c**2 - square) / (2 * c * mp.sqrt(square)))

    t = (first + row * step) * mp.pi / 180
    by_angle, bend = mp.diff(rocker, t), mp.diff(rocker, t, 2)
    angle = (rocker(t) - rocker(mp.mpf(0))) * 180 / mp.pi
    return angle, by_angle * rate, by_angle * second + bend * rate**2


FAMILIES = {
    "slider-cranks": (SLIDER_CRANK, NAMES, drawn, exact),
    "four-bars": (FOUR_BAR, ROCKER, drawn_four_bar, exact_four_bar),
}


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", range(2))
def test_told_errors_are_the_true_ones(seed: int, family: str) -> None:
    text, names, draw, closed_form = FAMILIES[family]
    cells = 0
    for rng in cases(4100 + seed, 6):
        given = draw(rng)
        r = mk.loads(text.format(**given)).analyze(names)
        with mp.workdps(DIGITS):
            rows = [closed_form(given, row) for row in range(r.rows)]
            for name, true in zip(names, zip(*rows, strict=True), strict=True):
                told, size = r.errors[name], max(abs(x) for x in true)
                for value, x, error in zip(r[name], true, told, strict=True):
                    off = abs(mp.mpf(float(value)) - x)
                    assert abs(error - off) <= MEASURED * off + NOTHING * size, (given, name)
                    cells += 1
    assert cells > 400
