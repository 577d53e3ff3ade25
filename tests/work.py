"""Work counted in calls of functions, which no other load on the machine changes."""

from __future__ import annotations

import cProfile
import pstats
from collections.abc import Callable


def calls(work: Callable[[], object], *, of_c: bool = True) -> int:
    """How many functions are called, those of Python and, unless told otherwise, of C."""
    profile = cProfile.Profile(builtins=of_c)
    profile.enable()
    try:
        work()
    finally:
        profile.disable()
    return int(pstats.Stats(profile).total_calls)  # type: ignore[attr-defined]
