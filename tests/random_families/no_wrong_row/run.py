"""One case by its number, for processes."""

from __future__ import annotations

from typing import NamedTuple

from random_families.no_wrong_row.case import drawn
from random_families.no_wrong_row.verdicts import Verdict, judged


class Outcome(NamedTuple):
    """Rows by kind, a sentence for each kind of fault, and the file."""

    number: int
    what: str
    counts: dict[str, int]
    faults: dict[str, str]
    text: str


def run_one(number: int) -> Outcome:
    case = drawn(number)
    try:
        verdict = judged(case)
    except Exception as error:
        verdict = Verdict()
        verdict.add("error", f"{type(error).__name__}: {str(error)[:300]}")
    what = " + ".join(case.drawing.families)
    return Outcome(number, what, dict(verdict.counts), verdict.faults, case.text)
