"""The verdict on one random linkage in a plane: equal to the same in space, and to an oracle.

Differences are told in parts of the largest value of their kind and of the worst condition of the
rows; that of accelerations and forces grows with the condition of every group before.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from planar.maximal import Maximal
from planar.space import in_space
from random_families.planar.linkages import Linkage

import mechkin_cli as mk

COORDINATES = {"R": ("theta",), "P": ("s",), "Ps": ("s",), "W": ()}
NEAR = {"position": 1e-13, "rate": 1e-13, "acceleration": 1e-12, "force": 1e-12}
"""In parts of the condition: some hundred roundings each, positions over the reach of loops."""
ORACLE = 10
"""Every so many-th linkage is computed at 50 digits, too."""

Named = tuple[str, str, np.ndarray[Any, Any]]


@dataclass(frozen=True)
class Outcome:
    """What one seed came to."""

    text: str
    fault: str = ""
    remark: str = ""
    figures: dict[str, float] = field(default_factory=dict)


def seen(data: dict[str, Any]) -> dict[str, Any]:
    """With the place of every link's drawing."""
    links = data["links"]
    points = {f"o{name}": {"link": name, "at": [0, 0]} for name in links}
    directions = {f"d{name}": {"link": name, "vector": [1, 0]} for name in links}
    return {**data, "points": {**data["points"], **points}, "directions": directions}


def run_one(seed: int) -> Outcome:
    data = seen(Linkage(seed).file())
    text = json.dumps(data, indent=1)
    flat = mk.loads(text).analyze()
    deep = mk.loads(json.dumps(in_space(data))).analyze()
    words = flat["row.status"]
    if (words != deep["row.status"]).any():
        return Outcome(text, f"{words} in the plane, {deep['row.status']} in space")
    solved = words == "ok"
    if not solved.any():
        return Outcome(text, remark="not solved")
    figures: dict[str, float] = {}
    condition = max(1.0, float(np.nanmax(flat["row.condition"][solved])))
    for (name, kind, one), (_, _, other) in zip(
        told(data, flat, "plane"), told(data, deep, "space"), strict=True
    ):
        one, other = one[solved], other[solved]
        if not np.isfinite(one).all():
            return Outcome(text, f"{name} is empty")
        if np.isfinite(other).all():  # redundant constraints of space may leave its cells empty
            add(figures, kind, one - other, sizes(data, flat, solved)[kind], condition)
    if seed % ORACLE == 0:
        against_oracle(data, text, flat, solved, figures, condition)
    wrong = [kind for kind, off in figures.items() if off > NEAR[kind]]
    fault = f"off in {', '.join(wrong)}" if wrong else ""
    return Outcome(text, fault, "with the oracle" if seed % ORACLE == 0 else "", figures)


def add(figures: dict[str, float], kind: str, off: Any, size: float, condition: float) -> None:
    worst = float(np.max(np.abs(off))) / size / condition
    figures[kind] = max(figures.get(kind, 0.0), worst)


def sizes(data: dict[str, Any], run: mk.Analysis, solved: Any) -> dict[str, float]:
    """The largest value of a kind, or one."""
    found = dict.fromkeys(NEAR, 1.0)
    for _, kind, values in told(data, run, "plane"):
        found[kind] = max(found[kind], float(np.max(np.abs(values[solved]), initial=0.0)))
    return found


def told(data: dict[str, Any], run: mk.Analysis, form: str) -> Iterator[Named]:
    """Coordinates with rates, points and reactions of a run, as both forms have them."""
    for name, joint in data["joints"].items():
        for coordinate in COORDINATES[joint["type"]]:
            for order, kind in (("", "position"), ("_dot", "rate"), ("_ddot", "acceleration")):
                quantity = f"{name}.{coordinate}{order}"
                yield quantity, kind, run[quantity]
        # of a block in the slot, the slotted link is the first
        sign = -1.0 if joint["type"] == "Ps" and form == "space" else 1.0
        for axis in "xy":
            yield f"{name}.force.{axis}", "force", sign * run[f"{name}.force.{axis}"]
        if joint["type"] == "P":
            moment = f"{name}.moment" if form == "plane" else f"{name}.moment.z"
            yield f"{name}.moment", "force", run[moment]
    for point in data["points"]:
        for word, kind in (("position", "position"), ("velocity", "rate")):
            for axis in "xy":
                yield f"{point}.{word}", kind, run[f"{point}.{word}.{axis}"]
    yield "J0.effort", "force", run["J0.effort"]


def against_oracle(
    data: dict[str, Any],
    text: str,
    run: mk.Analysis,
    solved: Any,
    figures: dict[str, float],
    condition: float,
) -> None:
    """The first and the last solved row at 50 digits."""
    oracle, size = Maximal(text), sizes(data, run, solved)
    rows = np.flatnonzero(solved)
    for row in {rows[0], rows[-1]}:
        start = []
        for link in oracle.links:
            start += [float(run[f"o{link}.position.{axis}"][row]) for axis in "xy"]
            start.append(float(run[f"atan2(d{link}.y, d{link}.x)"][row]))
        value = float(run[oracle.input][row])
        true = oracle.moving(start, value)
        for name, joint in data["joints"].items():
            for coordinate in COORDINATES[joint["type"]]:
                for order, (ending, kind) in enumerate(
                    (("", "position"), ("_dot", "rate"), ("_ddot", "acceleration"))
                ):
                    quantity = f"{name}.{coordinate}"
                    off = float(run[quantity + ending][row]) - true.coordinate(quantity, order)
                    if order == 0 and coordinate == "theta":
                        off = np.remainder(float(off) + np.pi, 2 * np.pi) - np.pi
                    add(figures, kind, float(off), size[kind], condition)
            *force, moment = true.reaction(name)
            for axis, component in zip("xy", force, strict=True):
                off = float(run[f"{name}.force.{axis}"][row] - component)
                add(figures, "force", off, size["force"], condition)
            if joint["type"] == "P":
                off = float(run[f"{name}.moment"][row] - moment)
                add(figures, "force", off, size["force"], condition)
        add(figures, "force", float(run["J0.effort"][row] - true.effort), size["force"], condition)
