"""Changes of a file that leave its mobility as it is."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import numpy as np

from classics.drawing import GROUND, rotation

Document = dict[str, Any]
VECTORS = ("axis", "axis2", "normal", "x", "groove")


def _mapped(document: Document, point: Callable, direction: Callable, scale: float) -> Document:
    joints = {}
    for name, joint in document["joints"].items():
        joints[name] = dict(joint)
        for key, value in joint.items():
            if key == "point":
                joints[name][key] = [float(c) for c in point(np.array(value, dtype=float))]
            elif key in VECTORS:
                joints[name][key] = [float(c) for c in direction(np.array(value, dtype=float))]
            elif key == "lead":
                joints[name][key] = scale * float(value)
    return document | {"joints": joints}


def turned(document: Document, random: Random) -> Document:
    """Anywhere in space."""
    turn = rotation([random.uniform(-1, 1) for _ in range(3)], random.uniform(0, 3))
    shift = np.array([random.uniform(-3, 3) for _ in range(3)])
    return _mapped(document, lambda p: turn @ p + shift, lambda v: turn @ v, 1.0)


def scaled(document: Document, random: Random) -> Document:
    """In another unit, a thousand times larger or smaller."""
    factor = 10.0 ** random.uniform(-3, 3)
    larger = _mapped(document, lambda p: factor * p, lambda v: v, factor)
    return larger | {"units": {"length": random.choice(["mm", "in", "m"])}}


def reordered(document: Document, random: Random) -> Document:
    """Joints and links in another order, some joints the other way round."""
    joints, links = list(document["joints"].items()), list(document["links"].items())
    random.shuffle(joints)
    random.shuffle(links)
    joints = [
        (name, joint | {"links": joint["links"][:: random.choice([1, -1])]})
        if "axis2" not in joint
        else (name, joint)
        for name, joint in joints
    ]
    return document | {"joints": dict(joints), "links": dict(links)}


def renamed(document: Document, random: Random) -> Document:
    """Other names."""
    names = {link: f"q{random.randrange(10**9)}" for link in document["links"]}
    return _relinked(document, names | {GROUND: GROUND})


def grounded(document: Document, random: Random) -> Document:
    """Another link held."""
    held = random.choice(sorted(document["links"]))
    return _relinked(document, {n: n for n in document["links"]} | {held: GROUND, GROUND: held})


def _relinked(document: Document, names: dict[str, str]) -> Document:
    joints = {
        f"K{k}": joint | {"links": [names[link] for link in joint["links"]]}
        for k, joint in enumerate(document["joints"].values())
    }
    links = sorted(set(names.values()) - {GROUND})
    return document | {"joints": joints, "links": {link: {} for link in links}}


def braced(document: Document, random: Random) -> Document:
    """With a leg that needs nothing: S-P-S between two links; it spins, one freedom more."""
    one, two = random.sample([*document["links"], GROUND], 2)
    foot = np.array([random.uniform(-1, 1) for _ in range(3)])
    head = foot + np.array([random.uniform(0.5, 1.5) for _ in range(3)])
    joints = {
        "brace1": {"type": "S", "links": [one, "tube"], "point": foot.tolist()},
        "brace2": {
            "type": "P", "links": ["tube", "rod"], "point": head.tolist(),
            "axis": (head - foot).tolist(),
        },
        "brace3": {"type": "S", "links": ["rod", two], "point": head.tolist()},
    }  # fmt: skip
    links = document["links"] | {"tube": {}, "rod": {}}
    return document | {"joints": document["joints"] | joints, "links": links}


CHANGES = [turned, scaled, reordered, renamed, grounded, braced]
