"""A run of the bench: scenes, methods, timing in turns, errors; everything as records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import thread_time
from typing import TYPE_CHECKING, Any

from mechkin_cli.benchmark.measurement import Measurement, Method, Skipped, errors_of, measured
from mechkin_cli.benchmark.methods import FAMILIES, methods_of
from mechkin_cli.benchmark.methods.kernel import FAMILY, UNIT
from mechkin_cli.benchmark.scene import Scene, Values
from mechkin_cli.benchmark.timing import Timing, in_turns
from mechkin_cli.benchmark.wide import exact_values

if TYPE_CHECKING:
    from mechkin_cli.benchmark.report import Table
    from mechkin_cli.benchmark.subject import Subject


@dataclass(frozen=True)
class Rounds:
    """In how many rounds methods are timed: those of the kernel, and those row by row in Python."""

    fast: int = 15
    slow: int = 3


FULL, QUICK = Rounds(), Rounds(3, 1)

DEMAND_SCENES = ("RCSR", "7R", "Stewart")
"""Of the mechanisms without a file, those whose demand plan and threads are looked at."""

PROCESS_SCENES = ("RCSR", "7R")

LONG = 0.5
"""Seconds of a sweep by a slow method from which on one round has to do."""


def tables(
    subjects: Sequence[Subject], scenes: Sequence[Scene], rounds: Rounds, *, whole: bool
) -> Iterator[Table]:
    """What the settings of a run cost, and where it is `whole` variants and responses, too."""
    from mechkin_cli.benchmark.demand_table import demand_table
    from mechkin_cli.benchmark.thread_table import thread_table

    processes = rounds.slow if rounds.slow > 1 else 0
    for subject, scene in list(zip(subjects, scenes, strict=True)):
        if not whole or scene.name in DEMAND_SCENES:
            yield demand_table(scene, subject, rounds.fast, processes)
    if processes:
        from mechkin_cli.benchmark.process_table import process_table

        for subject in subjects:
            if not whole or subject.name in PROCESS_SCENES:
                yield process_table(subject, processes)
    yield thread_table([s for s in scenes if not whole or s.name in DEMAND_SCENES], rounds.slow)
    if whole:
        from mechkin_cli.benchmark.responses.table import response_table
        from mechkin_cli.benchmark.variant_table import variant_table

        yield variant_table(rounds.slow)
        yield response_table(rounds.slow)


@dataclass(frozen=True)
class Bench:
    """All that a scene was measured by; errors are against `exact`."""

    scene: Scene
    measurements: tuple[Measurement, ...]
    skipped: tuple[Skipped, ...]
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
            "skipped": [{"family": s.family, "reason": s.reason} for s in self.skipped],
        }


def bench(scene: Scene, rounds: Rounds, families: Iterable[str] = tuple(FAMILIES)) -> Bench:
    """Measures a scene by some families of methods; ours is always among them."""
    wanted = dict.fromkeys([FAMILY, *families])
    found = [each for family in wanted for each in methods_of(scene, family)]
    methods = [each for each in found if isinstance(each, Method)]
    skipped = tuple(each for each in found if isinstance(each, Skipped))
    true, exact = exact_values(scene)
    lengths = frozenset(c.name for c in scene.chain.coordinates if c.is_length)
    units = {m.level: m for m in methods if m.family == FAMILY and m.curve == UNIT}
    measurements = []
    for method, timing, by, values in _timed(methods, units, rounds):
        errors = errors_of(scene.asked, lengths, values, true)
        unit = units[method.level]
        measurements.append(measured(scene.name, method, timing, by, unit.rows, errors))
    return Bench(scene, tuple(measurements), skipped, exact)


def _timed(
    methods: Sequence[Method], units: Mapping[str, Method], rounds: Rounds
) -> Iterator[tuple[Method, Timing, Timing, Values]]:
    """Each method with its times, those of the kernel in the same rounds, and what it finds."""
    fast = [m for m in methods if not m.slow]
    times = in_turns({id(m): m.call for m in fast}, rounds.fast)
    for method in fast:
        yield method, times[id(method)], times[id(units[method.level])], method.read()
    for method in methods:
        if method.slow:
            yield method, *_slowly(method, units[method.level], rounds.slow)


def _slowly(method: Method, unit: Method, most: int) -> tuple[Timing, Timing, Values]:
    """Times a method whose runs are long, beside the kernel, and keeps what the first run finds."""
    own: list[float] = []
    others: list[float] = []
    values: Values = {}
    while not own or (len(own) < most and own[0] < LONG):
        begun = thread_time()
        found = method.read()
        own.append(thread_time() - begun)
        values = values or found
        begun = thread_time()
        unit.call()
        others.append(thread_time() - begun)
    return Timing(tuple(own)), Timing(tuple(others)), values
