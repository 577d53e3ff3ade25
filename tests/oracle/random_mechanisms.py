"""Random single-loop mechanisms as text of format 1, assembled as drawn."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any

from oracle.document import Document, to_text
from oracle.kinematics import condition, predicted, solve
from oracle.mechanism import COORDINATES, FREEDOMS, Mechanism
from oracle.numerics import UnsolvableError
from oracle.random_parts import body, joint, law, number, vector
from oracle.reader import read

_MOST_TRIES = 200
_FARTHEST = 0.05  # rad, or part of the size: from where the velocities of home lead


def random_loop(
    rng: random.Random,
    types: str = "RCSR",
    *,
    size: float = 1.0,
    units: Mapping[str, str] | None = None,
    rows: int = 5,
    worst_condition: float = 60.0,
) -> str:
    """The text of a random loop of the joint types, ground first and last, with one input.

    The freedoms must sum to seven. Joint J1 is driven by its first coordinate, `rows` rows spread
    over four degrees (or 4 % of the size) to either side of home, with rate and acceleration. Every
    link has mass and a realisable inertia; loads are gravity, one joint load, one force on a link
    (turning with it) and one torque. Bare numbers are in `units` (default m, deg, kg, N, s),
    lengths about `size`; points are `p1`, `p2`, ... on links `L1`, `L2`, ... Loops whose condition
    at home exceeds `worst_condition`, or that bend sharply before the last rows, are drawn again.
    """
    if sum(FREEDOMS[t] for t in types) != 7 or types[0] == "S":
        raise ValueError(f"{types}: the freedoms must sum to 7, and an S cannot be driven")
    for _ in range(_MOST_TRIES):
        data = _draw(rng, types, size, units, rows)
        if _is_tame(read(data), worst_condition):
            return to_text(data)
    raise ValueError(f"{types}: no loop with a condition below {worst_condition} was found")


def _is_tame(mechanism: Mechanism, worst_condition: float) -> bool:
    """Well conditioned at home, and followed from there to the last rows without surprise."""
    try:
        home = solve(mechanism, dict.fromkeys(mechanism.inputs, (0, 1)))
        if condition(mechanism, home) > worst_condition:
            return False
        for row in (0, mechanism.rows - 1):
            guess = predicted(home, mechanism.row(row))
            found = solve(mechanism, mechanism.row(row), guess)
            for name, value in found.coordinates.items():
                scale = mechanism.size if name.endswith(".s") else 1
                if name.endswith((".s", ".theta")) and abs(value - guess[name]) > _FARTHEST * scale:
                    return False
    except UnsolvableError:
        return False
    return True


def _draw(
    rng: random.Random, types: str, size: float, units: Mapping[str, str] | None, rows: int
) -> Document:
    count = len(types)
    links = ["ground", *(f"L{i}" for i in range(1, count)), "ground"]
    data: dict[str, Any] = {"format": "1", "name": f"random {types}"}
    if units:
        data["units"] = dict(units)
    data["links"] = {link: body(rng, size) for link in links[1:-1]}
    data["joints"] = {
        f"J{i + 1}": joint(rng, t, links[i : i + 2], size) for i, t in enumerate(types)
    }
    data["points"] = {f"p{i}": {"link": f"L{i}", "at": vector(rng, size)} for i in range(1, count)}
    driven = f"J1.{COORDINATES[types[0]][0]}"
    data["motion"] = {"inputs": {driven: law(rng, driven, size, rows)}}
    data["loads"] = _loads(rng, types, size)
    return data


def _loads(rng: random.Random, types: str, size: float) -> list[dict[str, Any]]:
    last = max(i for i, t in enumerate(types) if t != "S")
    coordinate = COORDINATES[types[last]][0]
    kind, scale = ("torque", size * size) if coordinate == "theta" else ("force", size)
    return [
        {"type": "gravity", "g": vector(rng, 3 * size)},
        {"type": kind, "joint": f"J{last + 1}", "value": number(scale * rng.uniform(-2, 2))},
        {
            "type": "force",
            "link": "L1",
            "point": vector(rng, size),
            "force": vector(rng, size),
            "axes": "link",
        },
        {"type": "torque", "link": f"L{len(types) - 1}", "torque": vector(rng, size * size)},
    ]
