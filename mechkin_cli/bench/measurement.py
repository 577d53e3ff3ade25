"""What is measured: a method at a setting, its timing in turns, the record of its time and errors.

Calls are timed against one another in turns, so that a slow moment of the machine meets all: those
inside this process by the processor time of the thread, which leaves out what other programs took
of the machine meanwhile; whole processes by the clock on the wall.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import asdict, dataclass
from time import thread_time
from typing import Any, TypeVar

import numpy as np

from mechkin_cli.bench.scene import BenchScene, Values

Key = TypeVar("Key", bound=Hashable)

ROUNDS = 41
SHORTEST = 2e-3
"""A call that takes less (s) is repeated within a round until it takes as long, unless another
limit is asked for."""


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
    shortest: float = SHORTEST,
) -> dict[Key, Timing]:
    """Times the calls one after the other, `rounds` times over, after one round to warm up; a call
    that takes less than `shortest` (s) is repeated within a round."""
    repeats = {key: _repeats(call, clock, shortest) for key, call in calls.items()}
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


def _repeats(call: Callable[[], object], clock: Callable[[], float], shortest: float) -> int:
    call()
    return max(1, round(shortest / max(_once(call, 1, clock), 1e-9)))


ZERO = 1e-18
"""Parts of the largest value of its kind up to which a quantity is zero by its nature: beyond the
last digit of doubles, far above that of double-double."""

ERROR_KINDS = ("position", "velocity", "acceleration", "loads")


@dataclass(frozen=True)
class Method:
    """A way to the answers at one setting.

    Args:
        family: who made it, as `scipy`.
        curve: the method; its settings are points of one curve.
        setting: what is varied along the curve, in words.
        level: what it computes, see `scene.LEVELS`.
        call: what is timed.
        rows: how many rows a call solves.
        read: what it finds at the scene's places.
        slow: in Python, row by row: timed in few rounds.
    """

    family: str
    curve: str
    setting: str
    level: str
    call: Callable[[], object]
    rows: int
    read: Callable[[], Values]
    slow: bool = False


class Unable(Exception):
    """A method cannot run on this machine or on this mechanism; the message says why."""


@dataclass(frozen=True)
class Measurement:
    """A method's time and errors on a scene.

    `microseconds` per row: the median of the rounds, `least` of them, and `spread`, half the
    distance of the quartiles in parts of the median. `ratio`: to one kernel call with the same
    level in the same rounds. Errors are the largest ones in parts of their quantity's largest
    value; None where the method does not find it.
    """

    scene: str
    family: str
    curve: str
    setting: str
    level: str
    rows: int
    microseconds: float
    least: float
    spread: float
    ratio: float
    position: float | None
    velocity: float | None
    acceleration: float | None
    loads: float | None

    def record(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self)


@dataclass(frozen=True)
class Bench:
    """All that a scene was measured by; errors are against `exact`. `skipped` says of families why
    not all of their methods can run."""

    scene: BenchScene
    measurements: tuple[Measurement, ...]
    skipped: Mapping[str, str]
    exact: str

    def record(self) -> dict[str, Any]:
        """As plain data."""
        chain = self.scene.chain
        return {
            "name": self.scene.name,
            "rows": self.scene.result.rows,
            "places": self.scene.rows,
            "unknowns": len(chain.unknowns),
            "equations": chain.equations,
            "exact": self.exact,
            "measurements": [m.record() for m in self.measurements],
            "skipped": [{"family": name, "reason": why} for name, why in self.skipped.items()],
        }


def measured(
    scene: str,
    method: Method,
    timing: Timing,
    unit: Timing,
    unit_rows: int,
    errors: Mapping[str, float | None],
) -> Measurement:
    """The record of a method; `unit` is the timing of the kernel in the same rounds."""
    named = (method.family, method.curve, method.setting, method.level, method.rows)
    median, least = (1e6 * s / method.rows for s in (timing.median, min(timing.seconds)))
    ratio = timing.ratio(unit, method.rows / unit_rows)
    kinds = (errors.get(kind) for kind in ERROR_KINDS)
    return Measurement(scene, *named, median, least, timing.spread, ratio, *kinds)


def errors_of(
    asked: Mapping[str, Sequence[str]], lengths: Collection[str], found: Values, true: Values
) -> dict[str, Any]:
    """Largest errors by kind, each in parts of its quantity's largest value.

    Args:
        asked: names by kind.
        lengths: names that are no angles; angles are compared but for whole turns.
        found, true: quantities by name, arrays (width, rows).
    """
    worst: dict[str, Any] = {}
    for kind in ERROR_KINDS:
        known = [name for name in asked[kind] if name in found and name in true]
        # what is zero by its nature is rounding of the numbers that are right
        sizes = {name: float(np.max(np.abs(true[name]))) for name in known}
        nothing = ZERO * max(sizes.values(), default=0.0)
        errors = [
            _error(found[name], true[name], turns=kind == "position" and name not in lengths)
            for name in known
            if sizes[name] > nothing
        ]
        worst[kind] = max((e for e in errors if e is not None), default=None)
    return worst


def _error(found: Any, true: Any, *, turns: bool) -> float | None:
    miss = np.asarray(found, np.longdouble) - true
    if turns:
        # whole turns as exact as the subtraction
        turn = 2 * np.arccos(np.longdouble(-1))
        miss = miss - turn * np.round(miss / turn)
        true = true - turn * np.round(true / turn)
    size = float(np.max(np.abs(true)))
    if not size:
        return None
    error = float(np.max(np.abs(miss))) / size
    return error if np.isfinite(error) else float("inf")
