"""The same loop written otherwise: documents that must have the same answers, but for a factor."""

from __future__ import annotations

import copy
import random
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from random_families.friction.loops import Loop

Data = dict[str, Any]
MILLIMETRE = 1e3
VECTORS = ("axis", "axis2", "normal", "groove", "across", "vector", "force", "g")
PLACES = ("point", "at", "center_of_mass")
LENGTHS = ("radius", "length", "collar", "width", "lead")


def turned(loop: Loop, rng: random.Random) -> Loop:
    """The drawing turned about the origin, gravity and all."""
    q = np.linalg.qr(np.array([[rng.gauss(0, 1) for _ in range(3)] for _ in range(3)]))[0]
    q = q * np.sign(np.linalg.det(q))

    def turn(key: str, value: Any) -> Any:
        if key in (*VECTORS, *PLACES) and isinstance(value, list):
            return (q @ np.array(value)).tolist()
        if key == "inertia":
            axes = {name: q[:, k].tolist() for k, name in enumerate("xy")}
            return value | {"axes": axes}
        return value

    return replace(loop, data=_mapped(loop.data, turn), force=tuple(q @ np.array(loop.force)))


def in_millimetres(loop: Loop, rng: random.Random) -> Loop:
    """Lengths in mm, forces in N, masses in kg."""

    def change(key: str, value: Any) -> Any:
        if key in PLACES and isinstance(value, list):
            return [MILLIMETRE * x for x in value]
        if key in LENGTHS:
            return value if isinstance(value, str | dict) else MILLIMETRE * value
        if key == "speed":
            return MILLIMETRE * value
        if key == "inertia":
            return {k: MILLIMETRE**2 * x for k, x in value.items()}
        if key == "g":
            return [MILLIMETRE * x for x in value]
        return value

    data = _mapped(loop.data, change) | {"units": {"length": "mm", "force": "N"}}
    for name, sweep in data["motion"]["inputs"].items():
        if name.endswith(".s") and "to" in sweep:
            sweep["to"] *= MILLIMETRE
    return replace(loop, data=data)


def reordered(loop: Loop, rng: random.Random) -> Loop:
    """Links, joints and loads in another order."""
    data = copy.deepcopy(loop.data)
    for section in ("links", "joints"):
        items = list(data[section].items())
        rng.shuffle(items)
        data[section] = dict(items)
    rng.shuffle(data["loads"])
    return replace(loop, data=data)


def doubled(loop: Loop, rng: random.Random) -> Loop:
    """Twice the masses and the forces: friction doubles, its coefficients stay."""

    def twice(key: str, value: Any) -> Any:
        if key == "mass":
            return 2.0 * value
        if key == "force" and isinstance(value, list):
            return [2.0 * x for x in value]
        if key == "inertia":
            return {k: 2.0 * x for k, x in value.items()}
        return value

    return replace(loop, data=_mapped(loop.data, twice))


def split(loop: Loop, rng: random.Random) -> Loop:
    """A link in two that are welded; what is fixed to it, and its mass, stay on the first."""
    data = copy.deepcopy(loop.data)
    link = rng.choice(loop.links[1:-1])
    name = max(n for n, joint in data["joints"].items() if link in joint["links"])
    joint = data["joints"][name]
    joint["links"] = ["other" if each == link else each for each in joint["links"]]
    data["links"]["other"] = {}
    data["joints"]["weld"] = {"type": "W", "links": [link, "other"]}
    return replace(loop, data=data)


def _mapped(value: Any, change: Callable[[str, Any], Any]) -> Any:
    """A document in which `change` has seen every entry by its key."""
    if not isinstance(value, dict):
        return [_mapped(each, change) for each in value] if isinstance(value, list) else value
    return {
        key: entry if entry is not own else _mapped(own, change)
        for key, own in value.items()
        for entry in (change(key, own),)
    }
