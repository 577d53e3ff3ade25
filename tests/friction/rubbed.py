"""Random mechanisms with random friction, and what is compared with the oracle."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
from oracle import document, mp, read, to_text
from oracle.friction import Rubbed, rub, rubbings, without_friction
from properties.cases import case

import mechkin_cli as mk
from mechkin_cli.verdict import Status

KEYS = {
    "R": ("radius", "length?", "collar?"),
    "P": ("length?", "width?", "across?"),
    "C": ("radius", "length?"),
    "H": ("radius", "flank?"),
    "S": ("radius",),
    "Sp": (),
    "Sg": (),
}
"""What friction of a joint may be given; without a mark it must be."""


def with_friction(text: str, seed: int) -> dict[str, Any]:
    """The document with friction at every joint that can have it."""
    rng, data = random.Random(seed), document(text)
    for name, joint in data["joints"].items():
        if joint["type"] in KEYS:
            data["loads"].append(_load(rng, name, joint["type"]))
    return data


def _load(rng: random.Random, name: str, kind: str) -> dict[str, Any]:
    load: dict[str, Any] = {"type": "friction", "joint": name, "coefficient": _coefficient(rng)}
    for key in KEYS[kind]:
        if key.endswith("?") and rng.random() < 0.4:
            continue
        key = key.rstrip("?")
        if key == "across":
            if "width" in load:
                load[key] = [f"{rng.uniform(-1, 1):.3f}" for _ in range(3)]
        elif key == "flank":
            load[key] = f"{rng.uniform(0, 30):.3f} deg"
        else:
            size = {"radius": 0.04, "collar": 0.05, "length": 0.5, "width": 0.3}[key]
            load[key] = f"{size * rng.uniform(0.5, 1.5):.4f}"
    return load


def _coefficient(rng: random.Random) -> Any:
    sliding = rng.uniform(0.02, 0.12)
    if rng.random() < 0.5:
        return f"{sliding:.4f}"
    speed = f"{rng.uniform(0.001, 0.1):.4f}"
    return {"static": f"{1.5 * sliding:.4f}", "sliding": f"{sliding:.4f}", "speed": speed}


def expected(name: str, data: dict[str, Any]) -> Rubbed:
    """The oracle's answer for a case's row."""
    its = case(name)
    mechanism = read(to_text(without_friction(data)))
    return rub(mechanism, its.solution, rubbings(data))


def differences(name: str, data: dict[str, Any]) -> dict[str, float]:
    """Errors by kind of quantity, in parts of the largest force; none of an undecided row."""
    its, wanted = case(name), expected(name, data)
    joints = its.mechanism.joints
    columns = {f"{j}.force": v for j, v in wanted.reactions.force.items()}
    columns |= {
        f"{j}.moment": v for j, v in wanted.reactions.moment.items() if joints[j].type != "W"
    }
    columns |= {f"{c}.effort": [v] for c, v in wanted.reactions.effort.items()}
    for rubbed, word in (
        (wanted.force, "friction_force"),
        (wanted.moment, "friction_moment"),
        (wanted.normal, "normal_load"),
        (wanted.power, "friction_power"),
    ):
        columns |= {f"{j}.{word}": v if isinstance(v, list) else [v] for j, v in rubbed.items()}
    analysis = mk.loads(to_text(data)).analyze(list(columns), tables=[])
    if analysis.result.status[its.row] == Status.friction_undecided:
        return {}
    scale = float(max(mp.norm(v) for v in wanted.reactions.force.values()))
    found: dict[str, float] = {}
    for column, value in columns.items():
        got = np.ravel(analysis[column][its.row]).astype(float)
        error = float(np.max(np.abs(got - np.array(value, dtype=object).astype(float)))) / scale
        word = column.rpartition(".")[2]
        known = found.setdefault(word, 0.0)
        found[word] = known if error <= known else error  # a nan wins
    return found
