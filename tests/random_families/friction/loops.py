"""Random loops of rubbing joints: documents in m, deg, kg and N, with what is needed to judge them.

Every pair with a law of friction comes with random keys of that law; points and directions of the
document read off everything from which free-body equations can be written.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

FREEDOMS = {"R": 1, "P": 1, "C": 2, "H": 1, "S": 3, "Sp": 5, "Sg": 4, "U": 2}
COORDINATES = {
    "R": ("theta",),
    "P": ("s",),
    "C": ("theta", "s"),
    "H": ("theta", "s"),
    "Sg": ("s",),
    "U": ("theta1", "theta2"),
}
AXIS = {"Sp": "normal", "Sg": "groove", "S": None}
RADIUS = {"R", "C", "H", "S"}
POOL = [*"RRRRPPCCCHHSSSU", "Sp", "Sg", "Sp", "Sg"]
ROWS = 4


@dataclass(frozen=True)
class Loop:
    """A document, the pairs' types by name, its links in order, inputs, and a force on a link."""

    data: dict[str, Any]
    types: dict[str, str]
    links: tuple[str, ...]
    inputs: tuple[str, ...]
    forced: str
    force: tuple[float, ...]

    @property
    def frictions(self) -> dict[str, dict[str, Any]]:
        """The friction loads by joint."""
        return {load["joint"]: load for load in self.data["loads"] if load["type"] == "friction"}

    @property
    def drives(self) -> tuple[str, ...]:
        """Where efforts act."""
        return tuple(self.data.get("actuators", self.inputs))

    def rubbing(self, factor: float) -> Loop:
        """The same with constant coefficients, times a factor."""
        loads = []
        for load in self.data["loads"]:
            if load["type"] == "friction":
                given = load["coefficient"]
                mu = given["sliding"] if isinstance(given, dict) else given
                load = load | {"coefficient": factor * mu}
            loads.append(load)
        return replace(self, data=self.data | {"loads": loads})

    def smooth(self) -> Loop:
        """The same without friction."""
        loads = [load for load in self.data["loads"] if load["type"] != "friction"]
        return replace(self, data=self.data | {"loads": loads})


def vector(rng: random.Random, size: float = 1.0) -> list[float]:
    return [round(rng.uniform(-size, size), 3) for _ in range(3)]


def loop(seed: int, *, actuators: bool = False) -> Loop | None:
    """The loop of a seed; None where its inputs, or its actuators, cannot be chosen."""
    rng = random.Random(seed)
    freedoms = rng.choice([1, 1, 1, 2])
    kinds = _kinds(rng, freedoms)
    links = ("ground", *(f"l{k}" for k in range(1, len(kinds))), "ground")
    data: dict[str, Any] = {"format": 1, "name": f"loop {seed}", "units": {"length": "m"}}
    data |= {"accept": ["unphysical-inertia"], "links": {}, "joints": {}}
    data |= {"points": {}, "directions": {}, "loads": []}
    for link in links[:-1]:
        _add_link(rng, data, link)
    types = {f"J{k}": kind for k, kind in enumerate(kinds)}
    for k, (name, kind) in enumerate(types.items()):
        _add_joint(rng, data, name, kind, links[k : k + 2])
    free = [f"{name}.{c}" for name, kind in types.items() for c in COORDINATES.get(kind, ())]
    inputs = _inputs(rng, free, types, freedoms)
    single = [c for c in free if not (types[c.partition(".")[0]] == "H" and c.endswith(".s"))]
    acting = freedoms + (rng.random() < 0.4)
    if inputs is None or (actuators and len(single) < acting):
        return None
    data["motion"] = {"inputs": {name: _sweep(rng, name) for name in inputs}}
    forced, force = rng.choice(links[1:-1]), vector(rng, 30)
    data["points"]["forced"] = {"link": forced, "at": vector(rng)}
    data["loads"] += [
        {"type": "gravity", "g": [0, 0, -9.81]},
        {"type": "force", "link": forced, "point": data["points"]["forced"]["at"], "force": force},
    ]
    if actuators:
        data["actuators"] = rng.sample(single, acting)
    return Loop(data, types, links, inputs, forced, tuple(force))


def _kinds(rng: random.Random, freedoms: int) -> list[str]:
    while True:
        kinds = [rng.choice(POOL) for _ in range(rng.randint(3, 7))]
        balls = sum(kind in ("S", "Sp", "Sg") for kind in kinds)
        turning = sum(kind != "P" for kind in kinds)
        if sum(FREEDOMS[kind] for kind in kinds) != 6 + freedoms or balls > 1:
            continue
        if turning >= 3 and kinds.count("P") <= 2 and kinds[0] in "RPCH":
            return kinds


