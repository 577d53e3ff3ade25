"""What mechkin says of a case, row by row, against the closed form."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from mpmath import mpf
from numpy.typing import NDArray

import mechkin_cli as mk
from random_families.no_wrong_row.branch import TURN, Undecided, Way, way
from random_families.no_wrong_row.case import Case
from random_families.no_wrong_row.field import EXACT, FAST
from random_families.no_wrong_row.linkage import Linkage, Placed

Array = NDArray[np.float64]
LEAST_SINGULAR = 3e-6
"""Least scaled singular value from the start on at which a row must be there: 1e-6, and a factor
for the closing joint that was chosen."""
AT_FOLD = 1e-8
"""Rows this near (rad) to a dead centre may be on either side of it."""
ANGLE = 1e-9
"""What a coordinate may be off by rounding, rad or parts of the size, besides its condition."""
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


def judged(case: Case) -> Verdict:
    """The verdict on one case; `undecided` where a margin is zero to rounding."""
    verdict, linkage = Verdict(), case.drawing.linkage()
    radians = np.radians(case.rows)
    try:
        ways = {
            s: way(linkage, s, case.span) for s in (-1, 1) if np.any(s * radians > 0)
        }
    except Undecided:
        verdict.add("undecided")
        return verdict
    names = [column.name for column in case.drawing.columns]
    analysis = mk.loads(case.text).analyze(names, tables=[])
    status = analysis["row.status"].tolist()
    found = {name: analysis[name] for name in names}
    for k, at in enumerate(radians):
        one = ways.get(1 if at > 0 else -1) or next(iter(ways.values()))
        _row(verdict, case, linkage, one, k, abs(float(at)), status[k], found)
    return verdict


def _row(
    verdict: Verdict, case: Case, linkage: Linkage, one: Way, k: int, t: float, status: str,
    found: dict[str, Array],
) -> None:  # fmt: skip
    where = f"row {k} at {case.rows[k]:.12g} deg, {status}"
    if abs(t - one.end) < AT_FOLD:
        return verdict.add("at a fold")
    solved = status in SOLVED
    if t > one.end:
        limit = f"the branch ends at {math.degrees(one.sign * one.end):.12g} deg ({one.folds})"
        if solved:
            return verdict.add("wrong: solved beyond a fold", f"{where}; {limit}")
        if status != "beyond-dead-centre" and least_singular(case, one, one.end, True) > (
            LEAST_SINGULAR
        ):
            return verdict.add("fold not named", f"{where}; {limit}")
        return verdict.add("right: beyond")
    if status == "beyond-dead-centre":
        return verdict.add("wrong: beyond where assembled", f"{where}; end {one.end}")
    if not solved:
        least = least_singular(case, one, t)
        if least >= LEAST_SINGULAR:
            return verdict.add("lost", f"{where}; least singular value {least:.2g}")
        return verdict.add("given up")
    miss = _miss(case, linkage, one, t, k, found)
    return verdict.add(*(("wrong row", f"{where}; {miss}") if miss else ("right",)))


def least_singular(case: Case, one: Way, t: float, before: bool = False) -> float:
    """The least product of roots of margins in a block from the start to t.

    `before`: of the low places before the fold that ends the branch, which itself goes to 0.
    """
    reach = one.t <= (TURN if one.periodic else t)
    groups = {name: [name] for name in one.margin}
    for group in case.drawing.merged:
        for name in group:
            groups[name] = list(group)
    least = math.inf
    for group in groups.values():
        margins = np.sqrt(np.prod([one.margin[name][reach] for name in group], axis=0))
        if before:
            if one.folds in group:
                last = int(np.argmax(margins[::-1] > 1e-2)) if np.any(margins > 1e-2) else 0
                margins = margins[: len(margins) - last] if last else margins
        if len(margins):
            least = min(least, float(margins.min()))
    return least


def _miss(
    case: Case, linkage: Linkage, one: Way, t: float, k: int, found: dict[str, Array]
) -> str | None:
    """How the row differs from the branch; None where it does not."""
    placed = linkage.at(one.sign * np.array([t]), FAST)
    if not _differences(case, linkage, placed, k, found):
        return _turns(case, one, t, k, found)
    exact = linkage.at(_exact_radians(case, k), EXACT)
    wrong = _differences(case, linkage, exact, k, found)
    return ", ".join(wrong) or None


def _exact_radians(case: Case, k: int) -> mpf:
    from mpmath import mp

    return mpf(float(case.rows[k])) * mp.pi / 180


def _differences(
    case: Case, linkage: Linkage, placed: Placed, k: int, found: dict[str, Array]
) -> list[str]:
    out, singular = [], 1.0
    for body in linkage.bodies:
        if body.name in placed.margin:
            margin = float(np.ravel(np.array(placed.margin[body.name], dtype=float))[0])
            singular *= max(math.sqrt(max(margin, 0.0)), 1e-16)
    allowed = ANGLE + 1e-14 / singular
    for column in case.drawing.columns:
        want = float(np.ravel(np.array(placed.value[column.body], dtype=float))[0])
        have = float(found[column.name][k])
        if column.angle:
            miss = abs(math.remainder(math.radians(have) - want, TURN))
            shown = math.degrees(want)
        else:
            miss, shown = abs(have - want) / linkage.size, want
        if not miss <= min(allowed, 1e-3):
            out.append(f"{column.name} {have:.12g} for {shown:.12g}")
    return out


def _turns(case: Case, one: Way, t: float, k: int, found: dict[str, Array]) -> str | None:
    """Whole turns: angles are continuous from the first row."""
    at, turns = one.reduced(np.array([t]))
    for column in case.drawing.columns:
        if not column.angle:
            continue
        value = one.value[column.body]
        winding = round((value[-1] - value[0]) / TURN) if one.periodic else 0
        want = float(np.interp(at[0], one.t, value)) + winding * TURN * float(turns[0])
        if abs(math.radians(float(found[column.name][k])) - want) > 0.75 * TURN:
            return f"{column.name} {found[column.name][k]:.6g} for {math.degrees(want):.6g} (turns)"
    return None
