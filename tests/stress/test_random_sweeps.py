"""Random sweeps decided by closed forms: no jump, every stop right and at the right place.

RSSR: A cos(theta4) + B sin(theta4) = C has two roots, one for each sign of the root of the
discriminant A^2 + B^2 - C^2; a branch keeps its sign and ends where the discriminant vanishes.
RCSR: the sphere lies on a circle about the rocker's axis and on a cylinder about the C joint, so
f(theta4) = |w|^2 - r^2 = 0 with w = (S - C) x a; a branch keeps the sign of f' and ends where f and
f' vanish together. MECHKIN_RANDOM=n takes n times as many.
"""

from __future__ import annotations

import math
import os
import random

import numpy as np
import pytest
from mpmath import mp, mpf

import mechkin_cli as mk

SEEDS = range(15 * int(os.environ.get("MECHKIN_RANDOM", "1")))
SOLVED = ("ok", "near-singular")
Vector = list[float]


def drawn(rng: random.Random, size: float) -> Vector:
    return [rng.gauss(0, size) for _ in range(3)]


def text(seed: int, coupler: str, more: str = "") -> tuple[str, dict[str, Vector], random.Random]:
    """A crank at the origin and a rocker at O4; `coupler` is the type of the crank's far joint."""
    rng = random.Random(seed)
    place = {
        "O4": [1 + 0.3 * rng.gauss(0, 1), *drawn(rng, 0.3)[:2]],
        "k1": drawn(rng, 1),
        "k4": drawn(rng, 1),
        "k2": drawn(rng, 1),
        "P": drawn(rng, rng.choice([0.2, 0.4, 0.8])),
    }
    place["S"] = [o + d for o, d in zip(place["O4"], drawn(rng, 0.6), strict=True)]
    step, to = rng.choice([1, 3, 7, 15, 30]), rng.choice([360, -360, 720, 200])
    axis = f", axis: {place['k2']}" if coupler == "C" else ""
    return (
        f"""format: 1
links: {{crank: {{}}, coupler: {{}}, rocker: {{}}}}
joints:
  A: {{type: R, links: [ground, crank], point: [0, 0, 0], axis: {place["k1"]}}}
  B: {{type: {coupler}, links: [crank, coupler], point: {place["P"]}{axis}}}
  C: {{type: S, links: [coupler, rocker], point: {place["S"]}}}
  D: {{type: R, links: [ground, rocker], point: {place["O4"]}, axis: {place["k4"]}}}
motion: {{inputs: {{A.theta: {{from: 0, to: {to}, step: {step}}}}}}}
""",
        place,
        rng,
    )


def turned(axis: Vector, angle: mpf, point: Vector, centre: Vector) -> list[mpf]:
    """A point turned about an axis through a centre (Rodrigues)."""
    k = [mpf(x) / mp.norm(axis) for x in axis]
    d = [mpf(p) - mpf(c) for p, c in zip(point, centre, strict=True)]
    along = sum(x * y for x, y in zip(k, d, strict=True)) * (1 - mp.cos(angle))
    across = cross(k, d)
    return [
        mpf(o) + mp.cos(angle) * x + mp.sin(angle) * y + along * z
        for o, x, y, z in zip(centre, d, across, k, strict=True)
    ]


def cross(a: list[mpf], b: list[mpf]) -> list[mpf]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a: list[mpf], b: list[mpf]) -> mpf:
    return sum(x * y for x, y in zip(a, b, strict=True))


class Rssr:
    """The closed form."""

    def __init__(self, place: dict[str, Vector]) -> None:
        self.place = place
        k = [mpf(x) / mp.norm(place["k4"]) for x in place["k4"]]
        arm = [mpf(s) - mpf(o) for s, o in zip(place["S"], place["O4"], strict=True)]
        self.axial = [dot(k, arm) * x for x in k]
        self.cosine = [x - y for x, y in zip(arm, self.axial, strict=True)]
        self.sine = cross(k, arm)
        rod = [mpf(s) - mpf(p) for s, p in zip(place["S"], place["P"], strict=True)]
        self.square = dot(rod, rod)

    def coefficients(self, theta: mpf) -> tuple[mpf, mpf, mpf]:
        end = turned(self.place["k1"], theta, self.place["P"], [0.0, 0.0, 0.0])
        fixed = [o + a - e for o, a, e in zip(self.place["O4"], self.axial, end, strict=True)]
        rest = self.square - dot(fixed, fixed) - dot(self.cosine, self.cosine)
        return 2 * dot(fixed, self.cosine), 2 * dot(fixed, self.sine), rest

    def discriminant(self, theta: mpf) -> mpf:
        a, b, c = self.coefficients(theta)
        return a * a + b * b - c * c

    def angle(self, theta: mpf, sign: int) -> mpf:
        a, b, c = self.coefficients(theta)
        return mp.atan2(b, a) + sign * mp.acos(c / mp.sqrt(a * a + b * b))

    def end(self, last: float) -> mpf | None:
        """The first zero of the discriminant on the way to `last` degrees."""
        count = 10 * abs(int(last))
        before = mpf(0)
        for i in range(1, count + 1):
            here = mp.radians(mpf(last) * i / count)
            if self.discriminant(here) < 0:
                return mp.degrees(mp.findroot(self.discriminant, (before, here), solver="anderson"))
            before = here
        return None


