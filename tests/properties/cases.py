"""The random mechanisms that the tests of this folder run over: single loops, and several loops.

`MECHKIN_RANDOM=5` takes five times as many, and those whose references take long.
"""

from __future__ import annotations

import os
from functools import cache

from properties.answers import Values, answers
from properties.case import Case
from properties.loops import loop
from properties.structures import structure

_TIMES = int(os.environ.get("MECHKIN_RANDOM", "1"))

LOOPS = [f"loop {seed}" for seed in range(28 * _TIMES)]
_SLOW = (2, 14) if _TIMES == 1 else ()
STRUCTURES = [f"structure {seed}" for seed in range(16 * _TIMES) if seed not in _SLOW]
CASES = [*LOOPS, *STRUCTURES]


def case(name: str) -> Case:
    kind, seed = name.split()
    return loop(int(seed)) if kind == "loop" else structure(int(seed))


@cache
def original(name: str) -> Values:
    """All quantities of the mechanism as it stands."""
    return answers(case(name).text)
