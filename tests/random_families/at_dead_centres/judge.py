"""Rows at a dead centre and beside it, against the closed form at 50 digits."""

from __future__ import annotations

from typing import NamedTuple

from oracle import mp
from random_families.at_dead_centres.case import DIGITS, Sweep

import mechkin_cli as mk


class Judged(NamedTuple):
    """Rows that are there, those that should have a position and have none, and those whose
    position is wrong: in words."""

    rows: int
    lost: list[str]
    wrong: list[str]


def judge(case: Sweep) -> Judged:
    name = case.linkage.output
    analysis = mk.loads(case.text).analyze([name])
    lost, wrong = [], []
    for row, (status, value) in enumerate(
        zip(analysis["row.status"].tolist(), analysis[name].tolist(), strict=True)
    ):
        with mp.workdps(DIGITS):
            left = case.linkage.discriminant(mp.mpf(case.values[row]))
            roundings = case.roundings(row)
            here = f"row {row} {case.values[row]!r} ({mp.nstr(left, 3)}): {status}"
            if status not in ("ok", "near-singular", "dead-centre"):
                if left > roundings or status != "beyond-dead-centre":
                    lost.append(here)
                continue
            if left < -roundings:
                wrong.append(here)
                continue
            known = case.output(row)
            if known is None:
                continue
            # what a rounding of the discriminant moves the root by
            within = mp.sqrt(max(left, 0) + roundings) - mp.sqrt(max(left, 0)) + mp.mpf("1e-9")
            miss = mp.fmod(mp.mpf(value) - known, 2 * mp.pi)
            if min(abs(miss), abs(abs(miss) - 2 * mp.pi)) > within:
                wrong.append(f"{here} {value!r} {mp.nstr(known, 12)}")
    return Judged(len(case.values), lost, wrong)
