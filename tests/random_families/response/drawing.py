"""Random mechanisms that move by themselves, assembled as drawn: one to three loops, open chains,
all joints, one to three freedoms, all kinds of loads.

A chain of joints closes a loop where its freedoms are six more than those that it brings. The start
names coordinates that determine the velocities of the drawing well.
"""

from __future__ import annotations

import itertools
import random
from typing import Any

import numpy as np
import scipy.linalg
from oracle.document import Document, to_text
from oracle.dynamics.drawn import draw
from oracle.dynamics.motion import Motion
from oracle.dynamics.rows import Array
from oracle.mechanism import COORDINATES, FREEDOMS
from oracle.random_parts import body, joint, number, vector
from oracle.reader import read

_TYPES = ("R",) * 4 + ("P", "C", "C", "H", "S", "S", "Sp", "Sg", "U", "U", "E", "W")
_OPEN = ("R", "R", "P", "H", "C", "U", "E")
_SPHERES = ("S", "Sp", "Sg")
_WORST_CONDITION = 300.0
_WORST_START = 10.0
_LEAST_REACH = 0.03
"""Of the coordinates named, where the links move by one; an idle spin has none."""
_GRAVITY = 9.81


def drawing(seed: int) -> str:
    """The text of the mechanism of a seed."""
    rng = random.Random(seed)
    while True:
        data = _Draft(rng).draw()
        if data is not None:
            return to_text(data)


