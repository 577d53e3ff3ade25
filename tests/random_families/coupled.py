"""Random mechanisms with couplings, in sweeps and responses, against the dense system of
`couplings/dense.py`: `python -m random_families.coupled 0:100` takes more.

One to three loops in a plane or in space, hung on the ground or on one another; wheels, rings,
racks, suns with their planets on links that move, and linear relations of two or three coordinates,
until one to three freedoms are left. All masses, ratios, angles of teeth and loads are random.
"""

from __future__ import annotations

import random
import sys
from typing import Any, NamedTuple

import numpy as np
import yaml
from couplings.dense import Dense, Solved, Unclosed, square_to

import mechkin_cli as mk

LOOPS = {
    False: ("RCSR", "RSCR", "RRSRR", "CRSR", "RPSRR", "RCSC", "RRCSR", "RRCRRR", "RRSRRR"),
    True: ("RRRR", "RRRP", "RRPR", "PRRR", "RRRRR", "RRPRR"),
}
FREEDOMS = {"R": 1, "P": 1, "C": 2, "S": 3}
ROWS = 4
TIMES = (0.0, 0.1, 0.2)
MOST_CONDITION = 300.0


class Judged(NamedTuple):
    """A word, and the largest errors of motion and of forces, in parts of the largest."""

    word: str
    motion: float = 0.0
    forces: float = 0.0


