"""Random linkages with an idle freedom, and the same with it fixed in some way.

A crank drives a follower through links that may spin or slide without moving anything else. Fixed,
the idle coordinate is an input somewhere, with rates, or a ball is a universal joint with any axes.
Masses lie on the line of the spin, about which bodies are symmetric: such a body starts without
spin and is never turned about its line. Where a coordinate fixes it, it is slender instead.
"""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Linkage:
    """Two files, what must agree in both, and the links that are idle."""

    idle: str
    fixed: str
    quantities: tuple[str, ...]
    links: tuple[str, ...]


def unit(rng: Random) -> Floats:
    vector = np.array([rng.gauss(0, 1) for _ in range(3)])
    return vector / np.sqrt(vector @ vector)


def across(rng: Random, axis: Floats) -> Floats:
    vector = np.cross(axis, unit(rng))
    return vector / np.sqrt(vector @ vector)


def near(rng: Random, x: float, y: float, z: float) -> Floats:
    return np.array([x, y, z]) + np.array([rng.uniform(-0.1, 0.1) for _ in range(3)])


def at(vector: Floats) -> str:
    return "[" + ", ".join(repr(float(c)) for c in vector) + "]"


def slender(rng: Random, centre: Floats, line: Floats) -> tuple[str, str]:
    """A body symmetric about a line, with a moment about it and without."""
    mass, moment, about = rng.uniform(0.2, 2.0), rng.uniform(0.01, 0.1), rng.uniform(0.01, 0.1)
    names = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
    found = []
    for along in (about, 0.0):
        tensor = moment * np.eye(3) + (along - moment) * np.outer(line, line)
        entries = ", ".join(f"{name}: {float(tensor[k])!r}" for name, k in names.items())
        found.append(f"{{mass: {mass!r}, center_of_mass: {at(centre)}, inertia: {{{entries}}}}}")
    return found[0], found[1]


def joint(name: str, kind: str, links: tuple[str, str], point: Floats, **keys: Floats) -> str:
    more = "".join(f", {key}: {at(value)}" for key, value in keys.items())
    return f"  {name}: {{type: {kind}, links: [{', '.join(links)}], point: {at(point)}{more}}}"


def universal(rng: Random, name: str, links: tuple[str, str], point: Floats, line: Floats) -> str:
    """In place of a ball: its second axis is well off the line that spins."""
    second = across(rng, line)
    first = np.cross(second, line) + 0.3 * unit(rng)
    first = first - (first @ second) * second
    return joint(name, "U", links, point, axis=first / np.sqrt(first @ first), axis2=second)