class _Draft:
    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self.links: list[str] = []
        self.joints: dict[str, Any] = {}
        self.bodies: dict[str, Any] = {}

    def draw(self) -> Document | None:
        """The mechanism's data; None where it is badly conditioned or cannot be started."""
        rng = self.rng
        loops, freedoms = rng.choice((0, 1, 1, 1, 2, 2, 3)), rng.choice((1, 1, 2, 3))
        left = freedoms
        for k in range(loops):
            more = (
                left if k == loops - 1 and rng.random() < 0.6 else rng.randint(0 if k else 1, left)
            )
            left -= self._loop(more, first=k == 0)
        if loops == 0 or left:
            self._open(left)
        data: Document = {
            "format": "1",
            "name": f"{loops} loops, {freedoms} freedoms: "
            + "-".join(j["type"] for j in self.joints.values()),
            "links": {name: body(rng, 1.0) for name in self.links},
            "joints": self.joints,
            "points": self._points(),
        }
        if len(self.links) > 2 and rng.random() < 0.2:
            data["links"][rng.choice(self.links[:-1])] = {}
        start = self._start(data, freedoms)
        if start is None:
            return None
        data["loads"] = self._loads(start)
        data["responses"] = {"run": self._response(start)}
        return data

    def _loop(self, more: int, first: bool) -> int:
        """Hangs a chain that closes a loop and brings so many freedoms."""
        rng = self.rng
        ends = ("ground", "ground")
        if not first:
            ends = (rng.choice(self.links), rng.choice(["ground", *self.links]))
        self._chain(*ends, 6 + more)
        return more

    def _chain(self, start: str, end: str, freedoms: int) -> None:
        while True:
            types = [self.rng.choice(_TYPES) for _ in range(self.rng.randint(2, 8))]
            spins = any(
                (a in _SPHERES and b in _SPHERES) or a == b == "W"
                for a, b in itertools.pairwise(types)
            )
            if sum(FREEDOMS[t] for t in types) == freedoms and not spins:
                break
        count = len(self.links)
        new = [f"L{count + i}" for i in range(1, len(types))]
        self.links += new
        for kind, pair in zip(types, itertools.pairwise([start, *new, end]), strict=True):
            self._join(kind, list(pair))

    def _open(self, freedoms: int) -> None:
        while freedoms:
            kind = self.rng.choice([t for t in _OPEN if FREEDOMS[t] <= freedoms])
            freedoms -= FREEDOMS[kind]
            start = self.rng.choice(["ground", *self.links]) if self.links else "ground"
            self.links.append(f"L{len(self.links) + 1}")
            self._join(kind, [start, self.links[-1]])

    def _join(self, kind: str, links: list[str]) -> None:
        if self.joints and self.rng.random() < 0.5:
            links.reverse()
        self.joints[f"J{len(self.joints) + 1}"] = joint(self.rng, kind, links, 1.0)

    def _points(self) -> dict[str, Any]:
        places = ["ground", *self.links]
        return {
            f"p{i}": {"link": link, "at": vector(self.rng, 1.0)} for i, link in enumerate(places)
        }

    def _start(self, data: Document, freedoms: int) -> list[str] | None:
        """Coordinates that determine the motion well, as many as there are freedoms."""
        motion = Motion(draw(read(data)), [])
        J = motion.drawn.relations.jacobian(motion.posture(motion.home())) * motion.scales
        values = np.linalg.svd(motion.held @ J, compute_uv=False)
        rank = int(np.sum(values > values[0] / _WORST_CONDITION))
        if rank < len(motion.held) or J.shape[1] - rank != freedoms:
            return None
        free = scipy.linalg.null_space(motion.held @ J, rcond=1e-9)
        mass = _reduced_mass(motion, free)
        if mass is None:
            return None
        reach = motion.counted @ J @ free
        names = list(motion.drawn.coordinates)
        scaled = [_is_long(name) / motion.drawn.size or 1.0 for name in names]
        reach *= np.array(scaled)[:, None]
        if len(names) < freedoms:
            return None
        order = list(range(len(names)))
        self.rng.shuffle(order)
        _, _, chosen = scipy.linalg.qr(reach[order].T, mode="economic", pivoting=True)
        picked = [order[k] for k in chosen[:freedoms]]
        values = np.linalg.svd(reach[picked], compute_uv=False)
        if values[-1] < max(_LEAST_REACH, values[0] / _WORST_START):
            return None
        return [names[k] for k in picked]

    def _loads(self, start: list[str]) -> list[dict[str, Any]]:
        rng = self.rng
        down = np.array([rng.gauss(0, 1) for _ in range(3)])
        down *= _GRAVITY / np.sqrt(down @ down)
        gravity = {"type": "gravity", "g": [number(x) for x in down]}
        others = [f() for f in self._other_loads(start) if rng.random() < 0.4]
        return [gravity, *(load for load in others if load)]

    def _other_loads(self, start: list[str]) -> list[Any]:
        rng = self.rng
        points = [f"p{i}" for i in range(len(self.links) + 1)]
        joint, coordinate = rng.choice(start).split(".")
        turning = coordinate.startswith("theta")

        def couple() -> dict[str, Any] | None:
            names = [n for n, j in self.joints.items() if "theta" in COORDINATES[j["type"]]]
            if not names:
                return None
            name = rng.choice(names)
            value = (
                f"{rng.uniform(-2, 2):.3f} N*m*sin({rng.uniform(1, 6):.3f} rad/s*time)"
                f" - {rng.uniform(0, 1):.3f} N*m*s/rad*{name}.theta_dot"
            )
            return {"type": "torque", "joint": name, "value": value}

        return [
            lambda: {
                "type": "spring",
                "between": rng.sample(points, 2),
                "stiffness": number(rng.uniform(5, 40)),
                "free": number(rng.uniform(0.2, 1.0)),
                "preload": number(rng.uniform(-2, 2)),
            },
            lambda: {
                "type": "damper",
                "between": rng.sample(points, 2),
                "damping": number(rng.uniform(0.2, 2)),
            },
            lambda: {
                "type": "spring",
                "joint": joint,
                "coordinate": coordinate,
                "stiffness": number(rng.uniform(2, 20)),
                "free": number(rng.uniform(-30, 30) if turning else rng.uniform(-0.3, 0.3)),
            },
            lambda: {
                "type": "damper",
                "joint": joint,
                "coordinate": coordinate,
                "damping": number(rng.uniform(0.1, 1)),
            },
            couple,
            lambda: {
                "type": "force",
                "link": rng.choice(self.links),
                "point": vector(rng, 1.0),
                "force": vector(rng, 3.0),
                "axes": rng.choice(("link", "ground")),
            },
            lambda: {
                "type": "torque",
                "link": rng.choice(self.links),
                "torque": vector(rng, 2.0),
                "axes": rng.choice(("link", "ground")),
            },
        ]

    def _response(self, start: list[str]) -> Document:
        rng = self.rng
        begin: dict[str, str] = dict.fromkeys(start, "0")
        for name in start:
            turning = not _is_long(name)
            unit = " rad/s" if turning else ""
            begin[f"{name}_dot"] = number(rng.uniform(-2, 2) * (1 if turning else 0.5)) + unit
        response: Document = {"start": begin, "time": {"from": "0", "to": "1.2", "count": "5"}}
        if rng.random() < 0.5:
            name = rng.choice(start)
            unit = "N" if _is_long(name) else "N*m"
            response["efforts"] = {name: f"{rng.uniform(-2, 2):.3f} {unit}"}
        return response


def _is_long(name: str) -> bool:
    return not name.rpartition(".")[2].startswith("theta")


def _reduced_mass(motion: Motion, free: Array) -> Array | None:
    """The reduced inertia, None where it is badly conditioned."""
    drawn = motion.drawn
    mass = np.zeros((6 * motion.links,) * 2)
    for k in range(motion.links):
        i = 6 * k
        mass[range(i, i + 3), range(i, i + 3)] = drawn.mass[k]
        mass[i + 3 : i + 6, i + 3 : i + 6] = drawn.inertia[k]
    reduced = free.T @ (mass * motion.scales * motion.scales[:, None]) @ free
    values = np.linalg.eigvalsh(reduced)
    return reduced if values[0] * 1e3 > values[-1] else None
