"""Four-bars at the limit between kinds (the shortest and the longest side as long as the two
others), planar and spherical, which move by themselves through places where they fold.

With t = tan(theta/2) and u = tan(phi/2) of crank and rocker, counted from a fold, closure is

    B t^2 + C u^2 + D t u + A t^2 u^2 = 0,

for p = 1/t and q = 1/u a hyperbola (q - m1 p)(q - m2 p) = -A/B. Its points are one smooth curve
in psi, q - m1 p = k tan(psi/2), which passes the fold along both branches; where A = 0, as in
parallelograms and kites, the curve falls into two lines u = t/m. Along it the motion is one
integral, t = int sqrt(M / 2 (E - V)) dpsi.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
GRAVITY = np.array([1.0, -9.0, 3.0])
STEP = 1e-30
"""Of derivatives by a complex step."""
PANELS, GAUSS = 2000, np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class Sides:
    """Of a four-bar in the plane, or on the unit sphere (arcs): ground, crank, rocker."""

    ground: float
    crank: float
    rocker: float
    is_spherical: bool

    def pins(self, crank: Any, rocker: Any) -> tuple[Any, Any]:
        """The moving pins (3, n) by cosine and sine of both angles."""
        (c, s), (k, z) = crank, rocker
        a, d, g = self.crank, self.rocker, self.ground
        if not self.is_spherical:
            nothing = 0 * c
            return np.array([a * c, a * s, nothing]), np.array([g + d * k, d * z, nothing])
        first = np.array([math.sin(a) * c, math.sin(a) * s, math.cos(a) + 0 * c])
        x, y, up = math.sin(d) * k, math.sin(d) * z, math.cos(d) + 0 * k
        turned = np.array(
            [math.cos(g) * x + math.sin(g) * up, y, math.cos(g) * up - math.sin(g) * x]
        )
        return first, turned

    def span(self, theta: float, phi: float) -> float:
        """The square of the pins' distance."""
        one, two = ((math.cos(x), math.sin(x)) for x in (theta, phi))
        first, second = self.pins(one, two)
        return float(sum((first - second) ** 2))


class Curve:
    """The smooth curve of a four-bar that folds at theta and phi in {0, pi}; of one that falls in
    two, the line `second` or the other."""

    def __init__(self, sides: Sides, fold: tuple[float, float], second: bool) -> None:
        self.sides, self.fold = sides, fold
        rod = sides.span(*fold)
        at = [
            sides.span(fold[0] + x, fold[1] + y) - rod
            for x, y in ((math.pi, math.pi), (math.pi, 0), (0, math.pi), (math.pi / 2, math.pi / 2))
        ]
        a, b, c = at[:3]
        d = 4 * at[3] - a - b - c
        size = max(map(abs, (a, b, c, d)))
        root = d * d - 4 * b * c
        self.is_bad = root < 1e-2 * size**2 or min(abs(b), abs(c)) < 1e-2 * size
        if self.is_bad:
            return
        m = [(-d + sign * math.sqrt(root)) / (2 * b) for sign in (1, -1)]
        self.m = m[::-1] if second else m
        self.part = 0.0 if abs(a) < 1e-9 * size else a / b
        self.is_bad = 0.0 < abs(self.part) < 1e-2 or min(map(abs, m)) < 0.05

    def tangents(self, psi: Any) -> tuple[Any, Any, Any]:
        """Numerator and the denominators of t and u."""
        s, c = np.sin(psi / 2), np.cos(psi / 2)
        one, two = self.m
        if not self.part:
            return s, c, one * c
        square = abs(self.part)
        return (
            (two - one) * math.sqrt(square) * s * c,
            square * s * s + self.part * c * c,
            two * square * s * s + one * self.part * c * c,
        )

    def directions(self, psi: Any) -> tuple[tuple[Any, Any], tuple[Any, Any]]:
        """Cosine and sine of theta and phi."""
        n, *below = self.tangents(psi)
        found = []
        for d, fold in zip(below, self.fold, strict=True):
            sign, square = round(math.cos(fold)), n * n + d * d
            found.append((sign * (d * d - n * n) / square, sign * 2 * n * d / square))
        return found[0], found[1]

    def angles(self, psi: Array) -> Array:
        """theta and phi (2, n), without jumps from the first on; psi is dense."""
        pairs = self.directions(psi)
        return np.array([np.unwrap(np.arctan2(s, c)) for c, s in pairs])


@dataclass(frozen=True)
class Case:
    """A mechanism in motion: its file, and the angles from the drawing at the rows' times."""

    text: str
    what: str
    times: Array
    theta: Array
    phi: Array
    crossings: int


def bodies(curve: Curve, at: Any, weights: Array) -> Any:
    """Mass points of crank, rod and rocker (3 bodies, 3, n), fixed to their pins."""
    first, second = curve.sides.pins(*at)
    ground = np.zeros((3, 1))
    base = [ground, first, ground + np.array([[curve.sides.ground], [0], [0]])]
    tip = [first, second, second]
    if curve.sides.is_spherical:
        axis = curve.sides.ground
        base[0] = ground + np.array([[0], [0], [1]])
        base[2] = ground + np.array([[math.sin(axis)], [0], [math.cos(axis)]])
    found = []
    for p, q, (x, y) in zip(base, tip, weights, strict=True):
        way = q - p
        if curve.sides.is_spherical:
            found.append(p + x * way)
        else:
            found.append(p + x * way + y * np.array([-way[1], way[0], 0 * way[0]]))
    return np.array(found)


