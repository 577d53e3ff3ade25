"""Random links, joints and laws of mechanism files, assembled as drawn."""

from __future__ import annotations

import random
from typing import Any

DIRECTION = {"Sp": "normal", "Sg": "groove", "E": "normal"}
"""The key of a joint's direction where it is not `axis`."""


def number(value: float) -> str:
    """Six digits, exact in the file and in the oracle."""
    return f"{value:.6g}"


def vector(rng: random.Random, size: float) -> list[str]:
    """Components between -size and size."""
    return [number(size * rng.uniform(-1, 1)) for _ in range(3)]


def body(rng: random.Random, size: float) -> dict[str, Any]:
    """Mass, mass centre and an inertia that a real body can have."""
    mass = rng.uniform(0.5, 3)
    unit = mass * size * size * 0.1
    # diagonals and products in these ranges keep the triangle inequalities of the principal moments
    inertia = {key: number(unit * rng.uniform(1, 1.3)) for key in ("xx", "yy", "zz")}
    inertia |= {key: number(unit * rng.uniform(-0.1, 0.1)) for key in ("xy", "xz", "yz")}
    return {"mass": number(mass), "center_of_mass": vector(rng, size), "inertia": inertia}


def joint(rng: random.Random, kind: str, links: list[str], size: float) -> dict[str, Any]:
    """A joint of any type at a random place, as drawn for both links."""
    drawn: dict[str, Any] = {"type": kind, "links": links}
    if kind == "W":
        return drawn
    drawn["point"] = vector(rng, size)
    if kind != "S":
        drawn[DIRECTION.get(kind, "axis")] = direction = axis(rng)
    if kind == "U":
        drawn["axis2"] = _slanted(rng, direction)
    if kind == "E":
        drawn["x"] = _square(direction)
    if kind == "H":
        drawn["lead"] = number(size * rng.choice((-1, 1)) * rng.uniform(0.2, 2))
    return drawn


def _slanted(rng: random.Random, direction: list[str]) -> list[str]:
    """A direction at more than 37 degrees to another."""
    a = [float(x) for x in direction]
    while True:
        drawn = axis(rng)
        b = [float(x) for x in drawn]
        along, a2, b2 = (
            sum(x * y for x, y in zip(*v, strict=True)) for v in ((a, b), (a, a), (b, b))
        )
        if along * along < 0.64 * a2 * b2:
            return drawn


def _square(direction: list[str]) -> list[str]:
    """A direction square to another to the last digit: two components exchanged."""
    least = min(range(3), key=lambda i: abs(float(direction[i])))
    i, j = (least + 1) % 3, (least + 2) % 3
    square = ["0"] * 3
    square[i], square[j] = direction[j], negated(direction[i])
    return square


def negated(text: str) -> str:
    """A written number with its sign changed."""
    return text[1:] if text[0] == "-" else "-" + text


def axis(rng: random.Random) -> list[str]:
    """Not of length one, and not short."""
    while True:
        drawn = [rng.uniform(-1, 1) for _ in range(3)]
        if sum(x * x for x in drawn) > 0.1:
            return [number(x) for x in drawn]


def law(rng: random.Random, driven: str, size: float, rows: int) -> dict[str, str]:
    """Rows over four degrees, or 4 % of the size, to either side of home."""
    turning = driven.rpartition(".")[2].startswith("theta")
    reach, scale = ("4 deg", 1.0) if turning else (number(0.04 * size), size)
    unit = " rad/s" if turning else ""
    rate, acceleration = rng.uniform(0.3, 1), rng.uniform(-1, 1)
    return {
        "from": "-" + reach,
        "to": reach,
        "count": str(rows),
        "rate": number(scale * rate) + unit,
        "acceleration": number(scale * acceleration) + (unit and " rad/s^2"),
        "jerk": number(scale * rate * acceleration) + (unit and " rad/s^3"),
    }
