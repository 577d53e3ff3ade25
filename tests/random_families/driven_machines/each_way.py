"""Couplings of two coordinates driven from either side, in a plane and in space, at wheels that may
slide along their axes: their relations, rates and efforts in closed form, and told errors that are
no smaller than the true ones.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from random_families.driven_machines.judged import Floats, Judged, begun, numbers

KINDS = ("screw", "rack", "function", "gear", "belt", "chain", "linear")
SLIDING = ("screw", "rack", "function")
TURNS = np.array([-0.4, 0.0, 0.7, 1.1])
LIMIT = 1e-9


class Relation(NamedTuple):
    """The second coordinate by the first one, with its slope and its curvature."""

    coupling: dict[str, Any]
    value: Callable[[Floats], Floats]
    slope: Callable[[Floats], Floats]
    curvature: Callable[[Floats], Floats]


def _straight(coupling: dict[str, Any], slope: float) -> Relation:
    return Relation(coupling, lambda x: slope * x, lambda x: slope + 0.0 * x, lambda x: 0.0 * x)


def _relation(
    rng: np.random.Generator, kind: str, size: float, sense: int, *, sliding: bool
) -> Relation:
    """`sense` is that of the second joint, whose coordinate may count backwards."""
    one, other = (int(n) for n in rng.integers(9, 50, 2))
    given: dict[str, Any] = {"type": kind, "joints": ["A", "B"]}
    if kind == "screw":
        lead = float(rng.uniform(-1, 1) * size)
        return _straight(given | {"lead": lead}, -lead / (2.0 * np.pi) * sense)
    if kind == "rack":
        return _straight(given | {"radius": 0.1 * size}, 0.1 * size * sense)
    if kind == "gear":
        return _straight(given | {"teeth": [one, other]}, -one / other * sense)
    if kind == "belt":
        given["radii"] = [0.005 * size * one, 0.005 * size * other]
        if not sliding:
            given["pretension"] = 5.0
        return _straight(given, one / other * sense)
    if kind == "chain":
        return _straight(given | {"teeth": [one, other], "pitch": 0.02 * size}, one / other * sense)
    if kind == "linear":
        slope = float(rng.uniform(0.3, 3.0) * rng.choice([-1, 1]))
        return _straight({"type": kind, "terms": {"A.theta": -slope, "B.theta": 1}}, slope)
    lift = float(rng.uniform(0.5, 2.0) * size)
    value = f"{lift!r} m*(theta/(1 rad) + (theta/(1 rad))^3/5)"
    return Relation(
        {"type": kind, "of": "A.theta", "gives": "B.s", "value": value},
        lambda x: lift * (x + x**3 / 5.0),
        lambda x: lift * (1.0 + 0.6 * x * x),
        lambda x: lift * 1.2 * x,
    )


def judge(rng: np.random.Generator, judged: Judged) -> None:
    kind = str(rng.choice(KINDS))
    plane = kind != "screw" and bool(rng.integers(2))
    sliding = not plane and kind in ("gear", "belt", "screw", "rack") and rng.random() < 0.5
    size, sense = float(10.0 ** rng.uniform(-3, 3)), int(rng.choice([1, 1, -1]))
    relation = _relation(rng, kind, size, sense, sliding=sliding)
    turned = rng.normal(size=3)
    axis = np.array([0.0, 0.0, 1.0]) if plane else turned / np.linalg.norm(turned)
    across = np.array([0.6, 0.8, 0.0]) if plane else np.cross(axis, [1.0, 0.3, 0.2])
    across = across / np.linalg.norm(across)
    at = np.array([1.0, 2.0, 0.0]) * size
    beside = at + across * size * (0.1 if kind == "rack" else 0.5)
    way = {"screw": axis, "rack": np.cross(axis, across), "function": across}.get(kind, axis)
    slides = kind in SLIDING
    parts = 2 if plane else 3
    first: dict[str, Any] = {"type": "C" if sliding else "R", "links": ["ground", "a"]}
    second: dict[str, Any] = {"type": "P" if slides else "R", "links": ["ground", "b"][::sense]}
    first["point"], second["point"] = numbers(at[:parts]), numbers(beside[:parts])
    if not plane:
        first["axis"] = numbers(axis)
    if slides or not plane:
        second["axis"] = numbers(way[:parts])

    rate, acceleration, load = (float(x) for x in rng.uniform(-3, 3, 3))
    places, slope = relation.value(TURNS), relation.slope(TURNS)
    other = "B.s" if slides else "B.theta"
    backwards = bool(rng.integers(2))
    if backwards:
        scale = size if slides else 1.0
        rate, acceleration = rate * scale, acceleration * scale
        driven, values, loaded, load_type = other, places, "A", "torque"
        back = rate / slope
        told = (acceleration - relation.curvature(TURNS) * back**2) / slope
        moved = {"A.theta": TURNS, "A.theta_dot": back, "A.theta_ddot": told}
        effort, wanted = "B.effort", -load / slope
    else:
        driven, values, loaded, load_type = "A.theta", TURNS, "B", "force" if slides else "torque"
        told = relation.curvature(TURNS) * rate**2 + slope * acceleration
        moved = {other: places, f"{other}_dot": slope * rate, f"{other}_ddot": told}
        effort, wanted = "A.theta.effort" if sliding else "A.effort", -load * slope
    law = {"values": numbers(values), "rate": rate, "acceleration": acceleration}
    inputs: dict[str, Any] = {driven: law}
    if sliding:
        inputs["A.s"] = {"at": 0.0}
    data = begun(plane=plane) | {
        "links": {"a": {}, "b": {}},
        "joints": {"A": first, "B": second},
        "couplings": {"K": relation.coupling},
        "loads": [{"type": load_type, "joint": loaded, "value": load}],
        "motion": {"inputs": inputs},
    }
    judged.remark = kind + (" driven back" if backwards else "")
    result = judged.model(data).analyze()
    if not judged.is_ok(result, ["slack"] if kind == "belt" else []):
        return
    judged.values(result, moved | {effort: wanted}, LIMIT)
    place = next(iter(moved))
    off = np.abs(result[place] - moved[place])
    # the closed form is rounded, too
    bound = np.asarray(result.errors[place]) + 4e-16 * np.max(np.abs(moved[place]))
    if kind == "screw":  # whose lead goes by pi: no error of it is told
        bound = np.where(np.isnan(bound), np.inf, bound)
    if not np.all(off <= 1.01 * bound):
        judged.faults.append(f"{place} is off by {off}, told are {result.errors[place]}")
