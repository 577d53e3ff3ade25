"""Wheels anywhere in space: on parallel, meeting and crossed axes, in rings and at racks.

Right are the speeds with which the surfaces of both parts have one velocity along the normal of
their teeth at the pitch point, and the tooth force whose moment about the second axis bears the
load and which leans by the pressure angle from the teeth to the axis of the part it pushes.
Bearings, efforts and powers are balanced with it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Floats, Judged, begun, numbers

KINDS = ("helical", "bevel", "crossed", "ring", "rack")
X, Y, Z = np.eye(3)
RATE = 1.5
LIMIT = 1e-10


class Pair(NamedTuple):
    """Two parts that mesh, the first on an axis z through the origin.

    Attributes:
        normal: of the teeth, in the plane that touches both parts.
        push: way in which the second part is pushed off the first.
    """

    coupling: dict[str, Any]
    first: Floats
    second: Floats
    axis: Floats
    pitch: Floats
    normal: Floats
    push: Floats


def _parallel(rng: np.random.Generator, size: float, *, ring: bool) -> Pair:
    one, other = (int(n) for n in rng.integers(8, 70, 2))
    if ring and abs(one - other) < 4:
        other = one + 10
    helix = float(rng.uniform(-0.9, 0.9))
    reach = size * one / (one - other if ring else one + other)
    tooth = np.sin(helix) * np.sign(reach) * Y + np.cos(helix) * Z
    given = {"type": "gear", "joints": ["A", "B"], "teeth": [one, other], "helix": helix}
    if ring:
        given["internal"] = True
    second = size * X + rng.uniform(-1, 1) * size * Z
    push = -X if ring else X
    return Pair(given, 0.0 * X, second, Z, reach * X, np.cross(tooth, X), push)


def _crossed(rng: np.random.Generator, size: float) -> Pair | None:
    one, other = (int(n) for n in rng.integers(8, 70, 2))
    helix, shaft = rng.choice([-1, 1]) * rng.uniform(0.1, 0.9), rng.uniform(0.3, 1.4)
    shaft *= rng.choice([-1, 1])
    axis = np.cos(shaft) * Z + np.sin(shaft) * Y
    tooth = np.sin(helix) * Y + np.cos(helix) * Z
    along = tooth @ axis  # the cosine of the second wheel's helix
    if along < 0.2:
        return None
    far = size * other / one * np.cos(helix) / along
    given = {"type": "gear", "joints": ["A", "B"], "teeth": [one, other], "helix": float(helix)}
    given["radii"] = [size, float(far)]
    return Pair(given, 0.0 * X, (size + far) * X, axis, size * X, np.cross(tooth, X), X)


def _bevel(rng: np.random.Generator, size: float) -> Pair | None:
    one, other = (int(n) for n in rng.integers(8, 70, 2))
    shaft = rng.uniform(0.4, 2.6)
    axis = np.cos(shaft) * Z + np.sin(shaft) * X
    cone = np.arctan2(np.sin(shaft), other / one + np.cos(shaft))
    if not (0.05 < cone < 1.5 and 0.05 < shaft - cone < 1.5):
        return None
    length = size / np.sin(cone)
    line = np.cos(cone) * Z + np.sin(cone) * X
    second = length * np.cos(shaft - cone) * axis
    push = np.cross(Y, line)
    push *= np.sign(push @ (second - length * line))
    given = {"type": "gear", "joints": ["A", "B"], "teeth": [one, other]}
    given["radii"] = [size, size * other / one]
    return Pair(given, length * np.cos(cone) * Z, second, axis, length * line, Y, push)


def _rack(rng: np.random.Generator, size: float) -> Pair:
    given = {"type": "rack", "joints": ["A", "B"], "radius": size}
    second = size * X + rng.uniform(-1, 1) * size * Y
    return Pair(given, 0.0 * X, second, Y, size * X, Y, X)


def _pair(rng: np.random.Generator, kind: str, size: float) -> Pair:
    while True:
        pair = {
            "helical": lambda: _parallel(rng, size, ring=False),
            "ring": lambda: _parallel(rng, size, ring=True),
            "crossed": lambda: _crossed(rng, size),
            "bevel": lambda: _bevel(rng, size),
            "rack": lambda: _rack(rng, size),
        }[kind]()
        if pair is not None:
            return pair


def _turned(rng: np.random.Generator) -> Floats:
    """Any rotation."""
    turn, upper = np.linalg.qr(rng.normal(size=(3, 3)))
    turn = turn * np.sign(np.diag(upper))
    return turn * np.sign(np.linalg.det(turn))


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = judged.remark = str(rng.choice(KINDS))
    turn, size = _turned(rng), float(10.0 ** rng.uniform(-3, 3))
    pair, origin = _pair(rng, kind, size), size * rng.uniform(-1, 1, 3)
    pressure, load = float(rng.uniform(0.0, 0.5)), float(rng.uniform(-10, 10)) * size
    senses, order = rng.choice([-1, 1], 2), rng.choice([-1, 1])
    first, second, pitch = (origin + turn @ p for p in (pair.first, pair.second, pair.pitch))
    axis, other = senses[0] * turn @ Z, senses[1] * turn @ pair.axis
    slides = kind == "rack"
    data = begun(plane=False) | {
        "links": {"a": {}, "b": {}},
        "joints": {
            "A": {"type": "R", "links": ["ground", "a"], "point": numbers(first)},
            "B": {"links": ["ground", "b"][::order], "point": numbers(second)},
        },
        "couplings": {"K": pair.coupling | {"pressure_angle": pressure}},
        "loads": [{"type": "force" if slides else "torque", "joint": "B", "value": load}],
        "motion": {"inputs": {"A.theta": {"from": -7, "to": 20, "count": 4, "rate": RATE}}},
    }
    data["joints"]["A"]["axis"] = numbers(axis)
    data["joints"]["B"] |= {"type": "P" if slides else "R", "axis": numbers(other)}
    result = judged.model(data).analyze()
    if not judged.is_ok(result):
        return

    normal, push = turn @ pair.normal, turn @ pair.push
    # velocity of the second part at the pitch point by its rate
    moved = other if slides else np.cross(other, pitch - second)
    speed = RATE * np.cross(axis, pitch - first) @ normal / (moved @ normal) * order
    working = -load * order / (moved @ normal)
    tooth = working * normal + abs(working) * np.tan(pressure) * push
    largest = float(np.max(np.abs(tooth)))
    rate = "B.s_dot" if slides else "B.theta_dot"
    judged.compare(rate, result[rate], speed, abs(speed), LIMIT)
    borne = tooth - (tooth @ other) * other if slides else tooth
    lever = np.cross(pitch - first, tooth)
    across = lever - (lever @ axis) * axis
    moments = np.asarray(result["A.moment"])
    moments = moments - np.outer(moments @ axis, axis)
    for row in range(4):
        judged.compare("K.tooth_force", result["K.tooth_force"][row], tooth, largest, LIMIT)
        judged.compare("A.force", result["A.force"][row], tooth, largest, LIMIT)
        judged.compare("B.force", order * result["B.force"][row], -borne, largest, LIMIT)
        judged.compare("A.moment", moments[row], across, largest * size, LIMIT)
    judged.compare("A.effort", result["A.effort"], lever @ axis, largest * size, LIMIT)
    judged.compare("power", result["A.effort"] * RATE, -load * speed, abs(load * speed), LIMIT)
