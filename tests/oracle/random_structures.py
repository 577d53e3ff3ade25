"""Random mechanisms of several loops as text of format 1, assembled as drawn.

The first chain of joints goes from ground to ground, and has six freedoms plus
one for every input; every further chain hangs on links that are there already and has six, as
many as the loop that it closes takes away, plus one for an input of its own. So the mobility is the
number of inputs, and the constraints are independent where the condition is moderate, which is
measured.
"""

from __future__ import annotations

import itertools
import random
from typing import Any

from oracle.assembly import assemble, drawn_condition
from oracle.bodies import Inputs
from oracle.document import Document, to_text
from oracle.mechanism import COORDINATES, FREEDOMS, Mechanism
from oracle.numerics import Number, mp
from oracle.random_parts import body, joint, law, number, vector
from oracle.reader import read
from oracle.series import coefficient

SHAPES = ("ternary", "shared", "chained", "riding")
"""A second chain on two moving links of the first; on one of them and ground; a third on the
second; a second loop, with an input of its own, on one moving link of the first."""

_TYPES = ("R",) * 4 + ("P", "C", "C", "H", "S", "S", "Sp", "Sg", "U", "U", "E", "W")
_SPHERES = ("S", "Sp", "Sg")
_MOST_TRIES = 400
_BEND = 0.02
"""Limit of terms of second and third order of the motion to a row: rad, or parts of the size."""


def random_structure(
    rng: random.Random,
    shape: str,
    *,
    inputs: int = 1,
    tail: bool = False,
    rows: int = 3,
    worst_condition: float = 300.0,
) -> str:
    """The text of a random mechanism of a shape.

    The first input, at J1, is swept four degrees (or 4 % of the size) to either side of home; a
    second one is held near home, all have rates and accelerations. `tail` hangs one more link on a
    driven joint, an open chain. Links have mass and inertia; loads are gravity, a joint load, a
    force that turns with a link and a torque. Points are `p1`, `p2`, ... on links `L1`, `L2`, ...
    What has a condition above `worst_condition` at home or bends sharply is drawn again.
    """
    for _ in range(_MOST_TRIES):
        data = _Draft(rng).draw(shape, inputs, tail, rows)
        if data and _is_tame(read(data), worst_condition):
            return to_text(data)
    raise ValueError(f"{shape}: no mechanism with a condition below {worst_condition} was found")


def _is_tame(mechanism: Mechanism, worst_condition: float) -> bool:
    """Well conditioned at home, and nearly straight from there to the first and the last row."""
    if drawn_condition(mechanism) > worst_condition:
        return False
    # a single input's two ways from home are the same
    ends = {mechanism.rows - 1} if len(mechanism.inputs) == 1 else {0, mechanism.rows - 1}
    return all(_bend(mechanism, mechanism.row(end)) < _BEND for end in ends)


def _bend(mechanism: Mechanism, row: Inputs) -> Number:
    """The largest term of second and third order of any link's way from home to a row."""
    home = assemble(mechanism, {name: (0, value[0]) for name, value in row.items()})
    bends = [mp.zero]
    for link in mechanism.links:
        rotation, shift = home.poses[link]
        for k in (2, 3):
            bends += [abs(coefficient(x, k)) for line in rotation for x in line]
            bends += [abs(coefficient(x, k)) / mechanism.size for x in shift]
    return max(bends)


