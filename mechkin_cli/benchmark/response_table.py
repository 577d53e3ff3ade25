"""Responses: time against error over tolerances, beside scipy's integrator of the same order.

A double pendulum: its equations of motion are short enough to be written by hand, and the exact
motion comes from the classical Runge-Kutta method in numbers of 64 bits with small equal steps.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from importlib import import_module
from typing import Any

import numpy as np

from mechkin_cli.benchmark.report import Cell, Column, Table
from mechkin_cli.benchmark.timing import in_turns
from mechkin_cli.interface import Model, loads

TOLERANCES = tuple(10.0**-k for k in (4, 6, 8, 10, 12))
LENGTH, CENTRE, INERTIA, GRAVITY = 1.0, 0.5, 0.08, 9.81
START, DURATION, ROWS = (0.0, 0.5), 3.0, 13
EXACT_STEPS = 6000
"""In all; with half as many the leading error, of the fourth power of a step, is taken out."""

MILLI = 1000.0

TEXT = """format: 1
name: double pendulum
units: {{angle: rad}}
links:
  upper: {{mass: 1, center_of_mass: [0.5, 0, 0], inertia: {{xx: 0.001, yy: 0.08, zz: 0.08}}}}
  lower: {{mass: 1, center_of_mass: [1.5, 0, 0], inertia: {{xx: 0.001, yy: 0.08, zz: 0.08}}}}
joints:
  A: {{type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 1, 0]}}
  B: {{type: R, links: [upper, lower], point: [1, 0, 0], axis: [0, 1, 0]}}
loads: [{{type: gravity, g: [0, 0, -9.81]}}]
responses:
  run:
    start: {{A.theta: 0, B.theta: 0.5}}
    time: {{from: 0, to: 3, step: 0.25}}
    tolerance: {tolerance}
"""

COLUMNS = (
    Column("method", "method"),
    Column("tolerance", "tole-\nrance", "error"),
    Column("milliseconds", "ms", "time"),
    Column("spread", "+-\n%", "percent"),
    Column("error", "largest\nerror, rad", "error"),
)


def response_table(rounds: int, tolerances: tuple[float, ...] = TOLERANCES) -> Table:
    """mechkin and scipy over their tolerances."""
    exact = exact_motion()
    calls: dict[tuple[str, float], Callable[[], Any]] = {}
    notes = [
        f"{DURATION:g} s, {ROWS} rows; the model is read before, the response runs anew each time."
    ]
    for tolerance in tolerances:
        model = loads(TEXT.format(tolerance=repr(tolerance)), "double pendulum")
        calls["mechkin, respond()", tolerance] = partial(_responded, model)
    try:
        integrate = import_module("scipy.integrate").solve_ivp
        for tolerance in tolerances:
            calls["scipy, solve_ivp DOP853", tolerance] = partial(_integrated, integrate, tolerance)
    except ImportError:
        notes.append("scipy is left out: it is not installed (pip install 'mechkin[bench]')")
    times = in_turns(calls, rounds)
    lines: list[dict[str, Cell]] = []
    for (name, tolerance), timing in times.items():
        found = calls[name, tolerance]()
        lines.append(
            {
                "method": name,
                "tolerance": tolerance,
                "milliseconds": MILLI * timing.median,
                "spread": timing.spread,
                "error": float(np.max(np.abs(found - exact))),
            }
        )
    title = "Response of a double pendulum: time against error"
    return Table("responses", title, COLUMNS, lines, tuple(notes))


def _responded(model: Model) -> Any:
    found = model.respond("run", ["A.theta", "B.theta"], tables=[], threads=1)
    return np.array([found["A.theta"], found["B.theta"]])


def _integrated(integrate: Any, tolerance: float) -> Any:
    moments = np.linspace(0.0, DURATION, ROWS)
    start = [*START, 0.0, 0.0]
    limits = {"rtol": tolerance, "atol": tolerance}
    return integrate(_rates, (0.0, DURATION), start, "DOP853", moments, **limits).y[:2]


def _rates(_: Any, y: Any) -> Any:
    """First derivatives of both angles (the lower against the upper) and their rates; angles turn
    about y, so that what is at x falls along -z where they grow."""
    one, two, u, v = y
    bend, slope = LENGTH * CENTRE * np.cos(two), LENGTH * CENTRE * np.sin(two)
    # inertia of both angles about the pins, unit masses
    outer = 2.0 * INERTIA + 2.0 * CENTRE * CENTRE + LENGTH * LENGTH + 2.0 * bend
    inner = INERTIA + CENTRE * CENTRE
    mixed = inner + bend
    lower = GRAVITY * CENTRE * np.cos(one + two)
    upper = GRAVITY * (CENTRE + LENGTH) * np.cos(one) + lower
    first = upper + slope * (2.0 * u * v + v * v)
    second = lower - slope * u * u
    determinant = outer * inner - mixed * mixed
    a = (inner * first - mixed * second) / determinant
    b = (outer * second - mixed * first) / determinant
    return np.array([u, v, a, b])


@cache
def exact_motion() -> Any:
    """Both angles (2, rows) in numbers of 64 bits of mantissa."""
    coarse, fine = (_equal_steps(EXACT_STEPS // n) for n in (2, 1))
    return fine + (fine - coarse) / 15


def _equal_steps(steps: int) -> Any:
    y = np.array([*START, 0.0, 0.0], np.longdouble)
    step = np.longdouble(DURATION) / steps
    found = [y[:2]]
    for number in range(1, steps + 1):
        one = _rates(None, y)
        two = _rates(None, y + step / 2 * one)
        three = _rates(None, y + step / 2 * two)
        four = _rates(None, y + step * three)
        y = y + step / 6 * (one + 2 * two + 2 * three + four)
        if number % (steps // (ROWS - 1)) == 0:
            found.append(y[:2])
    return np.array(found).T
