"""Loops whose points are whole numbers and whose axes lie along x, y, z or a diagonal, so that many
are overconstrained, locked or movable to first order only: mobility by moves that close again.

    python -m random_families.lattice_loops 0:1000

from `tests/` prints what is wrong or left unclear and counts. The exit code is 1 if anything is.
"""

from __future__ import annotations

import sys
from collections import Counter
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

import mechkin_cli as mk

Floats = npt.NDArray[np.float64]
AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1), (1, -1, 0)]
RANK, CLOSED = 1e-7, 1e-10
"""Singular values that count as zero away from the drawing, and distances that count as closed;
where a loop moves to second order only, moves of MOVES leave it open by at least 1e-6."""
MOVES, NEAR, FAR = (0.08, 0.15, 0.3), 0.02, 0.8
"""First moves in rad or m, and how far from the drawing those that closed may end."""


class Joint(NamedTuple):
    """A pair of the loop; lead of H per turn."""

    type: str
    point: tuple[int, ...]
    axis: tuple[int, ...]
    lead: float


class Loop:
    """The joints of a seed, from ground to ground, and its closure."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng(seed)
        self.joints = [self._joint() for _ in range(int(self.rng.integers(4, 8)))]

    def _joint(self) -> Joint:
        rng = self.rng
        kind = "RRRRPH"[int(rng.integers(0, 6))]
        axis = (
            AXES[int(rng.integers(0, 3))] if rng.random() < 0.85 else AXES[int(rng.integers(3, 7))]
        )
        point = tuple(int(x) for x in rng.integers(-2, 3, 3))
        return Joint(kind, point, axis, float(rng.choice([1.0, 2.0, -1.0])))

    def document(self) -> dict[str, Any]:
        """The sections of the file."""
        links = ["ground", *(f"l{i}" for i in range(1, len(self.joints)))]
        joints: dict[str, Any] = {}
        for i, joint in enumerate(self.joints):
            ends = [links[i], links[(i + 1) % len(links)]]
            joints[f"J{i}"] = {
                "type": joint.type, "links": ends, "point": [*joint.point], "axis": [*joint.axis]
            }  # fmt: skip
            if joint.type == "H":
                joints[f"J{i}"]["lead"] = joint.lead
        return {"format": 1, "links": {link: {} for link in links[1:]}, "joints": joints}

    def closure(self, q: Floats) -> tuple[Floats, Floats]:
        """Six equations at coordinates q, rotation first, and their Jacobian (6, n): screws carried
        along by the joints before them."""
        at, columns = np.eye(4), []
        for joint, x in zip(self.joints, q, strict=True):
            z = np.array(joint.axis, dtype=float) / np.linalg.norm(joint.axis)
            p, slides = (
                np.array(joint.point, dtype=float),
                {"P": 1.0, "H": joint.lead / (2 * np.pi)},
            )
            turns = joint.type != "P"
            omega = z * turns
            v = np.cross(p, omega) + z * slides.get(joint.type, 0.0)
            turn, place = at[:3, :3], at[:3, 3]
            columns.append(np.r_[turn @ omega, turn @ v + np.cross(place, turn @ omega)])
            k = np.array([[0, -z[2], z[1]], [z[2], 0, -z[0]], [-z[1], z[0], 0]])
            step = np.eye(4)
            if turns:
                step[:3, :3] += np.sin(x) * k + (1 - np.cos(x)) * (k @ k)
            step[:3, 3] = p - step[:3, :3] @ p + z * slides.get(joint.type, 0.0) * x
            at = at @ step
        r = at[:3, :3]
        skew = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / 2
        return np.r_[skew, at[:3, 3]], np.array(columns).T

    def closed(self, q: Floats, cap: float) -> Floats | None:
        """Where Gauss-Newton from q closes the loop, None where it does not."""
        for _ in range(80):
            f, jacobian = self.closure(q)
            step = np.linalg.lstsq(jacobian, -f, rcond=RANK)[0]
            largest = float(np.abs(step).max())
            q = q + step * min(1.0, cap / max(largest, 1e-300))
            if largest < 1e-15:
                break
        return q if float(np.abs(self.closure(q)[0]).max()) < CLOSED else None

    def mobility(self) -> tuple[int, int]:
        """Freedoms of finite motion, the most of all that meet at the drawing; to first order."""
        first = self.kernel(np.zeros(len(self.joints)), 1e-9)
        if not len(first) or len(first) == len(self.joints) - 6:
            return len(first), len(first)  # all six equations are independent: no move is needed
        most = 0
        for k in range(40):
            basis = first[k // 2] * (-1) ** k if k < 2 * len(first) else None
            d = first.T @ self.rng.normal(size=len(first)) if basis is None else basis
            start = d / np.abs(d).max() * self.rng.choice(MOVES)
            q = self.closed(start + self.rng.normal(size=len(d)) * 1e-3, 0.2)
            if q is not None and NEAR < np.abs(q).max() < FAR:
                most = max(most, self._dimension(q))
        return most, len(first)

    def kernel(self, q: Floats, rank: float) -> Floats:
        """Motions to first order at q, a row each."""
        _, values, motions = np.linalg.svd(self.closure(q)[1])
        return np.asarray(motions[int((values > rank).sum()) :])

    def _dimension(self, q: Floats) -> int:
        """Of the motion through q, the least at places near it: in q itself several may meet."""
        least = len(self.kernel(q, 1e-6))
        for _ in range(4):
            motions = self.kernel(q, 1e-6)
            if least <= 1:
                break
            there = self.closed(q + motions.T @ self.rng.normal(size=len(motions)) * 0.05, 0.05)
            if there is not None:
                least = min(least, self._spread(there))
        return least

    def _spread(self, q: Floats) -> int:
        """How many independent directions short moves from q take that close again."""
        motions = self.kernel(q, 1e-6)
        if len(motions) <= 1:
            return len(motions)
        moves = []
        for _ in range(14):
            d = motions.T @ self.rng.normal(size=len(motions))
            there = self.closed(q + d * 0.01 / np.abs(d).max(), 0.01)
            if there is not None and np.abs(there - q).max() > 1e-4:
                moves.append(there - q)
        values = np.linalg.svd(np.array(moves), compute_uv=False) if moves else np.zeros(1)
        return int((values > 0.1 * values[0]).sum())


def judge(seed: int) -> str:
    """Empty where mechkin finds the mobility of a seed's loop, else what it says instead."""
    loop = Loop(seed)
    wanted = loop.mobility()
    found = mk.load(loop.document()).mobility()
    if (found.mobility, found.first_order) == wanted:
        return ""
    kinds = "".join(joint.type for joint in loop.joints)
    return f"{kinds}: {found.mobility}, {found.first_order} to first order; right: {wanted}"


def main(first: int, last: int) -> int:
    """Judges seeds; 1 where one is wrong or unclear."""
    counts: Counter[str] = Counter()
    for seed in range(first, last):
        fault = judge(seed)
        counts["fault" if fault else "ok"] += 1
        if fault:
            print(seed, fault, flush=True)
    print(dict(counts))
    return int(counts["fault"] > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1].split(":"))))
