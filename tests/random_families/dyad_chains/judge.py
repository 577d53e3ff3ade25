"""Rows of a chain of dyads, against its closed form."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from random_families.dyad_chains.case import Array, Chain, Long, turned
from random_families.dyad_chains.drawn import Sweep

import mechkin_cli as mk

HAVE = ("ok", "near-singular", "dead-centre", "rank-unclear")
UNDECIDED = 3.0
"""Parts of its rounding within which a discriminant may be zero."""
EXACT = 0.01
"""The same of a branch point; between the two rounding tells a gap from none."""
TURNED_BACK = 1e-12
"""How far beyond a dead centre, in parts of the input, rows turn back at it: half and twice of it
are left to either."""


class Judged(NamedTuple):
    """Rows by class, and words on those lost and wrong."""

    counts: Counter[str]
    lost: list[str]
    wrong: list[str]


class Reach:
    """What is known of a row from the way to it: `known` on the branch's signs, `undecided` where
    rounding decides whether it exists, and on which of two branches, `beyond` where none does."""

    def __init__(self, case: Sweep) -> None:
        self.case, self.at, self.verdict = case, case.start, "known"
        self.flipped: frozenset[int] = frozenset()

    @classmethod
    def rows(cls, case: Sweep, low: list[float]) -> dict[int, tuple[str, frozenset[int]]]:
        """Verdicts on all rows, and the dyads that may be on their other branch; rows are followed
        both ways from the one that is nearest to the start."""
        start = int(np.argmin(np.abs(np.array(case.values) - case.start)))
        found = {}
        for rows in (range(start, -1, -1), range(start, len(low))):
            reach = cls(case)
            for row in rows:
                found[row] = reach.go(case.values[row], low[row]), reach.flipped
        return found

    def go(self, value: float, low: float) -> str:
        """To the next row, whose least discriminant in parts of its rounding is given."""
        for place in self.case.places:
            over = (place.at - value) * place.inward
            if place.inward and over > 0:
                over /= TURNED_BACK * max(1.0, abs(place.at))
                if low < -UNDECIDED or over > 0.5:
                    self._ended(low > -UNDECIDED or over < 2)
            elif not place.inward and (self.at - place.at) * (value - place.at) <= 0:
                if abs(place.left) < UNDECIDED:
                    self.flipped |= {place.dyad}
                    self._ended(True)
                elif place.left < 0:
                    self._ended(False)
        if -UNDECIDED < low < -1:
            self._ended(True)
        self.at = value
        return "undecided" if self.verdict == "known" and abs(low) < 1 else self.verdict

    def _ended(self, perhaps: bool) -> None:
        if self.verdict != "beyond":
            self.verdict = "undecided" if perhaps else "beyond"


def judge(case: Sweep) -> Judged:
    names = [case.chain.name(k + 1) for k in range(len(case.chain.dyads))]
    analysis = mk.loads(case.text).analyze(names)
    status = analysis["row.status"].tolist()
    values = np.array([analysis[name] for name in names])
    at = np.array([Long(x) for x in case.values])
    left = case.chain.judged(at)[2].min(axis=0)
    left = np.where(np.isnan(left), -np.inf, left)
    off = parts_of(case.chain, at, values)
    behind = {
        place.dyad: case.chain.flipped(place.dyad).judged(at)[2].min(axis=0)
        for place in case.places
        if abs(place.left) < EXACT
    }
    known = Reach.rows(case, left.astype(float).tolist())
    counts, lost, wrong = Counter[str](), [], []
    for row, value in enumerate(case.values):
        low, (verdict, flipped) = float(left[row]), known[row]
        here = (
            f"row {row + 1} of {len(case.values)} {value!r} ({low:.3g}, {verdict}): {status[row]}"
        )
        if status[row] not in HAVE:
            word = {"known": "lost", "beyond": "refused"}.get(verdict, verdict)
            if case.straight and flipped <= set(behind) and flipped:
                far = min(behind[k][row] for k in flipped) > UNDECIDED
                word = "lost behind a branch point" if far else word
            counts[f"{word}: {status[row]}"] += 1
            if word == "lost":
                lost.append(here)
            continue
        others = [parts_of(case.chain.flipped(k), at, values)[row] for k in flipped]
        word = where(verdict, off[row], {"right, behind a branch point": others})
        counts[f"{word}: {status[row]}"] += 1
        if word == "wrong":
            wrong.append(f"{here}, off by {off[row]:.2e} of its uncertainty")
    return Judged(counts, lost, wrong)


def where(verdict: str, off: float, others: Mapping[str, Sequence[float]]) -> str:
    """`right`, the first word of which another branch is met, or `wrong`; misses are in parts of
    the uncertainty."""
    if verdict == "beyond":
        return "wrong"
    branches = {"right": [off], **others}
    return next((word for word, misses in branches.items() if min(misses, default=1) < 1), "wrong")


def parts_of(chain: Chain, at: Array, values: Array) -> Array:
    """The largest miss of the outputs (outputs, rows), in parts of their uncertainty."""
    outputs, within, _ = chain.judged(at)
    off = [turned(dyad, v - o) for dyad, v, o in zip(chain.dyads, values, outputs, strict=True)]
    return np.abs(off / within).max(axis=0)
