"""Random mechanisms with loads that bend and jump: magnitudes, signs, the larger and the smaller of
coordinates, rates and time, of what moves and of what the loops hold still.

Every third one is a planar four-bar, turned in space and written with a sphere and a cylinder: its
slide is rounding alone.
"""

from __future__ import annotations

import random
from typing import Any

import numpy as np
from oracle.document import Document, document, to_text
from oracle.mechanism import COORDINATES
from oracle.random_parts import number
from random_families.response.drawing import drawing as smooth_drawing

_UNITS = {"theta": ("torque", "N*m", "rad"), "s": ("force", "N", "m")}


def drawing(seed: int) -> str:
    """The text of the mechanism of a seed."""
    rng = random.Random(f"kinks {seed}")
    data = _four_bar(rng) if seed % 3 == 0 else document(smooth_drawing(seed))
    loads = [_load(rng, data) for _ in range(rng.randint(1, 3))]
    data["loads"] = [*data.get("loads", []), *(load for load in loads if load)]
    return to_text(data)


def _load(rng: random.Random, data: Document) -> dict[str, Any] | None:
    """A load along a coordinate, with kinks of that coordinate, of another one, or of time."""
    known = [
        (name, coordinate)
        for name, joint in data["joints"].items()
        for coordinate in ("theta", "s")
        if coordinate in COORDINATES[joint["type"]]
    ]
    if not known:
        return None
    name, coordinate = rng.choice(known)
    kind, unit, _ = _UNITS[coordinate]
    other, of_other = rng.choice(known)
    per = _UNITS[of_other][2]
    rate = f"({other}.{of_other}_dot*1 s/{per})"
    argument = rng.choice(
        [
            rate,
            rate,
            f"({other}.{of_other}/1 {per})",
            f"({other}.{of_other}/1 {per} - {rng.uniform(-0.3, 0.3):.3f})",
            f"(time/1 s - {rng.uniform(0.05, 0.9):.3f})",
        ]
    )
    much = f"{rng.uniform(-1, 1):.3f} {unit}"
    bent = rng.choice(
        [
            f"abs({argument})*{much}",
            f"-{argument}*abs({argument})*0.3 {unit}",
            f"max(0, {argument})*{much}",
            f"min(0.1, max(-0.1, {argument}))*{much}",
            f"sign({argument})*{much}",
            f"sign({argument})*{argument}*{much}",
        ]
    )
    return {"type": kind, "joint": name, "value": bent}


def _four_bar(rng: random.Random) -> Document:
    """Ground 1 m, crank, coupler and rocker of random lengths, turned anyhow in space; symmetric
    ones, whose values are equal or zero but for rounding, among them."""
    crank = rng.uniform(0.3, 0.5)
    rocker = crank if rng.random() < 0.3 else rng.uniform(0.6, 0.9)
    start = rng.uniform(0.6, 1.4)
    a, d = np.zeros(3), np.array([1.0, 0.0, 0.0])
    b = crank * np.array([np.cos(start), np.sin(start), 0.0])
    other = np.pi - start if rocker == crank else rng.uniform(1.0, 1.8)
    c = d + rocker * np.array([np.cos(other), np.sin(other), 0.0])
    frame = _turned(rng)
    axis = _vector(frame @ [0.0, 0.0, 1.0])

    def part(mass: float, p: Any, q: Any) -> dict[str, Any]:
        inertia = {name: number(0.02 * mass) for name in ("xx", "yy", "zz")}
        return {
            "mass": number(mass),
            "center_of_mass": _vector(frame @ (p + q) / 2),
            "inertia": inertia,
        }

    def joint(kind: str, links: list[str], at: Any) -> dict[str, Any]:
        found: dict[str, Any] = {"type": kind, "links": links, "point": _vector(frame @ at)}
        return found if kind == "S" else found | {"axis": axis}

    return {
        "format": "1",
        "name": "planar four-bar, turned",
        "links": {"L1": part(1.0, a, b), "L2": part(2.0, b, c), "L3": part(1.0, c, d)},
        "joints": {
            "J1": joint("R", ["ground", "L1"], a),
            "J2": joint("S", ["L1", "L2"], b),
            "J3": joint("C", ["L2", "L3"], c),
            "J4": joint("R", ["ground", "L3"], d),
        },
        "loads": [{"type": "gravity", "g": _vector(frame @ [0.0, -9.81, 0.0])}],
        "responses": {
            "run": {
                "start": {"J1.theta": "0"},
                "time": {"from": "0", "to": "1", "count": str(rng.choice([3, 6, 11, 31]))},
            }
        },
    }


def _turned(rng: random.Random) -> Any:
    q = np.array([rng.gauss(0, 1) for _ in range(4)])
    w, x, y, z = q / np.sqrt(q @ q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _vector(v: Any) -> list[str]:
    return [repr(float(x)) for x in v]
