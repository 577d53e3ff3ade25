"""Places that are marked on the axis of a run: dead centres, branch points, and what ended or
stopped a response."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.mechanism.joint_table import is_angle
from mechkin_cli.solver.inputs import input_text
from mechkin_cli.status import Status
from mechkin_cli.units import ANGLE

if TYPE_CHECKING:
    from mechkin_cli.arrays import Floats
    from mechkin_cli.diagnostics import Diagnostic, Number
    from mechkin_cli.view.encoding import Plain
    from mechkin_cli.view.readable import Readable

KINDS = {
    "dead-centre": "dead-centre",
    "branch-point": "branch-point",
    "branch-point-passed": "branch-point",
}
"""Kind of mark by the code of the message that tells of the place."""


def run_marks(analysis: Readable, label: str, x: Floats) -> list[Plain]:
    """The marks of a branch, in the order of its messages; `label` and `x` (rows,) are those of its
    axis."""
    found: list[Plain] = []
    for diagnostic in analysis.diagnostics:
        kind = KINDS.get(diagnostic.code)
        if kind is not None:
            for text, place in _places(analysis, diagnostic, label, x):
                found.append({"x": place, "kind": kind, "text": text})
    for row in np.flatnonzero(analysis.result.status == Status.dead_centre).tolist():
        found.append({"x": float(x[row]), "kind": "dead-centre", "text": "row at a dead centre"})
    for row, event in enumerate(analysis.result.events):
        if event:
            found.append({"x": float(x[row]), "kind": "event", "text": event})
    return [mark for at, mark in enumerate(found) if mark not in found[:at]]


def _places(
    analysis: Readable, diagnostic: Diagnostic, label: str, x: Floats
) -> Iterator[tuple[str, float]]:
    """What a message measured, place by place, with where on the axis that is."""
    for numbers in _by_place(diagnostic.numbers):
        places = {number.name: number.value for number in numbers}
        words = f"{diagnostic.code.replace('-', ' ')}: {', '.join(map(input_text, numbers))}"
        if label in places:
            yield words, places[label]
        else:
            for place in _crossed(analysis, places, x):
                yield words, place


def _by_place(numbers: tuple[Number, ...]) -> Iterator[tuple[Number, ...]]:
    """Numbers in a row, where those of one place have different names."""
    first = 0
    for at, number in enumerate(numbers):
        if any(number.name == other.name for other in numbers[first:at]):
            yield numbers[first:at]
            first = at
    if numbers:
        yield numbers[first:]


def _crossed(analysis: Readable, places: dict[str, float], x: Floats) -> Iterator[float]:
    """Where the first of some coordinates passes its place between two rows, read straight between
    them; at the last row with a solution where it never does."""
    name, value = next(iter(places.items()))
    solved = np.flatnonzero(analysis.result.solved)
    if not solved.size:
        return
    off = np.asarray(analysis[name], dtype=np.float64)[solved] - value
    near = np.ones(max(off.size - 1, 0), dtype=bool)
    if is_angle(name.rpartition(".")[2]):
        turn = float(analysis.result.units.from_si(2.0 * np.pi, ANGLE))
        off -= turn * np.round(off / turn)
        near = np.abs(np.diff(off)) < 0.5 * turn
    at = np.flatnonzero((off[:-1] * off[1:] <= 0.0) & near)
    for k in at:
        share = 0.0 if off[k] == off[k + 1] else off[k] / (off[k] - off[k + 1])
        yield float(x[solved[k]] + share * (x[solved[k + 1]] - x[solved[k]]))
    if not at.size:
        yield float(x[solved[-1]])