def motion(curve: Curve, masses: Array, weights: Array, psi: float, turns: float) -> Any:
    """psi on a fine grid, its times, and the rate of psi at the start."""
    ends = psi + np.linspace(0, 2 * math.pi * turns, PANELS + 1)
    nodes, parts = GAUSS
    half = (ends[1] - ends[0]) / 2
    places = ((ends[:-1] + ends[1:]) / 2 + half * nodes[:, None]).ravel()
    at = bodies(curve, curve.directions(places + 1j * STEP), weights)
    inertia = np.einsum("b,bxn->n", masses, (at.imag / STEP) ** 2)
    height = -np.einsum("b,x,bxn->n", masses, GRAVITY, at.real)
    start = bodies(curve, curve.directions(np.array([psi + 1j * STEP])), weights)
    low = -float(np.einsum("b,x,bx->", masses, GRAVITY, start.real[..., 0]))
    first = float(np.einsum("b,bx->", masses, (start.imag[..., 0] / STEP) ** 2))
    energy = height.max() + 0.7 * (height.max() - height.min()) + 1.0
    speed = np.sqrt(inertia / (2 * (energy - height))).reshape(len(nodes), PANELS)
    times = np.concatenate([[0.0], np.cumsum(half * (parts @ speed))])
    return ends, times, math.sqrt(2 * (energy - low) / first)


def vector(x: Any) -> str:
    return "[" + ", ".join(repr(float(value)) for value in x) + "]"


def drawn(curve: Curve, at: Any, masses: Array, weights: Array) -> str:
    """Links and joints as they are at cosines and sines of theta and phi."""
    first, second = (pin[:, 0] for pin in curve.sides.pins(*at))
    centres = bodies(curve, at, weights)[..., 0]
    ground = curve.sides.ground
    ends: list[Any] = [np.zeros(3), first, second, np.array([ground, 0, 0])]
    axes: list[Any] = [np.array([0, 0, 1])] * 4
    if curve.sides.is_spherical:
        ends = axes = [axes[0], first, second, np.array([math.sin(ground), 0, math.cos(ground)])]
    chain = ("ground", "crank", "rod", "rocker", "ground")
    lines = ["links:"]
    for name, mass, centre in zip(chain[1:4], masses, centres, strict=True):
        lines.append(f"  {name}: {{mass: {float(mass)!r}, center_of_mass: {vector(centre)}}}")
    lines.append("joints:")
    for k, name in enumerate("ABCD"):
        # the ground comes first, so that angles turn with the links
        links = "ground, rocker" if name == "D" else f"{chain[k]}, {chain[k + 1]}"
        at_pin = f"point: {vector(ends[k])}, axis: {vector(axes[k])}"
        lines.append(f"  {name}: {{type: R, links: [{links}], {at_pin}}}")
    return "\n".join(lines)


def response(
    name: str,
    curve: Curve,
    at: Any,
    masses: Array,
    weights: Array,
    rate: float,
    times: Array,
    tolerance: float,
) -> str:
    """The file of a motion with a rate of the crank at the start."""
    listed = ", ".join(repr(float(t)) for t in times)
    return (
        f"format: 1\nname: {name}\nunits: {{angle: rad}}\n{drawn(curve, at, masses, weights)}\n"
        f"loads: [{{type: gravity, g: {vector(GRAVITY)}}}]\n"
        "assembly: {at_branch_points: straight}\nresponses:\n  run:\n"
        f"    start: {{A.theta: 0, A.theta_dot: {float(rate)!r} rad/s}}\n"
        f"    time: {{values: [{listed}]}}\n    tolerance: {tolerance}\n"
    )


def draw(r: random.Random) -> tuple[Curve, str]:
    """A four-bar that folds; a third of them parallelograms, crossed ones and kites."""
    while True:
        is_spherical = r.random() < 0.4
        ground, crank, rocker = (r.uniform(0.3, 1.2) for _ in range(3))
        fold = (r.choice((0.0, math.pi)), r.choice((0.0, math.pi)))
        what = "spherical" if is_spherical else "planar"
        if r.random() < 0.35:
            what += " of equal sides"
            if r.random() < 0.5:
                rocker, fold = crank, (0.0, 0.0)
            else:
                crank, fold = ground, (0.0, r.choice((0.0, math.pi)))
        curve = Curve(Sides(ground, crank, rocker, is_spherical), fold, r.random() < 0.5)
        if not curve.is_bad:
            return curve, what


def case(number: int, tolerance: float = 1e-12) -> Case:
    """The mechanism of a number, with eight rows over about a turn and a half."""
    r = random.Random(number)
    while True:
        curve, what = draw(r)
        psi = r.choice((0, math.pi)) + r.uniform(0.7, 2.4)
        masses = np.array([r.uniform(0.5, 2) for _ in range(3)])
        weights = np.array([(r.uniform(0.3, 1.2), r.uniform(-0.3, 0.3)) for _ in range(3)])
        ends, times, rate = motion(curve, masses, weights, psi, 1.4)
        angles = curve.angles(ends)
        slope = (angles[0, 1] - angles[0, 0]) / (ends[1] - ends[0])
        bent = np.abs(np.diff(angles, axis=1)).max() * PANELS / (2 * math.pi * 1.4)
        if abs(slope) > 0.2 and bent < 6:
            break
    rows = np.linspace(0, PANELS, 9).astype(int)
    h = 1e-30
    n, d, _ = curve.tangents(np.array([psi + 1j * h]))
    exact = 2 * float(((n.imag * d.real - n.real * d.imag) / h / (n.real**2 + d.real**2))[0])
    at = curve.directions(np.array([psi]))
    name, speed = f"change point {number}", exact * rate
    text = response(name, curve, at, masses, weights, speed, times[rows], tolerance)
    off = angles - angles[:, :1]
    passed = int(np.floor((ends[-1]) / math.pi) - np.floor(psi / math.pi))
    return Case(text, what, times[rows], off[0, rows], off[1, rows], passed)
