"""How the input goes: swept in coarse or fine steps, either way, up to ten turns, or by a law."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
MOST_ROWS = 400
STEPS = (0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0)
SPANS = (90, 200, 360, 360, 400, 720, 3600)


@dataclass(frozen=True)
class Travel:
    """Values of the input in degrees by row, and the highest and lowest met on the way there.

    `head` stands before the inputs, `text` is the first input's entry.
    """

    rows: Array
    highest: Array
    lowest: Array
    text: str
    head: str = ""


def monotone(rows: Array, text: str, head: str = "") -> Travel:
    """The highest and the lowest are the first row and the row itself."""
    return Travel(rows, np.maximum(rows, rows[0]), np.minimum(rows, rows[0]), text, head)


def swept(rng: random.Random) -> Travel:
    step = rng.choice([rng.choice(STEPS), round(10 ** rng.uniform(-1, 1.95), 3)])
    span = min(rng.choice(SPANS), step * MOST_ROWS)
    way = rng.choice([-1, 1])
    count = int(span / step + 1e-9) + 1
    rows = np.array([way * step * k for k in range(count)])
    return monotone(rows, f"{{from: 0, to: {way * (count - 1) * step!r}, step: {step!r}}}")


def rising(rng: random.Random) -> Travel:
    """A harmonic rise from the drawing on."""
    end = rng.choice([-1, 1]) * float(rng.choice(SPANS))
    count = rng.choice([5, 21, 101, 301])
    u = np.arange(count) / (count - 1)
    rows = end * (1 - np.cos(math.pi * u)) / 2
    head = f"  time: {{from: 0, to: {count - 1}, step: 1}}\n"
    return monotone(rows, f"{{law: harmonic, from: 0, to: {end!r}}}", head)


def swinging(rng: random.Random) -> Travel:
    """Out and back in rows that may all lie before what the swing meets."""
    peak = rng.choice([-1, 1]) * float(rng.choice([30, 60, 90, 170, 300, 500]))
    count = rng.choice([3, 5, 9, 41, 201])
    last = count - 1
    half = last / 2
    rate, acceleration = 2 * peak / half, -2 * peak / half**2
    time = np.arange(count, dtype=float)
    rows = rate * time + acceleration * time**2 / 2
    extreme = np.where(time >= half, peak, rows)
    zero = np.zeros_like(rows)
    text = (
        f"{{law: constant-acceleration, at: 0, rate: {rate!r} deg/s, "
        f"acceleration: {acceleration!r} deg/s^2}}"
    )
    return Travel(
        rows,
        np.maximum(zero, np.maximum(extreme, rows)),
        np.minimum(zero, np.minimum(extreme, rows)),
        text,
        f"  time: {{from: 0, to: {last}, step: 1}}\n",
    )


def travelled(rng: random.Random) -> Travel:
    return rng.choice([swept, swept, swept, swept, swept, rising, swinging])(rng)