class _Draft:
    def __init__(self, rng: random.Random) -> None:
        self.rng = rng
        self.links: list[str] = []
        self.joints: dict[str, Any] = {}

    def draw(self, shape: str, inputs: int, tail: bool, rows: int) -> Document | None:
        """The mechanism's data; None where the types cannot be driven or loaded."""
        first = self._chain("ground", "ground", 6 + inputs)
        if len(first) < 2:
            return None
        driven = [n for n, j in self.joints.items() if COORDINATES[j["type"]]]
        if "J1" not in driven or len(driven) < inputs:
            return None
        held = self.rng.sample(driven[1:], inputs - 1)
        if shape == "ternary":
            self._chain(*self.rng.sample(first, 2), 6)
        elif shape == "riding":
            before, link = len(self.joints), self.rng.choice(first)
            self._chain(link, link, 7)
            own = [n for n in list(self.joints)[before:] if COORDINATES[self.joints[n]["type"]]]
            if not own:
                return None
            held.append(self.rng.choice(own))
        else:
            second = self._chain(self.rng.choice(first), "ground", 6)
            if not second:
                return None
            if shape == "chained":
                self._chain(self.rng.choice(second), self.rng.choice(["ground", *first]), 6)
        if tail:
            held.append(self._tail())
        return self._document(["J1", *held], rows)

    def _chain(self, start: str, end: str, freedoms: int) -> list[str]:
        """Hangs a chain between two links and returns its new links."""
        types = self._types(freedoms)
        count = len(self.links)
        new = [f"L{count + i}" for i in range(1, len(types))]
        self.links += new
        path = [start, *new, end]
        for kind, pair in zip(types, itertools.pairwise(path), strict=True):
            self._join(kind, list(pair))
        return new

    def _types(self, freedoms: int) -> list[str]:
        """Joint types of so many freedoms; no link between two spheres, which would spin."""
        while True:
            types: list[str] = []
            while sum(FREEDOMS[t] for t in types) < freedoms:
                types.append(self.rng.choice(_TYPES))
            neighbours = itertools.pairwise(types)
            spins = any(a in _SPHERES and b in _SPHERES for a, b in neighbours)
            if sum(FREEDOMS[t] for t in types) == freedoms and len(types) > 1 and not spins:
                return types

    def _join(self, kind: str, links: list[str]) -> str:
        name = f"J{len(self.joints) + 1}"
        if self.joints and self.rng.random() < 0.5:
            links.reverse()
        self.joints[name] = joint(self.rng, kind, links, 1.0)
        return name

    def _tail(self) -> str:
        start = self.rng.choice(self.links)
        self.links.append(f"L{len(self.links) + 1}")
        return self._join(self.rng.choice(("R", "P", "H")), [start, self.links[-1]])

    def _document(self, driven: list[str], rows: int) -> Document:
        inputs: dict[str, Any] = {}
        for name in driven:
            coordinate = f"{name}.{COORDINATES[self.joints[name]['type']][0]}"
            inputs[coordinate] = law(self.rng, coordinate, 1.0, rows)
            if len(inputs) > 1:
                for key in ("from", "count"):
                    del inputs[coordinate][key]
                inputs[coordinate]["at"] = inputs[coordinate].pop("to")
        return {
            "format": "1",
            "name": "random " + "-".join(j["type"] for j in self.joints.values()),
            "links": {link: body(self.rng, 1.0) for link in self.links},
            "joints": self.joints,
            "points": {
                f"p{i + 1}": {"link": link, "at": vector(self.rng, 1.0)}
                for i, link in enumerate(self.links)
            },
            "motion": {"inputs": inputs},
            "loads": self._loads(),
        }

    def _loads(self) -> list[dict[str, Any]]:
        rng = self.rng
        loads: list[dict[str, Any]] = [
            {"type": "gravity", "g": vector(rng, 3.0)},
            {
                "type": "force",
                "link": self.links[0],
                "point": vector(rng, 1.0),
                "force": vector(rng, 1.0),
                "axes": "link",
            },
            {"type": "torque", "link": self.links[-1], "torque": vector(rng, 1.0)},
        ]
        for name, drawn in reversed(self.joints.items()):
            coordinates = COORDINATES[drawn["type"]]
            if "theta" in coordinates or "s" in coordinates:
                kind = "torque" if "theta" in coordinates else "force"
                loads.append({"type": kind, "joint": name, "value": number(rng.uniform(-2, 2))})
                break
        return loads
