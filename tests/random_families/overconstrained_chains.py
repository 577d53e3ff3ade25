"""Chains of dyads and rockers whose parts are held two and three times, with closed forms.

In a plane, turned anywhere in space, dyads of a rod and a rocker hang on what is placed before
them; where their joints are not all R, they hold themselves in the plane. Rockers about axes of any
direction hang on rods or telescopes between spheres. Every part may have equal ones beside it, of
the same joints or others, and rods at other heights: their equations hold by the dimensions.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

PLANE_KINDS = ("RRR", "CSR", "RSC", "RSR", "SRR", "SCR", "SRC", "CRR", "RCR", "RRC", "SSR")


class NotAssembled(Exception):
    """The circles of a dyad do not meet."""


def turn(axis: Array, angle: float) -> Array:
    """Rodrigues' rotation about a unit vector."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross)


Z = np.array([0.0, 0.0, 1.0])


@dataclass
class Body:
    """Where a body's drawing stands, its angular velocity and that of its point at the origin."""

    turn: Array
    place: Array
    spin: Array
    drift: Array

    def at(self, point: Array) -> Array:
        return self.turn @ point + self.place

    def moved(self, place: Array) -> Array:
        """Velocity of its point at a place."""
        return np.asarray(self.drift + np.cross(self.spin, place))


@dataclass
class Motion:
    """The rockers' angles (rad) and rates; the least margin."""

    angles: list[float]
    rates: list[float]
    margin: float


def drawn(links: Sequence[str]) -> dict[str, Body]:
    """Links as drawn, at rest."""
    return {link: Body(np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3)) for link in links}


@dataclass
class Part:
    """What turns a rocker about `axis` through `foot` on `base`: a rod from `head` on `driver` to
    `pin`, longer by `slide` than they are drawn apart; `sign` tells its two assemblies apart."""

    number: int
    kind: str
    driver: str
    head: Array
    base: str
    foot: Array
    axis: Array
    pin: Array
    slide: float = 0.0
    sign: float = field(init=False, default=1.0)

    @property
    def span(self) -> float:
        return float(np.linalg.norm(self.pin - self.head))

    @property
    def longer(self) -> Array:
        """How far the rod's pin is drawn from the rocker's."""
        return (self.pin - self.head) * (self.slide / self.span)

    def angle(self, bodies: Mapping[str, Body]) -> tuple[float, float]:
        """The rocker's angle against its base, and how far its two assemblies are apart (0 to 1).

        a cos(angle) + b sin(angle) = c for the distance of head and pin.
        """
        base, head = bodies[self.base], bodies[self.driver].at(self.head)
        head = base.turn.T @ (head - base.place) - self.foot
        arm = self.pin - self.foot
        along = float(arm @ self.axis)
        across = arm - along * self.axis
        a = float(head @ across)
        b = float(head @ np.cross(self.axis, across))
        c = float(head @ head + arm @ arm - (self.span + self.slide) ** 2) / 2.0
        c -= along * float(head @ self.axis)
        length = math.hypot(a, b)
        margin = 1.0 - (c / length) ** 2
        if margin <= 0.0:
            raise NotAssembled
        return math.atan2(b, a) + self.sign * math.acos(c / length), math.sqrt(margin)

    def draw(self, bodies: Mapping[str, Body]) -> None:
        """Takes the assembly that is drawn."""
        long, self.slide = self.slide, 0.0
        off = []
        for self.sign in (1.0, -1.0):
            off.append(abs(math.remainder(self.angle(bodies)[0], 2 * math.pi)))
        self.sign = 1.0 if off[0] < off[1] else -1.0
        self.slide = long


@dataclass
class Chain:
    """Parts one on the other from a crank about z; `loads` are torques (N m) on the rockers."""

    parts: list[Part]
    rows: tuple[float, float, float]
    loads: list[float]

    def solve(self, angle: float) -> Motion:
        """The rockers at an angle (rad) of the crank, which turns at 1 rad/s."""
        still = Body(np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3))
        bodies = {"ground": still, "c0": Body(turn(Z, angle), np.zeros(3), Z, np.zeros(3))}
        found = Motion([], [], 1.0)
        for part in self.parts:
            own, margin = part.angle(bodies)
            driver, base = bodies[part.driver], bodies[part.base]
            axis, foot = base.turn @ part.axis, base.at(part.foot)
            turned = base.turn @ turn(part.axis, own)
            head, pin = driver.at(part.head), foot + turned @ (part.pin - part.foot)
            rod = pin - head
            carried = base.moved(pin) - driver.moved(head)
            rate = -float(rod @ carried) / float(rod @ np.cross(axis, pin - foot))
            spin = base.spin + rate * axis
            rocker = Body(turned, foot - turned @ part.foot, spin, np.zeros(3))
            rocker.drift = base.moved(foot) - np.cross(spin, foot)
            bodies[f"k{part.number}"] = rocker
            found.angles.append(own)
            found.rates.append(rate)
            found.margin = min(found.margin, margin)
            if part.kind in PLANE_KINDS:
                drawn = part.pin - part.head
                by = math.atan2(rod[1], rod[0]) - math.atan2(drawn[1], drawn[0])
                apart = rocker.moved(pin) - driver.moved(head)
                spin = float(np.cross(rod, apart)[2] / (rod @ rod)) * Z
                place = head - turn(Z, by) @ part.head
                drift = driver.moved(head) - np.cross(spin, head)
                bodies[f"b{part.number}"] = Body(turn(Z, by), place, spin, drift)
        return found


