"""The own point of a body's rod, chosen so that its dead centres are almost met, or are met.

For the other end m(t) of the rod, as seen from the axis, the longest and the shortest rod that
reaches a circle of radius r at height h are

    L^2 = (m.u - h)^2 + (|m across u| +- r)^2.

The crank turns fully for lengths between the largest shortest and the least longest; next to these
two it passes a change point. A slide asks for a rod longer than the largest distance from its line.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from random_families.no_wrong_row.branch import TURN, Undecided, way
from random_families.no_wrong_row.drawing import Drawing, Vector
from random_families.no_wrong_row.field import FAST
from random_families.no_wrong_row.linkage import Point

Array = NDArray[np.float64]


class Impossible(Exception):
    """No such body: draw another one."""


def random_unit(rng: random.Random) -> Vector:
    while True:
        v = np.array([rng.uniform(-1, 1) for _ in range(3)])
        if 0.1 < np.linalg.norm(v) < 1:
            return np.asarray(v / np.linalg.norm(v))


def across(u: Vector, rng: random.Random) -> Vector:
    """A unit vector normal to u."""
    v = np.cross(u, random_unit(rng))
    return np.asarray(v / np.linalg.norm(v))


class Seen:
    """Where the rod's other end goes, as seen from the parent of the new body."""

    def __init__(self, drawing: Drawing, other: Point, parent: str) -> None:
        self.linkage, self.other, self.parent = drawing.linkage(), other, parent
        self.places = np.linspace(0, TURN, 361)
        if any(body.rod for body in drawing.bodies):
            try:
                up, down = way(self.linkage, 1, TURN), way(self.linkage, -1, TURN)
            except Undecided:
                raise Impossible from None
            low, high = max(-math.pi, -down.end), min(math.pi, up.end)
            if up.end == math.inf:
                low, high = 0.0, TURN
            self.places = np.linspace(low, high, 361)

    def at(self, t: Array) -> Array:
        """Places (3, t)."""
        placed = self.linkage.at(t, FAST)
        there = placed.pose[self.other.body].place(self.other.drawn(FAST))
        seen = placed.pose[self.parent].seen(there)
        return np.array([np.broadcast_to(x, t.shape) for x in seen])

    def largest(self, f: Callable[[Array], Array]) -> float:
        """The largest value of a function of the place (3, t) along the way."""
        t = self.places
        low, high = t[0], t[-1]
        for _ in range(7):
            values = f(self.at(t))
            best = int(np.argmax(values))
            ends = t[max(best - 1, 0)], t[min(best + 1, len(t) - 1)]
            t = np.clip(np.linspace(*ends, 41), low, high)
        return float(values.max())


def wanted_length(rng: random.Random, shortest: float, longest: float, gap: float) -> float:
    """A length near one of the two, or away from both."""
    choice = rng.random()
    inside = 1 if rng.random() < 0.85 else -1
    if choice < 0.4:
        return longest - inside * gap
    if choice < 0.8:
        return shortest + inside * gap
    return rng.uniform(shortest, longest)


def on_circle(
    rng: random.Random, seen: Seen, foot: Vector, u: Vector, radius: float, height: float,
    gap: float,
) -> Vector:  # fmt: skip
    """The own point of a turning body.

    Raises:
        Impossible: none, or one too near to a dead centre where it is drawn.
    """

    def parts(p: Array) -> tuple[Array, Array]:
        m = p - foot[:, None]
        along = u @ m
        return along - height, np.sqrt(np.maximum((m * m).sum(0) - along**2, 0))

    def far(p: Array) -> Array:
        a, r = parts(p)
        return -np.sqrt(a**2 + (r + radius) ** 2)

    def near(p: Array) -> Array:
        a, r = parts(p)
        return np.sqrt(a**2 + (r - radius) ** 2)

    length = wanted_length(rng, seen.largest(near), -seen.largest(far), gap)
    m = seen.at(np.zeros(1))[:, 0] - foot
    along = float(u @ m)
    flat = m - along * u
    reach = float(np.linalg.norm(flat))
    if reach < 1e-3:
        raise Impossible
    cosine = ((along - height) ** 2 + reach**2 + radius**2 - length**2) / (2 * reach * radius)
    if abs(cosine) > 0.97 or length < 0.05:
        raise Impossible
    angle = rng.choice([-1, 1]) * math.acos(cosine)
    e1 = flat / reach
    e2 = np.cross(u, e1)
    return np.asarray(height * u + radius * (math.cos(angle) * e1 + math.sin(angle) * e2))


def on_line(rng: random.Random, seen: Seen, foot: Vector, u: Vector, gap: float) -> Vector:
    """The own point of a sliding body.

    Raises:
        Impossible: one too near to a dead centre where it is drawn.
    """

    def off(p: Array) -> Array:
        m = p - foot[:, None]
        return np.sqrt(np.maximum((m * m).sum(0) - (u @ m) ** 2, 0))

    least = seen.largest(off)
    inside = 1 if rng.random() < 0.85 else -1
    length = least + inside * gap if rng.random() < 0.8 else least * rng.uniform(1, 2)
    m = seen.at(np.zeros(1))[:, 0] - foot
    along = float(u @ m)
    square = length**2 - float(m @ m) + along**2
    if square < 0.01 * length**2 or length < 0.05:
        raise Impossible
    return np.asarray(foot + (along + rng.choice([-1, 1]) * math.sqrt(square)) * u)
