"""What mechkin says of a case, row by row, against the closed form."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from oracle.numerics import mp
from random_families.no_wrong_row.branch import TURN, Undecided, Way, way
from random_families.no_wrong_row.case import Case
from random_families.no_wrong_row.drawing import Column
from random_families.no_wrong_row.field import EXACT, FAST
from random_families.no_wrong_row.linkage import Linkage
from random_families.no_wrong_row.singular import least_of_block

import mechkin_cli as mk

Array = NDArray[np.float64]
LEAST_SINGULAR = 3e-6
"""Least scaled singular value from the start on at which a row must be there: 1e-6, and a factor
for the closing joint that was chosen."""
AT_FOLD = 1e-8
"""Places this near (rad) to a dead centre may be on either side of it."""
ANGLE = 1e-9
"""What a coordinate may be off by rounding, rad or parts of the size, besides its condition."""
ROUNDINGS = 4
"""Of the input that the roundings of all dimensions come to: where two loops are singular at once,
one rounding of the input alone may turn a wrist by degrees."""
SOLVED = ("ok", "near-singular", "rank-unclear")


@dataclass
class Verdict:
    """Rows by kind, and a sentence on the first one of each kind that is at fault."""

    counts: Counter[str] = field(default_factory=Counter)
    faults: dict[str, str] = field(default_factory=dict)

    def add(self, kind: str, words: str = "") -> None:
        self.counts[kind] += 1
        if words:
            self.faults.setdefault(kind, words)


def judged(case: Case, closed_at: list[str] | None = None) -> Verdict:
    """The verdict on one case, its loops closed at these joints or as they are closed by
    themselves; `undecided` where a margin is zero to rounding."""
    verdict = Verdict()
    try:
        truth = Truth(case)
    except Undecided:
        verdict.add("undecided")
        return verdict
    names = [column.name for column in case.drawing.columns]
    asked = list(dict.fromkeys(vector_of(name)[0] for name in names))
    analysis = mk.loads(case.text).analyze(asked, tables=[], closed_at=closed_at)
    status = analysis["row.status"].tolist()
    if truth.starts_beyond():
        verdict.counts["first row beyond a fold"] += len(status)
        return verdict
    misses = truth.misses({name: cells(analysis, name) for name in names})
    for k, word in enumerate(status):
        where = f"row {k} at {case.travel.rows[k]:.12g} deg, {word}"
        kind, words = truth.kind(k, word, misses)
        verdict.add(kind, f"{where}; {words}" if words else "")
    return verdict


def vector_of(name: str) -> tuple[str, int | None]:
    """The quantity of a column, and which component of it."""
    quantity, _, last = name.rpartition(".")
    return (quantity, "xyz".index(last)) if last in ("x", "y", "z") else (name, None)


def cells(analysis: Any, name: str) -> Array:
    quantity, component = vector_of(name)
    found = np.asarray(analysis[quantity])
    return found if component is None else found[:, component]


class Truth:
    """The drawn branch of a case in all its rows.

    Raises:
        Undecided: a margin is zero to rounding.
    """

    def __init__(self, case: Case) -> None:
        self.case, self.linkage = case, case.drawing.linkage(case.sides)
        travel = case.travel
        self.high, self.low = np.radians(travel.highest), -np.radians(travel.lowest)
        self.ways = {
            sign: way(self.linkage, sign, float(reach.max()), judging=True)
            for sign, reach in ((1, self.high), (-1, self.low))
            if reach.max() > 0
        }
        self.least = {
            sign: least_singular(case, self.linkage, one) for sign, one in self.ways.items()
        }

    def starts_beyond(self) -> bool:
        """Whether the first row is beyond the end of what is drawn: any assembly may be taken."""
        first = float(np.radians(self.case.travel.rows[0]))
        return any(sign * first > one.end - AT_FOLD for sign, one in self.ways.items())

    def kind(self, k: int, status: str, misses: list[str]) -> tuple[str, str]:
        """The kind of verdict on a row, and what is at fault."""
        met = [
            (sign, one, float(reach[k]))
            for sign, reach in ((1, self.high), (-1, self.low))
            if (one := self.ways.get(sign)) is not None
        ]
        if any(abs(t - one.end) < AT_FOLD for _, one, t in met):
            return "at a fold", ""
        beyond = [(sign, one) for sign, one, t in met if t > one.end]
        solved = status in SOLVED
        if beyond:
            return self._beyond(k, status, *beyond[0])
        if status == "beyond-dead-centre":
            return "wrong: beyond where assembled", "nothing ends before"
        if not solved:
            least = min((self._least(sign, t) for sign, _, t in met), default=1.0)
            if least >= LEAST_SINGULAR:
                return "lost", f"least singular value {least:.2g}"
            return "given up", ""
        return ("wrong row", misses[k]) if misses[k] else ("right", "")

    def _beyond(self, k: int, status: str, sign: int, one: Way) -> tuple[str, str]:
        limit = f"the branch ends at {math.degrees(sign * one.end):.12g} deg ({one.folds})"
        if status in SOLVED:
            return "wrong: solved beyond a fold", limit
        row = abs(math.radians(float(self.case.travel.rows[k])))
        returned = row < one.end
        least = before_the_end(self.case, self.linkage, one)
        if status != "beyond-dead-centre" and not returned and least >= LEAST_SINGULAR:
            return "fold not named", limit
        return "right: beyond", ""

    def _least(self, sign: int, t: float) -> float:
        one = self.ways[sign]
        at = TURN if one.periodic and t > TURN else t
        return float(self.least[sign][max(int(np.searchsorted(one.t, at, "right")) - 1, 0)])

    def misses(self, found: dict[str, Array]) -> list[str]:
        """How each row differs from the branch; "" where it does not, or has no solution."""
        rows = self.case.travel.rows
        placed = self.linkage.at(np.radians(rows), FAST)
        allowed = self._allowed({n: np.asarray(m) for n, m in placed.margin.items()}, len(rows))
        words = [""] * len(rows)
        for column in self.case.drawing.columns:
            want, have = np.asarray(placed.value[column.body]), found[column.name]
            with np.errstate(invalid="ignore"):
                wrong = self._off(column, have, want) > allowed
            for k in np.flatnonzero(wrong):
                words[k] = words[k] or self._exactly(int(k), found)
            if not column.angle:
                continue
            apart = np.radians(have) - self._continuous(column)
            if self.case.sides or self.case.travel.rows[0]:
                # the first row that is there counts from where it finds itself
                first = apart[np.isfinite(apart)][:1]
                apart -= TURN * np.round(first / TURN).sum()
            turns = np.abs(apart) > 0.75 * TURN
            for k in np.flatnonzero(turns):
                words[k] = words[k] or f"{column.name} {have[k]:.6g} is off by whole turns"
        return words

    def _off(self, column: Column, have: ArrayLike, want: ArrayLike) -> Array:
        if not column.angle:
            return np.asarray(np.abs(np.subtract(have, want)) / self.linkage.size)
        d = np.radians(have) - want
        return np.asarray(np.abs(d - TURN * np.round(d / TURN)))

    def _allowed(self, margin: dict[str, Array], rows: int) -> Array:
        """What a coordinate may be off: rounding over the product of all loops' singular values."""
        singular = np.ones(rows)
        for m in margin.values():
            singular = singular * np.maximum(np.sqrt(np.maximum(m, 0.0)), 1e-16)
        return np.minimum(ANGLE + 1e-14 / singular, 1e-3)

    def _exactly(self, k: int, found: dict[str, Array]) -> str:
        """A row's differences at 60 digits, beyond what roundings of the input change."""
        t = mp.mpf(float(self.case.travel.rows[k])) * mp.pi / 180
        unit = mp.mpf(2) ** -52 * max(mp.one, abs(t))
        placed, *beside = (self.linkage.at(t + d * unit, EXACT) for d in (0, -1, 1))
        margin = {name: np.array([float(m)]) for name, m in placed.margin.items()}
        allowed = float(self._allowed(margin, 1)[0])
        out = []
        for column in self.case.drawing.columns:
            want, *others = (float(one.value[column.body]) for one in (placed, *beside))
            moved = self._off(column, np.degrees(others) if column.angle else others, want).max()
            have = np.array([float(found[column.name][k])])
            if self._off(column, have, np.array([want]))[0] > allowed + ROUNDINGS * moved:
                shown = math.degrees(want) if column.angle else want
                out.append(f"{column.name} {have[0]:.12g} for {shown:.12g}")
        return ", ".join(out)

    def _continuous(self, column: Column) -> Array:
        """A coordinate as it goes on from the drawing, roughly: whole turns are counted."""
        radians = np.radians(self.case.travel.rows)
        want = np.zeros_like(radians)
        for sign, one in self.ways.items():
            here = radians * sign >= 0
            at, turns = one.reduced(np.abs(radians[here]))
            value = one.value[column.body]
            winding = round((value[-1] - value[0]) / TURN) if one.periodic else 0
            want[here] = np.interp(at, one.t, value) + winding * TURN * turns
        return want


def least_singular(case: Case, linkage: Linkage, one: Way) -> Array:
    """By place of a way: the least singular value of a block from the start on."""
    least = np.full(len(one.t), math.inf)
    for group in blocks(case, one):
        least = np.minimum(least, least_of_block(linkage, group, one))
    return np.minimum.accumulate(least)


def before_the_end(case: Case, linkage: Linkage, one: Way) -> float:
    """The least singular value before the one that goes to zero at the end falls."""
    least = math.inf
    for group in blocks(case, one):
        value = least_of_block(linkage, group, one)
        if one.folds in group:
            well = np.flatnonzero(value > 1e-2)
            value = value[: well[-1] + 1] if len(well) else value[:1]
        least = min(least, float(value.min()))
    return least


def blocks(case: Case, one: Way) -> list[tuple[str, ...]]:
    together = {name for group in case.drawing.merged for name in group}
    alone = [(name,) for name in one.margin if name not in together]
    return [*case.drawing.merged, *alone]