def random_chain(rng: random.Random) -> Chain | None:
    """A chain of one to four parts; None where it is not assembled next to its drawing."""
    chain = Chain([], (0.0, 0.0, 1.0), [])
    # rods longer or shorter than drawn: the first row is then next to the drawing
    apart = rng.random() < 0.3
    start = 0.0 if apart else 5.0 * rng.randint(-4, 4)
    chain.rows = (start, start + rng.choice([20, 40, 90]), rng.choice([2.0, 5.0, 10.0]))
    flat, anywhere = ["c0"], ["c0"]
    for number in range(rng.randint(1, 4)):
        part = _space_part(rng, number, anywhere) if rng.random() < 0.3 else None
        part = part or _plane_part(rng, number, flat)
        if apart and part.kind != "telescope":
            part.slide = rng.choice([0.01, -0.01, 1e-4])
        chain.parts.append(part)
        chain.loads.append(rng.uniform(-5, 5))
        anywhere.append(f"k{number}")
        if part.kind in PLANE_KINDS:
            flat.append(f"k{number}")
        if part.kind in PLANE_KINDS and part.kind != "SSR":
            flat.append(f"b{number}")
            anywhere.append(f"b{number}")
        try:
            part.draw(drawn(["ground", *anywhere]))
            chain.solve(0.0)
        except NotAssembled:
            return None
    return chain


def _plane_part(rng: random.Random, number: int, flat: Sequence[str]) -> Part:
    def point(spread: float) -> Array:
        return np.array([rng.uniform(-spread, spread), rng.uniform(-spread, spread), 0.0])

    driver = rng.choice(flat)
    base = rng.choice(["ground", "ground", *[link for link in flat if link != driver]])
    head = np.array([rng.uniform(0.2, 0.8), rng.uniform(-0.5, 0.5), 0.0])
    head = head if driver == "c0" else point(2.0)
    foot = head + np.array([rng.uniform(1.5, 3), rng.uniform(-1, 1), 0.0])
    pin = (head + foot) / 2 + np.array([0.0, rng.choice([-1, 1]) * rng.uniform(1.2, 2.5), 0.0])
    return Part(number, rng.choice(PLANE_KINDS), driver, head, base, foot, Z, pin)


def _space_part(rng: random.Random, number: int, anywhere: Sequence[str]) -> Part:
    driver = rng.choice(anywhere)
    axis = np.array([rng.uniform(-1, 1) for _ in range(3)])
    head = np.array([rng.uniform(0.2, 0.9), rng.uniform(-0.8, 0.8), rng.uniform(-0.5, 0.5)])
    foot = head + np.array([rng.uniform(1.5, 3) for _ in range(3)])
    pin = foot + np.array([rng.uniform(-2, 2) for _ in range(3)])
    kind = rng.choice(["leg", "telescope"])
    slide = rng.choice([0.0, 0.02, -0.03]) if kind == "telescope" else 0.0
    axis /= np.linalg.norm(axis)
    return Part(number, kind, driver, head, "ground", foot, axis, pin, slide)


@dataclass
class Written:
    """A file, the names of the rockers' angles in it, and joints that may close its loops."""

    text: str
    angles: list[str]
    closed_at: list[str]


@dataclass
class Copy:
    """An equal part beside a part: a whole one of some kind, or a rod at a height."""

    part: int
    kind: str
    height: float = 0.0


def copies(rng: random.Random, chain: Chain) -> list[Copy]:
    """Up to three equal parts beside each, those beside it at other heights too."""
    found = []
    for part in chain.parts:
        for _ in range(rng.choice([0, 1, 1, 2, 3])):
            flat = part.kind in PLANE_KINDS
            rod = rng.random() < 0.4
            height = rng.choice([0.0, 0.3, -0.7]) if flat and rod else 0.0
            kind = "rod" if rod else rng.choice(PLANE_KINDS) if flat else part.kind
            found.append(Copy(part.number, kind, height))
    return found


def write(
    chain: Chain, rng: random.Random, beside: Sequence[Copy] = (), *, shuffled: bool = False
) -> Written:
    """The chain as a file, turned in space, with some equal parts beside its own."""
    return _Writer(chain, rng).write(beside, shuffled=shuffled)


