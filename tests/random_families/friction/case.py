"""One loop judged: every force of every row against the dense system, and what is undecided."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
from random_families.friction.dense import Array, Row, Rubbed
from random_families.friction.loops import Loop

import mechkin_cli as mk

LOST = {"beyond-dead-centre", "branch-lost", "rank-unclear", "not-assembled"}
WORST_CONDITION, WORST_SLIP = 1e8, 1e-9
"""Of dense systems, and slips (m/s), beyond which nothing is judged."""
CLOSE = 1e-9
"""Distance of a spectral radius from 1 in which rounding decides."""


@dataclass
class Judged:
    """Rows by status, and what is wrong in words."""

    counts: Counter[str] = field(default_factory=Counter)
    fault: str = ""


def text_of(data: dict[str, Any]) -> str:
    return json.dumps(data)


class Answers:
    """Quantities of a file, read once."""

    def __init__(self, data: dict[str, Any]) -> None:
        analysis = mk.loads(text_of(data)).analyze([], tables=[])
        self.read = cache(lambda name: np.asarray(analysis[name]))

    def at(self, row: int) -> Any:
        return lambda name: np.asarray(self.read(name)[row], dtype=float)

    @property
    def statuses(self) -> list[str]:
        return [str(status) for status in self.read("row.status")]


def rows(loop: Loop, answers: Answers) -> list[Row]:
    """Every row's free-body equations, by the size of the first row's assembly."""
    statuses, found = answers.statuses, []
    places = np.array([answers.at(0)(f"p{name}.position") for name in loop.types])
    size = float(np.linalg.norm(places.max(axis=0) - places.min(axis=0)))
    for row in range(len(statuses)):
        found.append(Row(loop, answers.at(row), size))
    return found


def judge(loop: Loop) -> Judged:
    """Everything that can be wrong with a loop, the first fault in words."""
    judged = Judged()
    try:
        answers = Answers(loop.data)
        for drive in loop.drives:
            answers.read(f"{drive}.effort")
    except mk.MechkinError as error:
        judged.counts["refused"] += 1
        judged.fault = "" if "loaded-spin" in str(error) else str(error).splitlines()[0]
        return judged
    if answers.statuses[0] in LOST:
        judged.counts["lost"] += 1
        return judged
    for number, (status, row) in enumerate(zip(answers.statuses, rows(loop, answers), strict=True)):
        if status in LOST or np.linalg.cond(row.matrix) > WORST_CONDITION:
            judged.counts["not judged"] += 1
            continue
        if any(is_slow(row, name) for name in loop.frictions):
            judged.counts["not judged"] += 1
            continue
        rubbed = row.friction()
        fault = _fault(status, row, rubbed)
        judged.counts[status] += 1
        if fault and not judged.fault:
            judged.fault = f"row {number + 1}: {fault}"
    return judged


def is_slow(row: Row, name: str) -> bool:
    """Whether a joint stands nearly still."""
    slide, turn, radius = row.slip(name)
    return bool(np.sqrt(slide @ slide + radius**2 * (turn @ turn)) < WORST_SLIP)


def _fault(status: str, row: Row, rubbed: Rubbed) -> str:
    if status == "friction-undecided":
        return f"undecided at {rubbed.radius}" if rubbed.radius < 1.0 - CLOSE else ""
    if rubbed.radius > 1.0 + CLOSE:
        return f"decided at {rubbed.radius}"
    if rubbed.others:
        return "there are other friction forces"
    if not rubbed.solved:
        return "no friction forces for comparison"
    return _wrong_force(row, rubbed)


def _wrong_force(row: Row, rubbed: Rubbed) -> str:
    read, loop = row.read, row.loop
    wrenches = row.wrenches(rubbed.unknowns)
    scale = max(1e-3, *(float(np.abs(part).max()) for pair in wrenches.values() for part in pair))
    condition = float(np.linalg.cond(row.matrix))
    limit = 1e-9 * scale * max(1.0, 1e-2 * condition) / max(1e-3, 1.0 - rubbed.radius)
    pairs: list[tuple[str, Array]] = []
    for name, (force, moment) in wrenches.items():
        pairs += [(f"{name}.force", force), (f"{name}.moment", moment)]
    for drive, effort in zip(loop.drives, rubbed.unknowns[row.constraints :], strict=True):
        pairs.append((f"{drive}.effort", effort))
    for name, z in rubbed.force.items():
        force, moment, speed = rubbed.drag[name]
        pairs += [(f"{name}.normal_load", z / rubbed.mu[name])] if rubbed.mu[name] else []
        pairs += [(f"{name}.friction_force", z * force), (f"{name}.friction_moment", z * moment)]
        pairs.append((f"{name}.friction_power", z * speed / max(1.0, speed)))
    for name, wanted in pairs:
        found = read(name)
        if name.endswith("power"):
            found = found / max(1.0, rubbed.drag[name.partition(".")[0]][2])
        if not np.abs(found - wanted).max() <= limit:
            return f"{name} {np.ravel(found).tolist()} is {np.ravel(wanted).tolist()}"
    error = float(read("row.power_error"))
    return f"power error {error}" if error > 1e-9 * max(1.0, 1e-2 * condition) else ""
