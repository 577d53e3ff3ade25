"""Random spatial four-bars with all their assemblies in closed form; no code of the package."""

from __future__ import annotations

import math
import os
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]
TURN = 2 * math.pi


def cases(seed: int, count: int) -> Iterator[random.Random]:
    """Generators of random cases; MECHKIN_RANDOM multiplies their number."""
    for index in range(count * int(os.environ.get("MECHKIN_RANDOM", "1"))):
        yield random.Random(seed * 1_000_003 + index)


def vector(rng: random.Random, size: float = 1.0) -> Vector:
    return np.array([round(rng.uniform(-size, size), 3) for _ in range(3)])


def unit(v: Vector) -> Vector:
    return v / np.linalg.norm(v)


def rotation(axis: Vector, angle: float) -> NDArray[np.float64]:
    x, y, z = unit(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def turned(point: Vector, axis: Vector, foot: Vector, angle: float) -> Vector:
    return foot + rotation(axis, angle) @ (point - foot)


def text(v: Vector) -> str:
    return "[" + ", ".join(repr(float(c)) for c in v) + "]"


@dataclass
class FourBar:
    """A mechanism's text without its assembly, and its assemblies at an input's value.

    `scales` are what a difference of each coordinate is divided by: 1 for radians that count
    modulo a turn, 0 for radians that do not, else the size of the mechanism.
    """

    text: str
    scales: dict[str, float]
    assemblies: Callable[[float], list[dict[str, float]]]
    driver: str = "O1.theta"


def circle_roots(f: Callable[[float], float], degree: int) -> list[float]:
    """Angles where a trigonometric polynomial of the degree vanishes."""
    n = 2 * degree + 1
    samples = [f(TURN * k / n) for k in range(n)]
    c = np.fft.fft(samples) / n
    coefficients = [c[k % n] for k in range(degree, -degree - 1, -1)]
    out = []
    for root in np.roots(coefficients):
        if abs(abs(root) - 1) < 1e-5:
            angle = float(np.angle(root))
            for _ in range(4):
                slope = (f(angle + 1e-6) - f(angle - 1e-6)) / 2e-6
                if slope == 0:
                    break
                angle -= f(angle) / slope
            out.append(angle)
    return out


def head(driver: str, value: float) -> str:
    return (
        "format: 1\nname: bar\nunits: {length: m, angle: rad, mass: kg, force: N}\n"
        f"motion: {{inputs: {{{driver}: {{values: [{value!r}]}}}}}}\n"
    )


def box_size(points: list[Vector]) -> float:
    return float(np.linalg.norm(np.ptp(np.array(points), axis=0)))


def rssx(rng: random.Random, kind: str) -> FourBar:
    """R S S and an R, P or H on ground."""
    a1, o1 = vector(rng), vector(rng)
    a4, o4 = vector(rng), vector(rng) * 2
    p2, p3 = o1 + vector(rng), o4 + vector(rng)
    length = round(rng.uniform(0.6, 3.0), 3)
    end = p2 + length * unit(vector(rng))
    length = float(np.linalg.norm(end - p2))
    lead = round(rng.choice([-1, 1]) * rng.uniform(0.1, 2), 3)
    more = f", lead: {lead}" if kind == "H" else ""
    body = (
        "links: {crank: {}, coupler: {}, rocker: {}}\njoints:\n"
        f"  O1: {{type: R, links: [ground, crank], point: {text(o1)}, axis: {text(a1)}}}\n"
        f"  O2: {{type: S, links: [crank, coupler], point: {text(p2)}}}\n"
        "  O3: {type: S, links: [coupler, rocker], "
        f"point: {{coupler: {text(end)}, rocker: {text(p3)}}}}}\n"
        f"  O4: {{type: {kind}, links: [ground, rocker], point: {text(o4)}, "
        f"axis: {text(a4)}{more}}}\n"
    )
    size = box_size([o1, p2, end, p3, o4])

    def assemblies(value: float) -> list[dict[str, float]]:
        p = turned(p2, a1, o1, value)
        if kind == "P":
            u, d = unit(a4), p3 - p
            half = float(u @ d)
            root = half * half - float(d @ d) + length**2
            return [{"O4.s": -half + s * math.sqrt(root)} for s in (-1, 1)] if root > 0 else []

        def gap(t: float) -> float:
            q = turned(p3, a4, o4, t)
            if kind == "H":
                q = q + unit(a4) * (lead * t / TURN)
            d = q - p
            return float(d @ d) - length**2

        if kind == "R":
            return [{"O4.theta": t} for t in circle_roots(gap, 1)]
        grid = np.linspace(-40 * math.pi, 40 * math.pi, 16001)
        y = [gap(float(t)) for t in grid]
        roots = []
        for i in range(len(grid) - 1):
            if y[i] * y[i + 1] < 0:
                low, high = float(grid[i]), float(grid[i + 1])
                for _ in range(60):
                    mid = (low + high) / 2
                    if gap(low) * gap(mid) <= 0:
                        high = mid
                    else:
                        low = mid
                roots.append(low)
        return [{"O4.theta": t} for t in roots]

    scales = {"O4.s": size} if kind == "P" else {"O4.theta": 1.0 if kind == "R" else 0.0}
    return FourBar(body, scales, assemblies)


def rcsr(rng: random.Random) -> FourBar:
    """The rocker's sphere lies on a cylinder about the crank's axis: an equation of degree four."""
    a1, o1 = vector(rng), vector(rng)
    a2, o2 = vector(rng), o1 + vector(rng)
    a4, o4 = vector(rng), vector(rng) * 2
    p3, end = o4 + vector(rng), o2 + vector(rng) * 1.5
    body = (
        "links: {crank: {}, coupler: {}, rocker: {}}\njoints:\n"
        f"  O1: {{type: R, links: [ground, crank], point: {text(o1)}, axis: {text(a1)}}}\n"
        f"  O2: {{type: C, links: [crank, coupler], point: {text(o2)}, axis: {text(a2)}}}\n"
        "  O3: {type: S, links: [coupler, rocker], "
        f"point: {{coupler: {text(end)}, rocker: {text(p3)}}}}}\n"
        f"  O4: {{type: R, links: [ground, rocker], point: {text(o4)}, axis: {text(a4)}}}\n"
    )
    size = box_size([o1, o2, end, p3, o4])
    u = unit(a2)

    def split(v: Vector) -> tuple[float, Vector]:
        along = float(u @ v)
        return along, v - along * u

    def assemblies(value: float) -> list[dict[str, float]]:
        back = rotation(a1, -value)

        def seen(t: float) -> Vector:  # the rocker's sphere in the crank, from O2
            out: Vector = o1 + back @ (turned(p3, a4, o4, t) - o1) - o2
            return out

        along0, across0 = split(end - o2)
        radius = float(across0 @ across0)

        def gap(t: float) -> float:
            _, across = split(seen(t))
            return float(across @ across) - radius

        found = []
        for t4 in circle_roots(gap, 2):
            along, across = split(seen(t4))
            t2 = math.atan2(float(u @ np.cross(across0, across)), float(across0 @ across))
            found.append({"O2.theta": t2, "O2.s": along - along0, "O4.theta": t4})
        return found

    return FourBar(body, {"O2.theta": 1.0, "O2.s": size, "O4.theta": 1.0}, assemblies)


def rsur(rng: random.Random) -> FourBar:
    """R S U R: a distance gives two places of the rocker, the aim of the coupler two each."""
    a1, o1 = vector(rng), vector(rng)
    a4, o4 = vector(rng), vector(rng) * 2
    p2, p3 = o1 + vector(rng), o4 + vector(rng)
    end = p3 + vector(rng) * 2
    b1, b2 = vector(rng), vector(rng)
    length = float(np.linalg.norm(end - p3))
    body = (
        "links: {crank: {}, coupler: {}, rocker: {}}\njoints:\n"
        f"  O1: {{type: R, links: [ground, crank], point: {text(o1)}, axis: {text(a1)}}}\n"
        "  O2: {type: S, links: [crank, coupler], "
        f"point: {{crank: {text(p2)}, coupler: {text(end)}}}}}\n"
        f"  O3: {{type: U, links: [rocker, coupler], point: {text(p3)}, axis: {text(b1)}, "
        f"axis2: {text(b2)}}}\n"
        f"  O4: {{type: R, links: [ground, rocker], point: {text(o4)}, axis: {text(a4)}}}\n"
    )

    def assemblies(value: float) -> list[dict[str, float]]:
        p = turned(p2, a1, o1, value)

        def gap(t: float) -> float:
            d = turned(p3, a4, o4, t) - p
            return float(d @ d) - length**2

        found = []
        e, x = unit(b1), end - p3
        for t4 in circle_roots(gap, 1):
            aim = rotation(a4, -t4) @ (p - turned(p3, a4, o4, t4))  # in the rocker as drawn

            def off(t: float, aim: Vector = aim) -> float:
                return float(e @ (rotation(b2, t) @ x - aim))

            for t2 in circle_roots(off, 1):
                y = rotation(b2, t2) @ x
                ya, aa = y - (e @ y) * e, aim - (e @ aim) * e
                t1 = math.atan2(float(e @ np.cross(ya, aa)), float(ya @ aa))
                found.append({"O3.theta1": t1, "O3.theta2": t2, "O4.theta": t4})
        return found

    return FourBar(body, {"O3.theta1": 1.0, "O3.theta2": 1.0, "O4.theta": 1.0}, assemblies)


FAMILIES: dict[str, Callable[[random.Random], FourBar]] = {
    "RSSR": lambda rng: rssx(rng, "R"),
    "RSSP": lambda rng: rssx(rng, "P"),
    "RSSH": lambda rng: rssx(rng, "H"),
    "RCSR": rcsr,
    "RSUR": rsur,
}


def distance(
    bar: FourBar, one: dict[str, float], other: dict[str, float], names: list[str]
) -> float:
    total = 0.0
    for name in names:
        d = one[name] - other[name]
        scale = bar.scales[name]
        if scale == 1.0:
            d = math.remainder(d, TURN)
        elif scale:
            d /= scale
        total += d * d
    return math.sqrt(total)