class _Writer:
    def __init__(self, chain: Chain, rng: random.Random) -> None:
        self.chain, self.rng = chain, rng
        axis = np.array([rng.uniform(-1, 1) for _ in range(3)])
        self.turn = turn(axis / np.linalg.norm(axis), rng.uniform(0, 6))
        self.links: list[str] = ["c0"]
        self.joints: list[tuple[str, str]] = []
        self.tree: list[tuple[str, str, str]] = []
        self.inputs: list[str] = []

    def vector(self, at: Array) -> str:
        return str([float(x) for x in self.turn @ at])

    def joint(
        self,
        name: str,
        letter: str,
        ends: tuple[str, str],
        at: Array,
        axis: Array = Z,
        off: Array | None = None,
    ) -> None:
        """A joint; `off` is how far from it its place on the first link is drawn."""
        rest = "" if letter == "S" else f", axis: {self.vector(axis)}"
        links, point = ", ".join(ends), self.vector(at)
        if off is not None and np.any(off):
            point = f"{{{ends[0]}: {self.vector(at + off)}, {ends[1]}: {point}}}"
        line = f"{{type: {letter}, links: [{links}], point: {point}{rest}}}"
        self.joints.append((name, line))
        self.tree.append((name, *ends))

    def rod(self, name: str, part: Part, rocker: str, up: float = 0.0) -> None:
        """A link between two spheres, which the solver takes for a distance."""
        self.links.append(name)
        self.joint(f"{name}p", "S", (part.driver, name), part.head + up * Z)
        self.joint(f"{name}q", "S", (name, rocker), part.pin + up * Z, off=part.longer)
        del self.tree[-2:]

    def part(self, part: Part, kind: str, mark: str) -> None:
        """A part with its own rod and rocker."""
        name = f"{part.number}{mark}"
        rocker = f"k{name}"
        self.links.append(rocker)
        letter = kind[2] if kind in PLANE_KINDS else "R"
        self.joint(f"D{name}", letter, (part.base, rocker), part.foot, part.axis)
        if kind == "telescope":
            self.telescope(part, name)
        elif kind in ("leg", "SSR"):
            self.rod(f"b{name}", part, rocker)
        else:
            self.links.append(f"b{name}")
            self.joint(f"P{name}", kind[0], (part.driver, f"b{name}"), part.head)
            self.joint(f"M{name}", kind[1], (f"b{name}", rocker), part.pin, off=part.longer)

    def telescope(self, part: Part, name: str) -> None:
        tube, piston = f"t{name}", f"b{name}"
        self.links += [tube, piston]
        line = part.pin - part.head
        self.joint(f"P{name}", "S", (part.driver, tube), part.head)
        self.joint(f"L{name}", "P", (tube, piston), part.head, line / np.linalg.norm(line))
        self.joint(f"M{name}", "S", (piston, f"k{name}"), part.pin)
        del self.tree[-3:]
        self.inputs.append(f"L{name}.s: {{at: {part.slide}}}")

    def write(self, beside: Sequence[Copy], *, shuffled: bool) -> Written:
        chain, rng = self.chain, self.rng
        self.joint("A0", "R", ("ground", "c0"), np.zeros(3))
        for part in chain.parts:
            self.part(part, part.kind, "")
        for number, copy in enumerate(beside):
            part = chain.parts[copy.part]
            if copy.kind != "rod":
                self.part(part, copy.kind, f"x{number}")
            elif part.kind != "telescope":
                self.rod(f"r{number}", part, f"k{part.number}", copy.height)
        closed_at = self.closings()
        first, last, step = chain.rows
        inputs = [f"A0.theta: {{from: {first}, to: {last}, step: {step}, rate: 1 rad/s}}"]
        loads = [
            f"{{type: torque, joint: D{k}, value: {load}}}" for k, load in enumerate(chain.loads)
        ]
        links, joints = self.links, [f"  {name}: {line}" for name, line in self.joints]
        if shuffled:
            rng.shuffle(links)
            rng.shuffle(joints)
        lines = ["format: 1", "units: {length: m, angle: deg, force: N}"]
        lines += ["links: {" + ", ".join(f"{link}: {{}}" for link in links) + "}", "joints:"]
        lines += [*joints, "loads: [" + ", ".join(loads) + "]"]
        lines.append("motion: {inputs: {" + ", ".join([*inputs, *self.inputs]) + "}}")
        angles = [f"D{part.number}.theta" for part in chain.parts]
        return Written("\n".join(lines) + "\n", angles, closed_at)

    def closings(self) -> list[str]:
        """Joints beside any spanning tree that carries the crank."""
        edges = self.tree[1:]
        self.rng.shuffle(edges)
        top: dict[str, str] = {}

        def root(link: str) -> str:
            while link in top:
                link = top[link]
            return link

        top[root("c0")] = "ground"
        left = []
        for name, one, other in edges:
            if root(one) == root(other):
                left.append(name)
            else:
                top[root(one)] = root(other)
        return left
