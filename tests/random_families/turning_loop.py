"""Loops R-S-S-R and planar four-bars whose crank turns fully, in closed form.

The crank carries a about (o1, u1), the rocker b about (o4, u4), and |a - b| stays as drawn. With w
from o4 to a, d from o4 to b, d0 its part along u4,

    A cos(q) + B sin(q) + C = 0,   A = -2 w.(d - d0),  B = -2 w.(u4 x d),
    C = w.w + d.d - L^2 - 2 w.d0,  q = atan2(B, A) +- acos(-C / |A, B|).
"""

from __future__ import annotations

import math

import numpy as np
from mpmath import mp, mpf
from numpy.typing import NDArray

Array = NDArray[np.float64]
TURN = 2 * math.pi
PAIRS = (("S", "S"), ("R", "R"), ("S", "C"), ("C", "S"), ("R", "C"))
"""At the rod's ends where the loop is planar."""


def text(v: Array) -> str:
    return "[" + ", ".join(repr(float(c)) for c in v) + "]"


def frame(rng: np.random.Generator) -> Array:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return np.asarray(q * np.sign(np.linalg.det(q)))


def about(u: Array, t: Array, p: Array, o: Array) -> Array:
    """Places (..., 3) of p turned by t about the axis u through o."""
    angle, d = np.asarray(t)[..., None], p - o
    return np.asarray(
        o + d * np.cos(angle) + np.cross(u, d) * np.sin(angle) + u * (u @ d) * (1 - np.cos(angle))
    )


class TurningLoop:
    """A loop whose discriminant stays above `gap` in parts of its scale."""

    def __init__(self, rng: np.random.Generator, gap: float, *, planar: bool) -> None:
        self.planar = planar
        while True:
            self.draw(rng)
            a, b, c = self.terms(np.linspace(0, TURN, 7201))
            if ((a * a + b * b - c * c) / (a * a + b * b)).min() > gap:
                break
        self.pairs = PAIRS[rng.integers(len(PAIRS))] if planar else ("S", "S")
        self.table = np.linspace(0, TURN, 7201)
        self.heading = np.unwrap(np.arctan2(b, a))
        self.turns = round((self.heading[-1] - self.heading[0]) / TURN)
        """Of the rocker with each turn of the crank."""
        self.side, self.drawn = 1.0, 0.0
        off = []
        for side in (1.0, -1.0):
            self.side = side
            q = float(self.angle(np.zeros(1), np.zeros(1))[0])
            off.append((abs(math.remainder(q, TURN)), side, q))
        _, self.side, self.drawn = min(off)

    def draw(self, rng: np.random.Generator) -> None:
        f = frame(rng)
        self.u1, self.o1 = f[:, 2], rng.normal(size=3)
        if self.planar:
            self.u4, self.o4 = f[:, 2] * rng.choice([1, -1]), self.o1 + f[:, 0] * rng.uniform(1, 2)
            t, s = rng.uniform(0, TURN, 2)
            radius, far = rng.uniform(0.2, 0.8), rng.uniform(0.5, 2.5)
            self.a = self.o1 + radius * (math.cos(t) * f[:, 0] + math.sin(t) * f[:, 1])
            self.b = self.o4 + far * (math.cos(s) * f[:, 0] + math.sin(s) * f[:, 1])
        else:
            self.u4, self.o4 = frame(rng)[:, 2], self.o1 + 1.5 * rng.normal(size=3)
            self.a, self.b = self.o1 + 0.4 * rng.normal(size=3), self.o4 + rng.normal(size=3)
        self.square = float(((self.a - self.b) ** 2).sum())

    def terms(self, t: Array) -> tuple[Array, Array, Array]:
        w, d = about(self.u1, t, self.a, self.o1) - self.o4, self.b - self.o4
        along = self.u4 * (self.u4 @ d)
        c = (w * w).sum(-1) + d @ d - self.square - 2 * (w @ along)
        return -2 * (w @ (d - along)), -2 * (w @ np.cross(self.u4, d)), c

    def angle(self, reduced: Array, turns: Array) -> Array:
        """The rocker's angle since the drawing at crank angles reduced + turns 2 pi."""
        a, b, c = self.terms(reduced)
        heading = np.arctan2(b, a)
        near = np.interp(reduced, self.table, self.heading)
        heading += TURN * np.round((near - heading) / TURN)
        open_by = np.arccos(np.clip(-c / np.hypot(a, b), -1, 1))
        return np.asarray(heading + self.side * open_by + turns * self.turns * TURN - self.drawn)

    def file(self, motion: str, angle: str = "deg", more: str = "") -> str:
        """Crank at A, rocker at D; `motion` of the crank."""
        axis = f", axis: {text(self.u1)}"
        first, last = (axis if kind != "S" else "" for kind in self.pairs)
        return (
            f"format: 1\nname: turning loop\nunits: {{length: m, angle: {angle}}}\n"
            "links: {crank: {}, rod: {}, rocker: {}}\njoints:\n"
            f"  A: {{type: R, links: [ground, crank], point: {text(self.o1)}{axis}}}\n"
            f"  B: {{type: {self.pairs[0]}, links: [crank, rod], point: {text(self.a)}{first}}}\n"
            f"  C: {{type: {self.pairs[1]}, links: [rod, rocker], point: {text(self.b)}{last}}}\n"
            f"  D: {{type: R, links: [ground, rocker], point: {text(self.o4)}, "
            f"axis: {text(self.u4)}}}\n"
            f"motion: {{inputs: {{A.theta: {motion}}}}}\n{more}"
        )


def split(values: Array, period: mpf) -> tuple[Array, Array]:
    """Angles in a unit with this whole turn: rad in [0, 2 pi), and whole turns, to all digits."""
    with mp.workdps(40):
        exact = [mpf(float(v)) for v in values]
        turns = [mp.floor(v / period) for v in exact]
        rest = [float((v / period - n) * 2 * mp.pi) for v, n in zip(exact, turns, strict=True)]
    return np.array(rest), np.array([float(n) for n in turns])