def linkage(rng: Random, kind: str) -> Linkage:
    """One of `KINDS`."""
    a, b = near(rng, 0.3, 0.2, 0.1), near(rng, 1.0, 0.7, 0.5)
    line = (b - a) / np.sqrt((b - a) @ (b - a))
    pivot, axis = near(rng, 1.2, 0.0, 0.0), unit(rng)
    follower = "R"
    bodies: dict[str, tuple[str, str]] = {}
    angle = rng.uniform(-80, 80)
    held = f"{{at: {angle!r}, rate: {rng.uniform(-3, 3)!r} rad/s}}"
    extra, extra_fixed = "", ""
    if kind == "rod":
        bodies["rod"] = slender(rng, a + 0.4 * (b - a), line)
        joints = [joint("B", "S", ("crank", "rod"), a), joint("C", "S", ("rod", "rocker"), b)]
        fixed = [universal(rng, "B", ("crank", "rod"), a, line), joints[1]]
    elif kind == "slipper":
        bodies["rod"] = slender(rng, b + 0.1 * axis, axis)
        plane = {"normal": axis, "x": across(rng, axis)}
        axis = unit(rng)
        joints = [
            joint("B", "E", ("crank", "rod"), a, **plane),
            joint("C", "S", ("rod", "rocker"), b),
        ]
        fixed, extra_fixed = joints, f"    B.theta: {held}\n"
    elif kind == "sleeve":
        follower = "C"
        bodies["rod"] = slender(rng, b - 0.3 * line, line)
        joints = [
            joint("B", "C", ("crank", "rod"), a, axis=line),
            joint("C", "S", ("rod", "rocker"), b),
        ]
        fixed, extra_fixed = joints, f"    B.theta: {held}\n"
    elif kind in ("telescope", "swivel", "turning telescope"):
        bodies = {"rod": slender(rng, a + 0.2 * (b - a), line)}
        bodies["end"] = slender(rng, a + 0.8 * (b - a), line)
        middle = {"telescope": "P", "swivel": "R", "turning telescope": "C"}[kind]
        inner = joint("T", middle, ("rod", "end"), a + 0.3 * (b - a), axis=line)
        balls = [joint("B", "S", ("crank", "rod"), a), joint("C", "S", ("end", "rocker"), b)]
        joints = [balls[0], inner, balls[1]]
        fixed = [universal(rng, "B", ("crank", "rod"), a, line), inner, balls[1]]
        if kind != "swivel":
            extra = "    T.s: {from: 0, to: 0.1, count: 5, rate: 0.3 m/s, acceleration: 2 m/s^2}\n"
        extra_fixed = extra + (f"    T.theta: {held}\n" if middle != "P" else "")
    elif kind in ("bent telescope", "knee"):
        bodies = {"rod": ("{}", "{}"), "end": ("{}", "{}")}
        name = "P" if kind == "bent telescope" else "R"
        inner = joint("T", name, ("rod", "end"), a + 0.2 * unit(rng), axis=unit(rng))
        balls = [joint("B", "S", ("crank", "rod"), a), joint("C", "S", ("end", "rocker"), b)]
        joints = [balls[0], inner, balls[1]]
        fixed = [universal(rng, "B", ("crank", "rod"), a, line), inner, balls[1]]
        way = "T.s: {from: 0, to: 0.1, count: 5, rate: 0.3 m/s}"
        if kind == "knee":
            way = "T.theta: {from: 0, to: 5, count: 5, rate: 0.2 rad/s}"
        extra = extra_fixed = f"    {way}\n"
    else:
        assert kind == "bush"
        bodies["rod"] = slender(rng, a + 0.4 * (b - a), line)
        bodies["bush"] = slender(rng, pivot + 0.05 * axis, axis)
        joints = [joint("B", "S", ("crank", "rod"), a), joint("C", "S", ("rod", "rocker"), b)]
        joints.append(joint("D", "R", ("bush", "rocker"), pivot + 0.1 * axis, axis=axis))
        fixed, extra_fixed = list(joints), f"    D.theta: {held}\n"
    heavy = f"{{mass: 1.5, center_of_mass: {at(b - 0.1)}, inertia: {{xx: .1, yy: .2, zz: .15}}}}"
    light = "{mass: 1, center_of_mass: [0.1, 0.1, 0]}"
    links = {"crank": (light, light), **bodies, "rocker": (heavy, heavy)}
    last = "bush" if "bush" in links else "rocker"
    ends = [
        joint("A", "R", ("ground", "crank"), np.zeros(3), axis=np.array([0.0, 0.0, 1.0])),
        joint("E", follower, ("ground", last), pivot, axis=axis),
    ]

    def text(number: int, middle: list[str], more: str) -> str:
        lines = [*ends, *middle]
        rng.shuffle(lines)
        named = list(links.items())
        rng.shuffle(named)
        listed = "\n".join(f"  {name}: {body[number]}" for name, body in named)
        turn = "A.theta: {from: 0, to: 4, step: 1, rate: 5 rad/s, acceleration: 3 rad/s^2}"
        return (
            f"format: 1\nlinks:\n{listed}\njoints:\n" + "\n".join(lines) + "\n"
            f"points: {{tip: {{link: rocker, at: {at(b + 0.2)}}}}}\n"
            f"motion:\n  inputs:\n    {turn}\n{more}"
            "loads:\n  - {type: gravity, g: [0.3, -1, -9.81]}\n"
            "  - {type: force, link: rocker, point: [1, 1, 0], force: [3, 2, 5]}\n"
        )

    driven = "" if not extra else "T.theta.effort" if kind == "knee" else "T.s.effort"
    wanted = ["tip.position", "tip.velocity", "tip.acceleration", "rocker.alpha", "A.effort"]
    wanted += ["ground.shaking_force", "ground.shaking_moment", driven]
    wanted += [f"{name}.{part}" for name in "ACE" for part in ("force", "moment_about_origin")]
    names = tuple(name for name in wanted if name)
    return Linkage(text(0, joints, extra), text(1, fixed, extra_fixed), names, tuple(bodies))


KINDS = (
    "rod",
    "slipper",
    "sleeve",
    "telescope",
    "swivel",
    "turning telescope",
    "bent telescope",
    "knee",
    "bush",
)