class _Drawing:
    """A file as it grows."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self.flat = rng.random() < 0.4
        self.links: dict[str, Any] = {}
        self.joints: dict[str, Any] = {}
        self.couplings: dict[str, Any] = {}
        self.freedoms = 0

    def vector(self, size: float = 1.0) -> list[float]:
        parts = 2 if self.flat else 3
        return [round(self.rng.uniform(-size, size), 3) for _ in range(parts)]

    def link(self) -> str:
        name = f"L{len(self.links) + 1}"
        some = [round(self.rng.uniform(0.2, 0.3), 3) for _ in range(3)]
        inertia = some[0] if self.flat else dict(zip(("xx", "yy", "zz"), some, strict=True))
        mass = round(self.rng.uniform(0.5, 2.0), 3)
        self.links[name] = {"mass": mass, "center_of_mass": self.vector(), "inertia": inertia}
        return name

    def joint(self, kind: str, one: str, other: str, point: Any, axis: Any) -> str:
        name = f"J{len(self.joints) + 1}"
        links = [one, other] if self.rng.random() < 0.7 else [other, one]
        self.joints[name] = {"type": kind, "links": links, "point": [float(x) for x in point]}
        if kind in ("R", "P", "C") and not (self.flat and kind == "R"):
            self.joints[name]["axis"] = [float(x) for x in axis]
        return name

    def axis(self) -> list[float]:
        while True:
            found = self.vector()
            if np.linalg.norm(found) > 0.3:
                return found

    def loop(self) -> None:
        kinds = self.rng.choice(LOOPS[self.flat])
        ends = ["ground", *self.links] if self.links else ["ground"]
        inner = [self.link() for _ in kinds[1:]]
        way = [self.rng.choice(ends), *inner, self.rng.choice(ends)]
        for kind, one, other in zip(kinds, way[:-1], way[1:], strict=True):
            self.joint(kind, one, other, self.vector(), self.axis())
        self.freedoms += sum(FREEDOMS[kind] for kind in kinds) - (3 if self.flat else 6)

    def space_of(self, joint: str) -> tuple[Any, Any]:
        given = self.joints[joint]
        axis = np.array(given.get("axis", [0.0, 0.0, 1.0]), dtype=float)
        point = np.array([*given["point"], 0.0][:3], dtype=float)
        return point, axis / np.linalg.norm(axis)

    def beside(self, joint: str, distance: float) -> list[float]:
        """A point off a joint's axis."""
        point, axis = self.space_of(joint)
        one, other = square_to(axis)
        angle = self.rng.uniform(0.0, 6.28)
        way = np.cos(angle) * one + np.sin(angle) * other
        found = point + distance * way + (0.0 if self.flat else self.rng.uniform(-1, 1)) * axis
        return list(found[:2] if self.flat else found)

    def along(self, joint: str) -> list[float]:
        """A joint's axis, either way."""
        sign = self.rng.choice([1.0, -1.0])
        return [sign * float(x) for x in self.space_of(joint)[1]]

    def teeth(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        if self.rng.random() < 0.2:
            return {"ideal": True}
        if self.rng.random() < 0.7:
            found["pressure_angle"] = round(self.rng.uniform(0.1, 0.5), 3)
        if self.rng.random() < 0.5 and not self.flat:
            found["helix"] = round(self.rng.uniform(-0.6, 0.6), 3)
        return found

    def wheels(self) -> str:
        """Adds a wheel that meshes with one at a joint; its joint."""
        joint = self.rng.choice([n for n, j in self.joints.items() if j["type"] == "R"])
        numbers = self.rng.sample(range(11, 80), 2)
        carrier = self.rng.choice(self.joints[joint]["links"])
        point = self.beside(joint, round(self.rng.uniform(0.3, 1.0), 3))
        own = self.joint("R", carrier, self.link(), point, self.along(joint))
        self.gear([joint, own], numbers)
        return own

    def gear(self, joints: list[str], numbers: list[int]) -> None:
        given = {"type": "gear", "joints": joints, "teeth": numbers, **self.teeth()}
        if self.rng.random() < 0.3:
            given["internal"] = True
        if self.rng.random() < 0.5:
            given |= {"joints": joints[::-1], "teeth": numbers[::-1]}
        self.couplings[f"K{len(self.couplings) + 1}"] = given

    def planet(self) -> str:
        """Adds a sun about a joint and its planet on the link that turns there; the sun's joint."""
        joint = self.rng.choice([n for n, j in self.joints.items() if j["type"] == "R"])
        base, arm = self.joints[joint]["links"]
        sun = self.joint("R", base, self.link(), self.joints[joint]["point"], self.along(joint))
        point = self.beside(joint, round(self.rng.uniform(0.3, 1.0), 3))
        own = self.joint("R", arm, self.link(), point, self.along(joint))
        self.gear([sun, own], self.rng.sample(range(11, 80), 2))
        self.freedoms += 1
        return sun

    def rack(self) -> str:
        """Adds a rack to the wheel at a joint; its joint."""
        joint = self.rng.choice([n for n, j in self.joints.items() if j["type"] == "R"])
        carrier = self.rng.choice(self.joints[joint]["links"])
        radius = round(self.rng.uniform(0.2, 0.6), 3)
        point, axis = self.space_of(joint)
        at = np.array([*self.beside(joint, radius), 0.0][:3])
        out = at - point - (at - point) @ axis * axis
        way = np.cross(axis, out) / radius
        own = self.joint(
            "P",
            carrier,
            self.link(),
            list(at)[: len(self.vector())],
            list(way)[: len(self.vector())],
        )
        given = {"type": "rack", "joints": [joint, own], "radius": radius, **self.teeth()}
        self.couplings[f"K{len(self.couplings) + 1}"] = given
        return own

    def coordinates(self) -> list[str]:
        words = {"R": ["theta"], "P": ["s"], "C": ["theta", "s"], "S": []}
        return [f"{n}.{w}" for n, j in self.joints.items() for w in words[j["type"]]]

    def linear(self) -> None:
        names = self.rng.sample(self.coordinates(), self.rng.choice([2, 2, 3]))
        factors = [round(self.rng.choice([1, -1]) * self.rng.uniform(0.3, 3.0), 3) for _ in names]
        terms = dict(zip(names, factors, strict=True))
        self.couplings[f"K{len(self.couplings) + 1}"] = {"type": "linear", "terms": terms}
        self.freedoms -= 1

    def grown(self) -> dict[str, Any]:
        for _ in range(self.rng.randint(1, 3)):
            self.loop()
        if any(given["type"] == "R" for given in self.joints.values()):
            for _ in range(self.rng.randint(0, 2)):
                self.rng.choice([self.wheels, self.planet, self.rack])()
        wanted = self.rng.randint(1, 3)
        while self.freedoms > wanted or not self.couplings:
            self.linear()
        units = {"length": "m", "angle": "rad", "mass": "kg", "force": "N"}
        head: dict[str, Any] = {"format": 1}
        if self.flat:
            head["plane"] = "xy"
        last, slow = self.rng.choice(list(self.links)), self.rng.choice(self.coordinates())
        torque = round(self.rng.uniform(-2, 2), 3) if self.flat else self.vector(2.0)
        joint, _, word = slow.partition(".")
        loads = [
            {"type": "gravity", "g": self.vector(5.0)},
            {"type": "torque", "link": last, "torque": torque},
            {"type": "damper", "joint": joint, "coordinate": word, "damping": 0.7},
        ]
        return head | {
            "units": units,
            "links": self.links,
            "joints": self.joints,
            "couplings": self.couplings,
            "loads": loads,
        }


class Drawn(NamedTuple):
    """A file without its runs, and its inputs."""

    data: dict[str, Any]
    inputs: list[str]
    rng: random.Random


def draw(seed: int) -> Drawn:
    """The first well conditioned mechanism of a seed."""
    rng = random.Random(f"coupled {seed}")
    while True:
        drawing = _Drawing(rng)
        data = drawing.grown()
        if not 1 <= drawing.freedoms <= 3:
            continue
        dense = Dense(data)
        home = dense.at_home()
        if dense.freedoms(home) != drawing.freedoms:
            continue
        names = drawing.coordinates()
        for _ in range(5):
            inputs = rng.sample(names, drawing.freedoms)
            if dense.condition(home, inputs) < MOST_CONDITION:
                return Drawn(data, inputs, rng)


def _off(found: Any, wanted: Any, size: float = 1.0) -> float:
    return float(np.max(np.abs(np.asarray(found) - np.asarray(wanted)))) / size


def _compared(result: Any, rows: list[Solved], dense: Dense, *, sweep: bool) -> Judged:
    if set(result["row.status"]) != {"ok"} or len(result["row.status"]) != len(rows):
        return Judged(f"status {sorted(set(result['row.status']))}")
    motion = forces = 0.0
    largest = max(float(np.max(np.abs(w))) for row in rows for w in row.wrenches.values())
    for k, row in enumerate(rows):
        for name, values in row.coordinates.items():
            for order, value in enumerate(values):
                told = result[name + ("", "_dot", "_ddot")[order]][k]
                motion = max(motion, _off(told, value, max(1.0, abs(value))))
        for joint in dense.joints:
            force, moment = result[f"{joint}.force"][k], result[f"{joint}.moment_about_origin"][k]
            wrench = row.wrenches[joint]
            wanted = (wrench[:2], wrench[5]) if dense.flat else (wrench[:3], wrench[3:])
            forces = max(forces, _off(force, wanted[0], largest), _off(moment, wanted[1], largest))
        for name in dense.data["couplings"]:
            seen = set()
            for coordinate, factor in dense.terms(name).items():
                word = "torque" if coordinate.endswith("theta") else "force"
                if word not in seen:
                    seen.add(word)
                    value = factor * row.wrenches[name][0]
                    forces = max(forces, _off(result[f"{name}.{word}"][k], value, largest))
            if name in row.teeth:
                tooth = row.teeth[name][: 2 if dense.flat else 3]
                forces = max(forces, _off(result[f"{name}.tooth_force"][k], tooth, largest))
        for name, effort in row.efforts.items() if sweep else ():
            forces = max(forces, _off(result[f"{name}.effort"][k], effort, largest))
    word = "ok" if motion < 1e-9 and forces < 1e-8 else "wrong"
    if sweep and not np.all(result["row.error_bound"] < 1e-9):
        word = "without a bound of its errors"
    return Judged(word, motion, forces)


def text_of(drawn: Drawn) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """The file with its sweep and response `r`, the sweep's laws, and the response's start."""
    rng = drawn.rng
    laws = {
        name: tuple(round(rng.uniform(-1, 1) * most, 3) for most in (0.0, 0.15, 2.0, 2.0))
        for name in drawn.inputs
    }
    words = ("from", "to", "rate", "acceleration")
    inputs = {n: dict(zip(words, law, strict=True)) | {"count": ROWS} for n, law in laws.items()}
    rates = {name: round(rng.uniform(-1, 1), 3) for name in drawn.inputs}
    efforts = {name: round(rng.uniform(-2, 2), 3) for name in drawn.inputs}
    start: dict[str, Any] = dict.fromkeys(drawn.inputs, 0)
    start |= {f"{name}_dot": rate for name, rate in rates.items()}
    response = {
        "start": start,
        "efforts": efforts,
        "time": {"from": TIMES[0], "to": TIMES[-1], "step": TIMES[1]},
        "tolerance": "1e-12",
    }
    runs = {"motion": {"inputs": inputs}, "responses": {"r": response}}
    text = yaml.safe_dump({**drawn.data, **runs}, sort_keys=False)
    return text, laws, {"rates": rates, "efforts": efforts}


def judge(seed: int) -> tuple[Judged, Judged]:
    """A sweep and a response against the dense system."""
    drawn = draw(seed)
    text, laws, start = text_of(drawn)
    dense = Dense(drawn.data)
    try:
        model = mk.loads(text)
    except mk.InvalidFile as error:
        if "spins freely" in str(error):  # a link between spheres, with a load on its spin
            return Judged("beyond"), Judged("beyond")
        return Judged(f"refused: {error}"[:300]), Judged("refused")
    one = Judged("beyond")
    try:
        swept = dense.swept(laws, ROWS)
    except Unclosed:
        swept = []
    if swept and max(row.condition for row in swept) < 10 * MOST_CONDITION:
        one = _compared(model.analyze(), swept, dense, sweep=True)
    moved = dense.responded(start["rates"], start["efforts"], TIMES)
    other = _compared(model.respond("r"), moved, dense, sweep=False)
    return one, other


def main(span: str) -> None:
    """Prints what is not right, and the count of what is."""
    first, last = (int(part) for part in span.split(":"))
    right = compared = 0
    for seed in range(first, last):
        try:
            judged = judge(seed)
        except Exception as error:  # to be told beside the others
            judged = (Judged(f"{type(error).__name__}: {error}"), Judged("fell"))
        right += all(one.word in ("ok", "beyond") for one in judged)
        compared += all(one.word == "ok" for one in judged)
        if any(one.word not in ("ok", "beyond") for one in judged):
            print(seed, *judged, flush=True)
    print(f"{right} of {last - first} right, {compared} of them in sweep and response")


if __name__ == "__main__":
    main(sys.argv[1])
