"""A double pendulum: its equations of motion are short enough to be written by hand."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from benchmarks.responses.extrapolation import extrapolated

LENGTH, CENTRE, INERTIA, GRAVITY = 1.0, 0.5, 0.08, 9.81
START, DURATION, ROWS = (0.0, 0.5), 3.0, 13
PARTS = 16
"""Steps of the extrapolation between two rows; twice as many change 6e-16."""

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


def moments() -> Any:
    """The times of the rows (rows,) in s."""
    return np.linspace(0.0, DURATION, ROWS)


def rates(_: Any, y: Any) -> Any:
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


def exact_motion() -> Any:
    """Both angles (2, rows) in numpy's widest numbers."""
    start = [*START, 0.0, 0.0]
    return extrapolated(partial(rates, None), start, moments(), PARTS)[:2]