def _add_link(rng: random.Random, data: dict[str, Any], link: str) -> None:
    for name, axis in zip("xyz", np.eye(3).tolist(), strict=True):
        data["directions"][f"{link}{name}"] = {"link": link, "vector": axis}
    if link == "ground":
        return
    root = np.array([vector(rng, 0.3) for _ in range(3)])
    tensor = (root @ root.T + 0.05 * np.eye(3)).round(4)
    keys = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
    centre = vector(rng)
    data["links"][link] = {
        "mass": round(rng.uniform(0.2, 3), 2),
        "center_of_mass": centre,
        "inertia": {key: float(tensor[at]) for key, at in keys.items()},
    }
    data["points"][f"g{link}"] = {"link": link, "at": centre}


def _add_joint(
    rng: random.Random, data: dict[str, Any], name: str, kind: str, links: tuple[str, ...]
) -> None:
    first, second = links[::-1] if rng.random() < 0.3 else links
    point, axis = vector(rng), vector(rng)
    while np.linalg.norm(axis) < 0.3:
        axis = vector(rng)
    joint: dict[str, Any] = {"type": kind, "links": [first, second], "point": point}
    key = AXIS.get(kind, "axis")
    if key:
        joint[key] = axis
    if kind == "H":
        joint["lead"] = round(rng.uniform(-0.5, 0.5), 3) or 0.2
    if kind == "U":
        joint["axis2"] = vector(rng)
        data["directions"][f"y{name}"] = {"link": second, "vector": joint["axis2"]}
    data["joints"][name] = joint
    place = first if kind in ("Sp", "Sg") else second
    for word, link in (("p", place), ("q", first), ("r", second)):
        data["points"][f"{word}{name}"] = {"link": link, "at": point}
    data["directions"][f"z{name}"] = {
        "link": first if kind == "U" else second,
        "vector": axis if key else [1, 0, 0],
    }
    if kind != "U" and rng.random() < 0.8:
        data["loads"].append(_friction(rng, data, name, kind))


def _friction(rng: random.Random, data: dict[str, Any], name: str, kind: str) -> dict[str, Any]:
    load: dict[str, Any] = {"type": "friction", "joint": name}
    load["coefficient"] = rng.choice([0.02, 0.05, 0.1, 0.2, 0.4])
    if rng.random() < 0.3:
        load["coefficient"] = {"static": 0.15, "sliding": 0.1}
        if rng.random() < 0.7:
            load["coefficient"]["speed"] = round(rng.uniform(0.05, 1), 3)
    if kind in RADIUS:
        load["radius"] = round(rng.uniform(0.02, 0.15), 3)
    if kind == "P" or (kind in ("R", "C") and rng.random() < 0.6):
        load["length"] = round(rng.uniform(0.2, 1), 3)
    if kind == "R" and rng.random() < 0.5:
        load["collar"] = round(rng.uniform(0.02, 0.2), 3)
    if kind == "P" and rng.random() < 0.6:
        load["width"] = round(rng.uniform(0.1, 0.5), 3)
        if rng.random() < 0.5:
            joint = data["joints"][name]
            across = np.cross(joint["axis"], vector(rng)).round(6).tolist()
            load["across"] = across
            data["directions"][f"w{name}"] = {"link": joint["links"][1], "vector": across}
    if kind == "H" and rng.random() < 0.6:
        load["flank"] = round(rng.uniform(5, 30), 1)
    return load


def _inputs(
    rng: random.Random, free: list[str], types: dict[str, str], freedoms: int
) -> tuple[str, ...] | None:
    able = [c for c in free if types[c.partition(".")[0]] not in ("U", "Sg")]
    for _ in range(50):
        chosen = rng.sample(able, min(freedoms, len(able)))
        threads = [c.partition(".")[0] for c in chosen if types[c.partition(".")[0]] == "H"]
        if len(chosen) == freedoms and len(set(threads)) == len(threads):
            return tuple(chosen)
    return None


def _sweep(rng: random.Random, name: str) -> dict[str, Any]:
    if name.endswith(".s"):
        last, rates = round(rng.uniform(0.05, 0.2), 3), (1.0, 2.0, "m/s")
    else:
        last, rates = round(rng.uniform(3, 15), 2), (2.0, 3.0, "rad/s")
    first, second, unit = rates
    return {
        "from": 0,
        "to": last,
        "count": ROWS,
        "rate": f"{rng.uniform(-first, first):.3f} {unit}",
        "acceleration": f"{rng.uniform(-second, second):.3f} {unit}^2",
    }
