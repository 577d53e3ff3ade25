"""Assemblies of RSSR and planar four-bars beside a dead centre of the crank: both or none.

The discriminant A^2 + B^2 - C^2 of `turning_loop.py` is read at 40 digits, at crank angles 1e-12 to
1e-2 rad from its zero. `MECHKIN_RANDOM` multiplies the number of loops.
"""

from __future__ import annotations

import os

import numpy as np
import pytest
from mpmath import matrix, mp, mpf
from random_families.turning_loop import PAIRS, TURN, Array, TurningLoop

import mechkin_cli as mk

COUNT = 16 * int(os.environ.get("MECHKIN_RANDOM", "1"))
HALVINGS = 140
ROUNDED = 1e-13
"""Discriminants in parts of A^2 + B^2 that roundings of the dimensions may turn over."""


class FoldingLoop(TurningLoop):
    """A loop whose crank comes to a dead centre."""

    def __init__(self, rng: np.random.Generator, *, planar: bool) -> None:
        self.planar = planar
        places = np.linspace(0, TURN, 721)
        while True:
            self.draw(rng)
            a, b, c = self.terms(places)
            share = 1 - c * c / (a * a + b * b)
            if share.min() < -0.05 and share.max() > 0.05:
                break
        self.pairs = PAIRS[rng.integers(2)] if planar else ("S", "S")
        first = int(np.flatnonzero(share[:-1] * share[1:] < 0)[0])
        self.between = float(places[first]), float(places[first + 1])

    def share(self, t: mpf) -> mpf:
        """The discriminant at 40 digits, in parts of A^2 + B^2."""
        u, o = exact(self.u1), exact(self.o1)
        u = u / mp.sqrt(dot(u, u))
        v, d = exact(self.u4), exact(self.b) - exact(self.o4)
        v = v / mp.sqrt(dot(v, v))
        arm = exact(self.a) - o
        turned = arm * mp.cos(t) + cross(u, arm) * mp.sin(t) + u * dot(u, arm) * (1 - mp.cos(t))
        w, rod = o + turned - exact(self.o4), exact(self.a) - exact(self.b)
        along = v * dot(v, d)
        c = dot(w, w) + dot(d, d) - dot(rod, rod) - 2 * dot(w, along)
        a, b = 2 * dot(w, d - along), 2 * dot(w, cross(v, d))
        return 1 - c * c / (a * a + b * b)

    def dead_centre(self) -> mpf:
        low, high = (mpf(t) for t in self.between)
        rises = self.share(high) > 0
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            low, high = (low, middle) if (self.share(middle) > 0) == rises else (middle, high)
        return low


def exact(v: Array) -> matrix:
    return matrix([mpf(float(x)) for x in v])


def dot(a: matrix, b: matrix) -> mpf:
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a: matrix, b: matrix) -> matrix:
    return matrix([a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)])


@pytest.mark.parametrize("planar", [True, False])
def test_both_or_none(planar: bool) -> None:
    counts = []
    for number in range(COUNT):
        rng = np.random.default_rng(number)
        loop = FoldingLoop(rng, planar=planar)
        with mp.workdps(40):
            fold = loop.dead_centre()
            for way in (-1, 1):
                at = float(mp.degrees(fold + way * mpf(10) ** rng.uniform(-12, -2)))
                share = loop.share(mp.radians(mpf(at)))
                if abs(share) < ROUNDED:
                    continue
                found = mk.loads(loop.file(f"{{at: {at!r}}}")).modes()
                want = 2 if share > 0 else 0
                assert len(found.modes) == want, (number, way, at, float(share))
                counts.append(want)
    assert counts.count(0) > COUNT / 2
    assert counts.count(2) > COUNT / 2
