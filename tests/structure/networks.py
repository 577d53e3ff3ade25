"""Mechanisms of many loops as text: chains, ladders, trains, walking legs, platforms, random ones.

Drawn assembled as far as their graph is concerned: every joint has one place.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Sequence
from typing import NamedTuple

FREEDOMS = {"R": 1, "P": 1, "H": 1, "C": 2, "U": 2, "S": 3}
Point = Sequence[float]
Z = (0, 0, 1)


class Pair(NamedTuple):
    """A joint as written: its type, its two links, the rest of its line."""

    letter: str
    first: str
    second: str
    rest: str


class Network(NamedTuple):
    """Links and joints in the order written, and the driven coordinates."""

    links: list[str]
    joints: dict[str, Pair]
    inputs: list[str]

    @property
    def loops(self) -> int:
        return len(self.joints) - len(self.links)

    @property
    def plane_text(self) -> str:
        """As a file in a plane, of revolutes and slides drawn at z = 0."""
        text = self.text.replace(", axis: [0, 0, 1]", "")
        text = re.sub(r"(point|axis): \[([^,\]]*), ([^,\]]*), 0\]", r"\1: [\2, \3]", text)
        return text.replace("format: 1\n", "format: 1\nplane: xy\n")

    @property
    def text(self) -> str:
        """As a file of format 1."""
        links = ", ".join(f"{link}: {{}}" for link in self.links)
        joints = [
            f"  {name}: {{type: {p.letter}, links: [{p.first}, {p.second}], {p.rest}}}"
            for name, p in self.joints.items()
        ]
        inputs = [f"    {name}: {{from: 0, to: 5, count: 3}}" for name in self.inputs]
        lines = [f"links: {{{links}}}", "joints:", *joints, "motion:", "  inputs:", *inputs]
        return "\n".join(["format: 1", *lines]) + "\n"


def turn(one: str, other: str, point: Point, axis: Point = Z) -> Pair:
    """A revolute."""
    return Pair("R", one, other, f"point: {list(point)}, axis: {list(axis)}")


def slide(one: str, other: str, point: Point, axis: Point) -> Pair:
    """A prismatic pair."""
    return Pair("P", one, other, f"point: {list(point)}, axis: {list(axis)}")


def sphere(one: str, other: str, point: Point) -> Pair:
    """A sphere."""
    return Pair("S", one, other, f"point: {list(point)}")


def cross(one: str, other: str, point: Point) -> Pair:
    """A universal joint."""
    return Pair("U", one, other, f"point: {list(point)}, axis: [0, 0, 1], axis2: [1, 0.3, 0]")


def windows(count: int) -> Network:
    """Plane four-bars, each rocker the crank of the next, written window by window."""
    links, joints = ["c0"], {"O0": turn("ground", "c0", (0, 0, 0))}
    for k in range(count):
        x = 4 * k
        links += [f"b{k}", f"c{k + 1}"]
        joints[f"A{k}"] = turn(f"c{k}", f"b{k}", (x + 0.1, 1 + 0.1 * (k % 3), 0))
        joints[f"B{k}"] = turn(f"b{k}", f"c{k + 1}", (x + 4.3, 1.5, 0))
        joints[f"O{k + 1}"] = turn("ground", f"c{k + 1}", (x + 4, 0, 0))
    return Network(links, joints, ["O0.theta"])


def scissors(count: int) -> Network:
    """Storeys of two crossed bars, the lowest on a pin and a shoe. Bars lead from (0, 0.4 k) to
    (1, 0.4 k + 0.4), or from (1, 0.4 k) to (0, 0.4 k + 0.4)."""
    links = ["shoe"]
    joints = {
        "A0": turn("ground", "a0", (0, 0, 0)),
        "S": slide("ground", "shoe", (1, 0, 0), (1, 0, 0)),
        "B0": turn("shoe", "b0", (1, 0, 0)),
    }
    for k in range(count):
        links += [f"a{k}", f"b{k}"]
        joints[f"M{k}"] = turn(f"a{k}", f"b{k}", (0.5, 0.4 * k + 0.2, 0))
    for k in range(1, count):
        joints[f"L{k}"] = turn(f"b{k - 1}", f"a{k}", (0, 0.4 * k, 0))
        joints[f"R{k}"] = turn(f"a{k - 1}", f"b{k}", (1, 0.4 * k, 0))
    return Network(links, joints, ["A0.theta"])


def parallelograms(count: int) -> Network:
    """Cranks of length 1 that couplers of length 4 keep parallel, one after the other."""
    links, joints = ["c0"], {"O0": turn("ground", "c0", (0, 0, 0))}
    for k in range(count):
        links += [f"b{k}", f"c{k + 1}"]
        joints[f"A{k}"] = turn(f"c{k}", f"b{k}", (4 * k, 1, 0))
        joints[f"B{k}"] = turn(f"b{k}", f"c{k + 1}", (4 * k + 4, 1, 0))
        joints[f"O{k + 1}"] = turn("ground", f"c{k + 1}", (4 * k + 4, 0, 0))
    return Network(links, joints, ["O0.theta"])


def ladder(count: int) -> Network:
    """A plane four-bar with dyads on its sides, one above the other."""
    links = ["a", "b", "c"]
    joints = {
        "A": turn("ground", "a", (0, 0, 0)),
        "B": turn("a", "b", (0, 1, 0)),
        "C": turn("b", "c", (3, 2, 0)),
        "D": turn("c", "ground", (3, 0, 0)),
    }
    left, right = "a", "c"
    for k in range(count - 1):
        links += [f"p{k}", f"q{k}"]
        joints[f"P{k}"] = turn(left, f"p{k}", (-0.3, 1.5 + k, 0))
        joints[f"M{k}"] = turn(f"p{k}", f"q{k}", (1.5, 2.5 + k, 0))
        joints[f"Q{k}"] = turn(f"q{k}", right, (3.4, 1.7 + k, 0))
        left, right = f"p{k}", f"q{k}"
    return Network(links, joints, ["A.theta"])


AXES = ((0, 0, 1), (0.1, 1, 0.2), (1, 0.2, 0.3))


def spatial_train(count: int, *, legs: bool = False, plane: bool = False) -> Network:
    """RSUR loops (RSSR with `legs`) in a row; with `plane` a plane four-bar between each two."""
    links, joints = ["c0"], {"O0": turn("ground", "c0", (0, 0, 0))}
    for k in range(count):
        x, crank = 8 * k, f"c{k}"
        if plane:
            links += [f"e{k}", f"f{k}"]
            axis = AXES[k % 3] if not plane else Z
            joints[f"E{k}"] = turn(crank, f"e{k}", (x, 1, 0), axis)
            joints[f"F{k}"] = turn(f"e{k}", f"f{k}", (x + 3, 1.5, 0), axis)
            joints[f"G{k}"] = turn("ground", f"f{k}", (x + 3, 0, 0), axis)
            crank = f"f{k}"
        links += [f"b{k}", f"c{k + 1}"]
        joints[f"A{k}"] = sphere(crank, f"b{k}", (x + 3.3, 1, 0.2))
        end = sphere if legs else cross
        joints[f"B{k}"] = end(f"b{k}", f"c{k + 1}", (x + 7.3, 1.5, 1))
        axis = Z if plane else AXES[(k + 1) % 3]
        joints[f"O{k + 1}"] = turn("ground", f"c{k + 1}", (x + 8, 0, 0), axis)
    return Network(links, joints, ["O0.theta"])


def walking_legs(count: int) -> Network:
    """Theo Jansen's legs on one crank, all as drawn alike: per leg two couplers j, k on the crank
    pin, rocker c and triangle t on ground, rod f, foot g. The knee joins k, c and g."""
    pin, fixed = (15, 0, 0), (-38, -7.8, 0)
    upper, knee, hip, heel = (-20, 36, 0), (-22, -40, 0), (-75, 8, 0), (-58, -35, 0)
    links, joints = ["crank"], {"O": turn("ground", "crank", (0, 0, 0))}
    for n in range(count):
        links += [f"{name}{n}" for name in "jktcfg"]
        joints |= {
            f"J{n}": turn("crank", f"j{n}", pin),
            f"X{n}": turn(f"j{n}", f"t{n}", upper),
            f"F{n}": turn("ground", f"t{n}", fixed),
            f"K{n}": turn("crank", f"k{n}", pin),
            f"U{n}": turn(f"k{n}", f"c{n}", knee),
            f"C{n}": turn(f"c{n}", "ground", fixed),
            f"V{n}": turn(f"t{n}", f"f{n}", hip),
            f"W{n}": turn(f"f{n}", f"g{n}", heel),
            f"Y{n}": turn(f"c{n}", f"g{n}", knee),
        }
    return Network(links, joints, ["O.theta"])


def platforms(count: int) -> Network:
    """Stewart platforms, each on the one before."""
    links: list[str] = []
    joints: dict[str, Pair] = {}
    inputs, base = [], "ground"
    for n in range(count):
        links.append(f"plate{n}")
        for k in range(6):
            a = math.radians(120 * (k // 2) + (12 if k % 2 else -12))
            b = math.radians(120 * ((k + 1) // 2) - 60 + (-10 if k % 2 else 10))
            foot = (round(math.cos(a), 3), round(math.sin(a), 3), float(n))
            head = (round(0.6 * math.cos(b), 3), round(0.6 * math.sin(b), 3), n + 1.0)
            axis = tuple(round(h - f, 9) for h, f in zip(head, foot, strict=True))
            links += [f"tube{n}_{k}", f"rod{n}_{k}"]
            joints[f"A{n}_{k}"] = sphere(base, f"tube{n}_{k}", foot)
            joints[f"L{n}_{k}"] = slide(f"tube{n}_{k}", f"rod{n}_{k}", foot, axis)
            joints[f"B{n}_{k}"] = sphere(f"rod{n}_{k}", f"plate{n}", head)
            inputs.append(f"L{n}_{k}.s")
        base = f"plate{n}"
    return Network(links, joints, inputs)


def beside(one: Network, other: Network) -> Network:
    """Two networks on one ground, the second with longer names."""
    names = {link: f"{link}x" for link in other.links} | {"ground": "ground"}
    joints = {
        f"{name}x": p._replace(first=names[p.first], second=names[p.second])
        for name, p in other.joints.items()
    }
    inputs = [name.replace(".", "x.") for name in other.inputs]
    links = [names[link] for link in other.links]
    return Network([*one.links, *links], one.joints | joints, [*one.inputs, *inputs])


def shuffled(network: Network, seed: int, *, renamed: bool = True) -> Network:
    """The same written in another order, the links of some joints exchanged; other names."""
    rng = random.Random(seed)
    links, joints, inputs = list(network.links), list(network.joints.items()), network.inputs[:]
    rng.shuffle(links)
    rng.shuffle(joints)
    rng.shuffle(inputs)
    link_name, joint_name = {"ground": "ground"}, {}
    for k, link in enumerate(links):
        link_name[link] = f"n{rng.randrange(10**6)}_{k}" if renamed else link
    for k, (name, _) in enumerate(joints):
        joint_name[name] = f"z{rng.randrange(10**6)}_{k}" if renamed else name
    found = {}
    for name, pair in joints:
        ends = [link_name[pair.first], link_name[pair.second]]
        if rng.random() < 0.5:
            ends.reverse()
        found[joint_name[name]] = pair._replace(first=ends[0], second=ends[1])
    words = [name.split(".") for name in inputs]
    driven = [f"{joint_name[joint]}.{coordinate}" for joint, coordinate in words]
    return Network([link_name[link] for link in links], found, driven)


class _Growth:
    """A random network, grown by groups that are placed by what is there before."""

    def __init__(self, seed: int) -> None:
        self.rng = random.Random(seed)
        self.network = Network([], {}, [])
        self.plane = ["ground"]
        self.arm("ground")

    def link(self, *, plane: bool = True) -> str:
        name = f"l{len(self.network.links)}"
        self.network.links.append(name)
        if plane:
            self.plane.append(name)
        return name

    def join(self, pair: Pair, coordinate: str = "") -> None:
        name = f"j{len(self.network.joints)}"
        self.network.joints[name] = pair
        if coordinate:
            self.network.inputs.append(f"{name}.{coordinate}")

    def point(self, *, plane: bool = True) -> list[float]:
        x, y, z = (round(self.rng.uniform(-3, 3), 3) for _ in range(3))
        return [x, y, 0 if plane else z]

    def plane_pair(self, one: str, other: str) -> Pair:
        if self.rng.random() < 0.15:
            return slide(one, other, self.point(), [*self.point()[:1], 1, 0])
        return turn(one, other, self.point())

    def arm(self, base: str) -> None:
        self.join(turn(base, self.link(), self.point()), "theta")

    def dyad(self, one: str, other: str) -> None:
        x, y = self.link(), self.link()
        self.join(self.plane_pair(one, x))
        self.join(turn(x, y, self.point()))
        self.join(self.plane_pair(y, other))

    def driven_chain(self, one: str, other: str) -> None:
        """Four bars from a link to another (or back to it), driven at the second joint."""
        x, y, z = self.link(), self.link(), self.link()
        self.join(turn(one, x, self.point()))
        self.join(turn(x, y, self.point()), "theta")
        self.join(self.plane_pair(y, z))
        self.join(turn(z, other, self.point()))

    def triad(self) -> None:
        """A ternary link on three bars."""
        ends = [self.rng.choice(self.plane) for _ in range(3)]
        if len(set(ends)) == 1:
            ends = ["ground", self.plane[1], self.plane[1]]
        middle = self.link()
        for end in ends:
            bar = self.link()
            self.join(self.plane_pair(end, bar))
            self.join(turn(bar, middle, self.point()))

    def spatial(self) -> None:
        """Six freedoms between two links."""
        one, other = self.rng.sample(["ground", *self.network.links], 2)
        while True:
            letters = self.rng.choices("RRRPCHSU", k=self.rng.randint(3, 6))
            count = sum(FREEDOMS[letter] for letter in letters)
            if count == 6 and "SS" not in "".join(letters):
                break
        ends = [one, *(self.link(plane=False) for _ in letters[1:]), other]
        for k, letter in enumerate(letters):
            rest = f"point: {self.point(plane=False)}"
            rest += f", axis: {self.point(plane=False)}" if letter != "S" else ""
            rest += f", axis2: {self.point(plane=False)}" if letter == "U" else ""
            rest += ", lead: 0.3" if letter == "H" else ""
            self.join(Pair(letter, ends[k], ends[k + 1], rest))


def random_network(seed: int, groups: int) -> Network:
    """Plane dyads, triads, driven chains (some riding on one link), arms, spatial loops."""
    growth = _Growth(seed)
    rng = growth.rng
    for _ in range(groups):
        kind = rng.choices(["dyad", "triad", "chain", "arm", "space"], [8, 3, 3, 1, 8])[0]
        one, other = rng.choice(growth.plane), rng.choice(growth.plane)
        if kind == "dyad" and one != other:
            growth.dyad(one, other)
        elif kind == "triad":
            growth.triad()
        elif kind == "chain" and (one, other) != ("ground", "ground"):
            growth.driven_chain(one, other)
        elif kind == "arm":
            growth.arm(one)
        else:
            growth.spatial()
    return growth.network
