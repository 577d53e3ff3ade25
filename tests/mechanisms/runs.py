"""Runs of the mechanism files, as they stand or with another motion or assembly."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
from oracle import document, to_text
from references import FILE_OF, SWEPT

import mechkin_cli as mk
from mechkin_cli.mechanism import is_told

_PART = "rcsr_csr_loop_one"
_STEMS = [path.stem for path in SWEPT]
LECTURES = [stem for stem in _STEMS if stem.startswith("lecture_")]
"""Single positions without masses or loads."""
NAMES = [stem for stem in _STEMS if stem not in (*LECTURES, _PART)]
"""All others with a sweep but the one that follows a part of its mechanism only (test_print)."""

_RATES = ("_dot", "_ddot")
_MOTION = ("theta", "s", "theta1", "theta2", "omega", "alpha", "effort")
_POINTS = ("position", "velocity", "acceleration", "point", "slip", "axis")


@cache
def model(name: str) -> mk.Model:
    return mk.load(FILE_OF[name])


@cache
def run(name: str, closed_at: tuple[str, ...] | None = None) -> mk.Analysis:
    """All quantities of a file over its rows."""
    quantities = [q for q in model(name).quantities if not q.startswith("row.")]
    return model(name).analyze(quantities, tables=[], closed_at=closed_at)


def edited(name: str, quantities: Iterable[str], **sections: Any) -> mk.Analysis:
    """Quantities of a file with sections replaced, such as `assembly={"near": {...}}`."""
    data = document(FILE_OF[name]) | _as_text(sections)
    return mk.loads(to_text(data), name).analyze(quantities, tables=[])


def _as_text(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _as_text(each) for key, each in value.items()}
    return [_as_text(each) for each in value] if isinstance(value, list) else str(value)


def motions(name: str) -> dict[str, list[str]]:
    """Quantities that do not depend on how loops are closed, even overconstrained ones: by family,
    what is compared with the family's largest value."""
    families: dict[str, list[str]] = {}
    for quantity in model(name).quantities:
        last = quantity.rpartition(".")[2]
        stem = next((last.removesuffix(r) for r in _RATES if last.endswith(r)), last)
        if stem in (*_MOTION, *_POINTS):
            families.setdefault(last, []).append(quantity)
    return families


def closings(name: str) -> list[tuple[str, ...]]:
    """Every choice of joints whose cut leaves a tree, driven, coupled and helical joints kept.

    None where legs close the loops: there is no choice.
    """
    closed = model(name).graph.closings
    if any(closing.links for closing in closed):
        return []
    mechanism = model(name).problem.mechanism
    kept = {joint for joint, _ in model(name).graph.driven}
    kept |= {term.joint.name for closing in closed for term in closing.terms}
    # those of a cable's stretches have no name that a file can write
    told = {n: j for n, j in mechanism.joints.items() if is_told(n)}
    able = [n for n, j in told.items() if n not in kept and j.letter != "H"]
    loops = sum(not closing.terms for closing in closed)
    ends = {n: (j.first, j.second) for n, j in mechanism.joints.items()}
    return [
        cut
        for cut in combinations(able, loops)
        if cut and _is_tree([pair for n, pair in ends.items() if n not in cut])
    ]


def _is_tree(edges: list[tuple[str, str]]) -> bool:
    """Whether no edge joins two links that are joined already."""
    groups: dict[str, set[str]] = {}
    for one, two in edges:
        first, second = groups.get(one, {one}), groups.get(two, {two})
        if first is second or two in first:
            return False
        merged = first | second
        groups.update(dict.fromkeys(merged, merged))
    return True


def worst(values: np.ndarray, expected: np.ndarray) -> float:
    """The largest error in parts of the largest expected value."""
    return float(np.max(np.abs(values - expected)) / np.max(np.abs(expected)))


def worst_angle(values: np.ndarray, expected: np.ndarray) -> float:
    """As `worst`, for angles in degrees that may differ by whole turns."""
    turns = np.round((values - expected) / 360.0)
    return worst(values - 360.0 * turns, expected)
