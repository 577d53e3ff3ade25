"""R-Sc-S and P-Sc-S loops at plain folds: dead centres in closed form, found and named.

A ball slides along a cylinder fixed in the driven link; a rod holds it at a distance from a sphere
of ground. With the ball's way s along u through p, both as the driven link carries them, and the
sphere at c, |p + s u - c| = L has its folds where (u.m)^2 - m.m + L^2 = 0, m = p - c.
"""

from __future__ import annotations

import os
import random
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf

import mechkin_cli as mk

TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

mp.dps = 50
Vector = list


def unit(v: Vector) -> Vector:
    length = mp.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def turned(v: Vector, axis: Vector, angle: mpf) -> Vector:
    u = unit(axis)
    along = sum(a * b for a, b in zip(u, v, strict=True))
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    c, s = mp.cos(angle), mp.sin(angle)
    return [c * x + s * y + (1 - c) * along * z for x, y, z in zip(v, cross, u, strict=True)]


class Loop:
    """A driven link about or along `drive` through the origin; cylinder through p along u."""

    def __init__(self, seed: int, kind: str) -> None:
        rng = random.Random(seed)

        def vector(size: float) -> Vector:
            return [mpf(f"{rng.uniform(-size, size):.3f}") for _ in range(3)]

        self.kind = kind
        self.drive, self.p, self.u, self.c = vector(1), vector(1), vector(1), vector(1.5)
        self.length = sum((a - b) ** 2 for a, b in zip(self.p, self.c, strict=True))
        # the pin stands across the rod, so that the ball's two turns reach the rod's directions
        rod = np.array([float(a - b) for a, b in zip(self.c, self.p, strict=True)])
        self.pin = np.cross(rod, [float(x) for x in self.u])

    def parts(self, q: mpf) -> tuple[mpf, mpf]:
        """u.m and the discriminant."""
        if self.kind == "R":
            p, u = turned(self.p, self.drive, q), unit(turned(self.u, self.drive, q))
        else:
            d = unit(self.drive)
            p, u = [a + q * b for a, b in zip(self.p, d, strict=True)], unit(self.u)
        m = [a - b for a, b in zip(p, self.c, strict=True)]
        along = sum(a * b for a, b in zip(u, m, strict=True))
        return along, along * along - sum(x * x for x in m) + self.length

    def slide(self, q: mpf) -> mpf:
        side = 1 if self.parts(mpf(0))[0] > 0 else -1
        along, square = self.parts(q)
        return -along + side * mp.sqrt(square)

    def fold(self, way: int, far: float) -> mpf | None:
        """The nearest dead centre that way."""
        grid = [mpf(k) * far / 400 * way for k in range(401)]
        for low, high in pairwise(grid):
            if self.parts(high)[1] <= 0:
                return mp.findroot(lambda q: self.parts(q)[1], (low, high), solver="anderson")
        return None

    def text(self, motion: str) -> str:
        def row(v: object) -> str:
            return "[" + ", ".join(repr(float(x)) for x in v) + "]"  # type: ignore[attr-defined]

        return (
            "format: 1\nname: slotted\nunits: {length: m, angle: rad}\n"
            "links: {driven: {}, rod: {}}\njoints:\n"
            f"  A: {{type: {self.kind}, links: [ground, driven], point: [0, 0, 0], "
            f"axis: {row(self.drive)}}}\n"
            f"  B: {{type: Sc, links: [driven, rod], point: {row(self.p)}, axis: {row(self.u)}, "
            f"pin: {row(self.pin)}}}\n"
            f"  C: {{type: S, links: [ground, rod], point: {row(self.c)}}}\n"
            f"motion: {{inputs: {{A.{'theta' if self.kind == 'R' else 's'}: {motion}}}}}\n"
        )


def cases() -> list[tuple[str, int, int, float]]:
    """Some folds of each kind that lie clear of the drawing and of another fold."""
    found = []
    for kind in "RP":
        seed, far = 0, 3.0 if kind == "R" else 2.0
        count = 0
        while count < 5 * TIMES:
            seed += 1
            loop, way = Loop(seed, kind), 1 if seed % 2 else -1
            if np.linalg.norm(loop.pin) < 0.2 or loop.parts(mpf(0))[1] < 0.05:
                continue
            fold = loop.fold(way, far)
            if fold is not None and 0.2 < abs(fold) < 0.8 * far:
                found.append((kind, seed, way, far))
                count += 1
    return found


@pytest.mark.parametrize(("kind", "seed", "way", "far"), cases())
def test_plain_folds_are_named(kind: str, seed: int, way: int, far: float) -> None:
    loop = Loop(seed, kind)
    fold = loop.fold(way, far)
    assert fold is not None
    model = mk.loads(loop.text(f"{{from: 0, to: {way * far}, count: 41}}"))
    result = model.analyze(["B.s"])
    name = "A.theta" if kind == "R" else "A.s"
    for k, q in enumerate(result[name]):
        if abs(q) > abs(fold):
            assert result["row.status"][k] == "beyond-dead-centre", (q, float(fold))
        else:
            assert result["row.status"][k] == "ok", (q, float(fold))
            assert abs(result["B.s"][k] - float(loop.slide(mpf(float(q))))) < 1e-8
    (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
    assert any(abs(number.value - float(fold)) < 1e-10 for number in note.numbers)
