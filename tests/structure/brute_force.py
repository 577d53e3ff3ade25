"""The smallest blocks over all spanning trees and all orders, by trying every one of them.

A reference for small mechanisms. Of a closing joint's equations as many count as the screws of its
loop (as drawn; numpy's rank) leave; a block holds as many unknowns at most. A loop on a moving link
comes not before what moves it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations

import numpy as np

from mechkin_cli.mechanism.model import Joint, Mechanism

Freedom = tuple[str, int]


def least_blocks(mechanism: Mechanism, inputs: Iterable[tuple[str, str]]) -> list[int] | None:
    """Unknowns of the blocks, sorted, with least largest block, then least sum of cubes."""
    joints = mechanism.joints
    driven = {(name, joints[name].type.freedom_of[c]) for name, c in inputs}
    fixed = {name for name, _ in driven} | {n for n, j in joints.items() if j.letter == "H"}
    able = [name for name in joints if name not in fixed]
    best: list[int] | None = None
    for closing in combinations(able, mechanism.loops):
        ways = _ways(mechanism, set(closing))
        if ways is None:
            continue
        sizes = _blocks(joints, closing, ways, driven)
        if sizes is not None and (best is None or _cost(sizes) < _cost(best)):
            best = sizes
    return best


def _cost(sizes: list[int]) -> tuple[int, int]:
    return max(sizes, default=0), sum(n**3 for n in sizes)


def _ways(mechanism: Mechanism, closing: set[str]) -> dict[str, tuple[str, ...]] | None:
    """Joints from ground to each link; None if no tree is left."""
    ways: dict[str, tuple[str, ...]] = {"ground": ()}
    left = {name: j for name, j in mechanism.joints.items() if name not in closing}
    while True:
        step = next(
            (n for n, j in left.items() if (j.first in ways) != (j.second in ways)),
            None,
        )
        if step is None:
            return None if left else ways
        joint = left.pop(step)
        here, there = joint.first, joint.second
        if there in ways:
            here, there = there, here
        ways[there] = (*ways[here], step)


def _blocks(
    joints: dict[str, Joint],
    closing: tuple[str, ...],
    ways: dict[str, tuple[str, ...]],
    driven: set[Freedom],
) -> list[int] | None:
    loops, carrying, counts = {}, {}, {}
    for name in closing:
        one, other = set(ways[joints[name].first]), set(ways[joints[name].second])
        loops[name] = set(_freedoms(joints, one ^ other))
        carrying[name] = set(_freedoms(joints, one | other))
        rank = _rank([joints[n] for n in (one ^ other) | {name}])
        counts[name] = min(joints[name].type.equations, rank - joints[name].type.freedoms)
    solved, left, sizes = set(driven), set(closing), []
    while left:
        for group in _groups(left):
            unknowns = set().union(*(loops[n] for n in group)) - solved
            carried = set().union(*(carrying[n] for n in group)) - solved
            later = set().union(*(loops[n] for n in left - set(group))) - unknowns
            if carried & later or not 0 < len(unknowns) <= sum(counts[n] for n in group):
                continue
            solved |= unknowns
            left -= set(group)
            sizes.append(len(unknowns))
            break
        else:
            return None
    everything = set(_freedoms(joints, set(joints) - set(closing)))
    return sorted(sizes) if everything <= solved else None


def _groups(left: set[str]) -> Iterator[tuple[str, ...]]:
    for size in range(1, len(left) + 1):
        yield from combinations(sorted(left), size)


def _freedoms(joints: dict[str, Joint], names: Iterable[str]) -> Iterator[Freedom]:
    for name in names:
        for f in range(joints[name].type.freedoms):
            yield name, f


def _rank(loop: list[Joint]) -> int:
    rows = []
    for joint in loop:
        for part in joint.parts:
            z, o = np.array(part.before.z), np.array(part.before.o)
            axes = [z] if part.letter in "RCH" else []
            if part.letter == "S":
                axes = [np.array(part.before.x), np.array(part.before.y), z]
            pitch = joint.lead / (2 * np.pi) if part.letter == "H" else 0.0
            rows += [np.r_[axis, np.cross(o, axis) + pitch * axis] for axis in axes]
            if part.letter in "PC":
                rows.append(np.r_[np.zeros(3), z])
    return int(np.linalg.matrix_rank(np.array(rows), tol=1e-6))
