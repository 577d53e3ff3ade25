"""What is proven of a linkage's dead centres, against its discriminant at 40 digits."""

from __future__ import annotations

from typing import Any, NamedTuple

from oracle import mp
from random_families.dead_centres.case import Linkage

import mechkin_cli as mk

DIGITS = 40
WAYS = ("from: 0, to: 7, step: 0.25", "from: 0, to: -7, step: -0.25")


class Judged(NamedTuple):
    """Dead centres at which a sweep ends: how many are there, are proven, are proven and not where
    they are said to be; why others are not; the largest radius of an input there."""

    met: int
    proven: int
    false: list[str]
    reasons: list[str]
    radius: float


def is_between(bounds: tuple[Any, Any], true: Any, turn: Any) -> bool:
    """Whether a value lies within its bounds, up to whole turns."""
    low, high = (mp.mpf(float(bound)) for bound in bounds)
    if turn:
        true += turn * mp.nint(((low + high) / 2 - true) / turn)
    return bool(low <= true <= high)


def judge(case: Linkage) -> Judged:
    """Both ways from the drawing."""
    met = proven = 0
    false: list[str] = []
    reasons: list[str] = []
    radius = 0.0
    for way in WAYS:
        certificate = mk.loads(case.swept(way)).certify()
        for found in certificate.dead_centres:
            met += 1
            if not found.is_proven:
                reasons.append(found.words)
                continue
            proven += 1
            low, high = found.bounds
            radius = max(radius, 0.5 * (high - low))
            with mp.workdps(DIGITS):
                turn = 2 * mp.pi
                true = case.dead_centre(0.5 * (low + high))
                if not is_between((low, high), true, None):
                    false.append(f"{case.driver} {low!r} {high!r} {mp.nstr(true, 25)}")
                output = case.output_at(true)
                if not is_between(found.enclosure(case.output), output, turn):
                    false.append(f"{case.output} {found.enclosure(case.output)} {output}")
    return Judged(met, proven, false, reasons, radius)
