"""Timing of calls against one another: in turns, so that a slow moment of the machine meets all.

Calls inside this process are timed by the processor time of the thread, which leaves out what other
programs took of the machine meanwhile; whole processes by the clock on the wall.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from time import thread_time
from typing import TypeVar

import numpy as np

Key = TypeVar("Key", bound=Hashable)

ROUNDS = 41
SHORTEST = 2e-3
"""A call that takes less (s) is repeated within a round until it takes as long."""


@dataclass(frozen=True)
class Timing:
    """Seconds of one call in each round."""

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The median, s."""
        return float(np.median(self.seconds))

    @property
    def spread(self) -> float:
        """Half the distance between the quartiles, in parts of the median."""
        low, high = np.percentile(self.seconds, [25, 75])
        return float((high - low) / 2.0 / self.median)

    def ratio(self, other: Timing, factor: float = 1.0) -> float:
        """Median over the rounds of this time / (factor * the other's time in the same round)."""
        parts = zip(self.seconds, other.seconds, strict=True)
        return float(np.median([mine / (factor * theirs) for mine, theirs in parts]))


def in_turns(
    calls: Mapping[Key, Callable[[], object]],
    rounds: int = ROUNDS,
    clock: Callable[[], float] = thread_time,
) -> dict[Key, Timing]:
    """Times the calls one after the other, `rounds` times over, after one round to warm up."""
    repeats = {key: _repeats(call, clock) for key, call in calls.items()}
    seconds: dict[Key, list[float]] = {key: [] for key in calls}
    enabled = gc.isenabled()
    gc.disable()
    try:
        for _ in range(rounds):
            for key, call in calls.items():
                seconds[key].append(_once(call, repeats[key], clock))
    finally:
        if enabled:
            gc.enable()
    return {key: Timing(tuple(times)) for key, times in seconds.items()}


def _once(call: Callable[[], object], repeats: int, clock: Callable[[], float]) -> float:
    start = clock()
    for _ in range(repeats):
        call()
    return (clock() - start) / repeats


def _repeats(call: Callable[[], object], clock: Callable[[], float]) -> int:
    call()
    return max(1, round(SHORTEST / max(_once(call, 1, clock), 1e-9)))