def turns_off(found: float, exact: mpf) -> float:
    """How far an angle in degrees misses another, whole turns apart."""
    miss = mpf(found) - mp.degrees(exact)
    return float(abs(miss - 360 * mp.nint(miss / 360)))


@pytest.mark.parametrize("seed", SEEDS)
def test_rssr(seed: int) -> None:
    source, place, _ = text(seed, "S")
    result = mk.loads(source).analyze(["D.theta"])
    thetas, exact = result["A.theta"], Rssr(place)
    sign = min((1, -1), key=lambda s: turns_off(0.0, exact.angle(mpf(0), s)))
    end = exact.end(float(thetas[-1]))
    expected = [end is None or abs(t) < abs(end) for t in thetas]
    assert [status in SOLVED for status in result["row.status"]] == expected
    for theta, found, solved in zip(thetas, result["D.theta"], expected, strict=True):
        if solved:
            radians = mp.radians(mpf(float(theta)))
            # next to its end the angle goes as the root of the distance
            slack = 1e-10 + 1e-13 / float(mp.sqrt(abs(exact.discriminant(radians))))
            assert turns_off(float(found), exact.angle(radians, sign)) < slack
    if not all(expected):
        (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
        assert abs(mpf(note.numbers[0].value) - end) < 1e-9


class Rcsr:
    """f(theta4) = |w|^2 - r^2 and its derivatives."""

    def __init__(self, place: dict[str, Vector]) -> None:
        self.place = place
        self.square = mpf(0)
        self.square = self.value(mpf(0), mpf(0))

    def value(self, theta1: mpf, theta4: mpf) -> mpf:
        origin = [0.0, 0.0, 0.0]
        point = turned(self.place["k1"], theta1, self.place["P"], origin)
        axis = turned(self.place["k1"], theta1, self.place["k2"], origin)
        axis = [x / mp.norm(axis) for x in axis]
        end = turned(self.place["k4"], theta4, self.place["S"], self.place["O4"])
        w = cross([x - y for x, y in zip(end, point, strict=True)], axis)
        return dot(w, w) - self.square

    def slope(self, theta1: mpf, theta4: mpf) -> mpf:
        return mp.diff(lambda x: self.value(theta1, x), theta4)


@pytest.mark.parametrize("seed", SEEDS)
def test_rcsr(seed: int) -> None:
    source, place, rng = text(seed, "C")
    result = mk.loads(source).analyze(["D.theta"])
    thetas, found = np.radians(result["A.theta"]), np.radians(result["D.theta"])
    solved = np.array([status in SOLVED for status in result["row.status"]])
    exact = Rcsr(place)
    side = mp.sign(exact.slope(mpf(0), mpf(0)))
    rows = np.flatnonzero(solved)
    assert rows.size == rows[-1] + 1
    for row in (*rng.sample(list(rows), min(8, rows.size)), rows[-1]):
        place_ = mpf(float(thetas[row])), mpf(float(found[row]))
        assert abs(exact.value(*place_)) < 1e-13
        assert mp.sign(exact.slope(*place_)) == side
    if solved.all():
        return
    (note,) = [d for d in result.diagnostics if d.code == "dead-centre"]
    end = mp.radians(mpf(note.numbers[0].value))
    root = mp.findroot(
        lambda x, y: (exact.value(x, y), exact.slope(x, y)), _double_root(exact, end)
    )
    assert abs(mp.degrees(root[0] - end)) < 1e-9
    ahead = math.copysign(1.0, thetas[-1])
    assert abs(thetas[rows[-1]]) <= abs(end) <= abs(thetas[rows[-1] + 1])
    assert ahead * end > 0


def _double_root(exact: Rcsr, theta1: mpf) -> tuple[mpf, mpf]:
    """Where f turns back nearest to zero."""
    angles = [mp.radians(k) for k in range(360)]
    values = [exact.value(theta1, angle) for angle in angles]
    turning = [
        k
        for k in range(360)
        if (values[k] - values[k - 1]) * (values[(k + 1) % 360] - values[k]) <= 0
    ]
    return theta1, angles[min(turning, key=lambda k: abs(values[k]))]
