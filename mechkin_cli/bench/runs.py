"""A run of the bench: scenes, methods, timing in turns, errors; everything as records."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from time import thread_time
from typing import Any, NamedTuple

import numpy as np

from mechkin_cli.bench.measurement import (
    Bench,
    Method,
    Skipped,
    Timing,
    Unable,
    errors_of,
    in_turns,
    measured,
)
from mechkin_cli.bench.methods import FAMILY, UNIT, dense_methods, kernel_methods
from mechkin_cli.bench.report import ReportTable
from mechkin_cli.bench.row_by_row import scipy_methods, stepping_methods
from mechkin_cli.bench.scene import BenchScene, Values
from mechkin_cli.bench.settings import demand_table, thread_table
from mechkin_cli.errors import NotRepeated, wide_run
from mechkin_cli.model import loads
from mechkin_cli.plan import demand_of
from mechkin_cli.templates import template_text

Family = Callable[[BenchScene], Iterator[Method]]
"""From a scene to its methods at all their settings; raises `Unable` where they cannot run."""

FAMILIES: dict[str, Family] = {
    FAMILY: kernel_methods,
    "dense": dense_methods,
    "scipy": scipy_methods,
    "stepping": stepping_methods,
}
"""The first is ours. A family imports its library itself, so that one that is missing is named and
left out."""


class Rounds(NamedTuple):
    """In how many rounds methods are timed: those of the kernel, and those row by row in Python."""

    fast: int = 15
    slow: int = 3


FULL, QUICK = Rounds(), Rounds(3, 1)

TEMPLATES = ("rssr", "rcsr", "platform")
"""One loop, more of a joint, six loops at once."""

LONG = 0.5
"""Seconds of a sweep by a slow method from which on one round has to do."""


def setting_tables(scenes: Sequence[BenchScene], rounds: Rounds) -> Iterator[ReportTable]:
    """What the settings of a run cost."""
    for scene in scenes:
        yield demand_table(scene, rounds.fast)
    yield thread_table(scenes, rounds.slow)


def templates() -> list[BenchScene]:
    """Some mechanisms to start from, read, checked and closed."""
    return [BenchScene(name, loads(template_text(name), name)) for name in TEMPLATES]


class Suite(NamedTuple):
    """What a command measures.

    Args:
        command: its words, as a page names them.
        scenes: makes the mechanisms where no file is named.
        families: of methods.
        tables: what else is measured.
        words: the same in words.
    """

    command: str
    scenes: Callable[[], list[BenchScene]]
    families: Mapping[str, Family]
    tables: Callable[[Sequence[BenchScene], Rounds], Iterator[ReportTable]]
    words: str


SUITE = Suite("mechkin bench", templates, FAMILIES, setting_tables, "demand plan, threads")


def methods_of(scene: BenchScene, family: str, make: Family) -> list[Method | Skipped]:
    """All methods of a family that can run, then the reason why others cannot."""
    found: list[Method | Skipped] = []
    try:
        found.extend(make(scene))
    except ImportError as error:
        name = str(error.name or "").partition(".")[0]
        found.append(
            Skipped(scene.name, family, f"{name} is not installed (pip install 'mechkin[bench]')")
        )
    except Unable as reason:
        found.append(Skipped(scene.name, family, str(reason)))
    return found


def bench(scene: BenchScene, rounds: Rounds, families: Mapping[str, Family] = FAMILIES) -> Bench:
    """Measures a scene by some families of methods; ours is always among them."""
    wanted = {FAMILY: kernel_methods, **families}
    found = [each for name, make in wanted.items() for each in methods_of(scene, name, make)]
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


TEXT = "double-double, from the numbers of the file's text"


def exact_values(scene: BenchScene) -> tuple[Values, str]:
    """Everything that is asked of a scene, at its places, and how it was computed.

    Arrays (width, places) of numpy's widest numbers, from the rows repeated in double-double; none
    where the text cannot be followed in it.
    """
    wanted = scene.wanted(scene.asked.level("everything"))
    try:
        wide = wide_run(scene.result)
    except NotRepeated as reason:
        return {}, f"not known, as the text cannot be followed in double-double ({reason})"
    demand = demand_of(scene.problem.mechanism, wanted)
    columns = wide.run(wanted, scene.session, wide.inputs, demand)
    values: dict[str, Any] = {
        name: np.asarray(parts.high, np.longdouble)[:, scene.places]
        + np.asarray(parts.low, np.longdouble)[:, scene.places]
        for name, parts in columns.items()
    }
    return values, TEXT


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
