"""A run of the bench: scenes, methods, timing in turns, errors; everything as records."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from time import perf_counter, thread_time
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
from mechkin_cli.bench.methods import (
    FAMILY,
    UNIT,
    dense_methods,
    kernel_methods,
    scipy_methods,
    stepping_methods,
)
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, key_of
from mechkin_cli.bench.scene import BATCH, BenchScene, Values
from mechkin_cli.errors import NotRepeated, wide_run
from mechkin_cli.kernel import _kernel
from mechkin_cli.model import loads
from mechkin_cli.plan import Demand, demand_of
from mechkin_cli.session import Packing
from mechkin_cli.sweep import analyze
from mechkin_cli.templates import template_text

MICRO = 1000.0 * 1000.0

# What settings of a run cost. Skipping: the same rows with one part of the demand plan more at a
# time, in the kernel's call and in `analyze`. Threads: what they gain.

DEMAND_COLUMNS = (
    ReportColumn("part", "computed"),
    ReportColumn("kernel", "kernel,\nus a row", "time"),
    ReportColumn("share", "% of\nall", "percent"),
    ReportColumn("analyze", "analyze,\nus a row", "time"),
    ReportColumn("analyze_share", "% of\nall", "percent"),
)


def steps(scene: BenchScene) -> list[tuple[str, tuple[str, ...], Demand]]:
    """Each part with the quantities of the parts up to it, and what is demanded beside them."""
    asked = scene.asked
    efforts = tuple(name for name in asked.loads if name.endswith(".effort"))
    first = (*asked.position, *asked.velocity)
    moving = asked.level("motion")
    parts = [("position", asked.position), ("+ velocity", first), ("+ acceleration", moving)]
    if efforts:
        parts.append(("+ effort", (*moving, *efforts)))
    if len(asked.loads) > len(efforts):
        parts.append(("+ reactions of all joints", asked.level("everything")))
    verdicts = ("+ verdicts of all rows", parts[-1][1], scene.verdicts("everything"))
    return [*((name, names, Demand.POSITION) for name, names in parts), verdicts]


def demand_table(scene: BenchScene, rounds: int) -> ReportTable:
    """One line for every step."""
    plan, session = steps(scene), scene.model.session.packed(Packing(0, 1))
    last = len(plan) - 1
    calls = [scene.kernel(names, scene.followed, BATCH, more=more) for _, names, more in plan]
    kernel = in_turns(dict(enumerate(calls)), rounds)
    whole = in_turns(
        {
            k: partial(analyze, session, names, verdicts=k == last)
            for k, (_, names, _) in enumerate(plan)
        },
        rounds,
    )
    rows: list[dict[str, Cell]] = [
        {
            "part": name,
            "kernel": MICRO * kernel[k].median / BATCH,
            "share": kernel[k].ratio(kernel[last]),
            "analyze": MICRO * whole[k].median / scene.result.rows,
            "analyze_share": whole[k].ratio(whole[last]),
        }
        for k, (name, _, _) in enumerate(plan)
    ]
    notes = (
        f"kernel: {BATCH} rows a call; analyze: {scene.result.rows} rows, with verdicts in the",
        "last line alone.",
        "each line computes all lines above it as well.",
    )
    name = "demand_" + key_of(scene.name)
    return ReportTable(name, f"{scene.name}: what skipping saves", DEMAND_COLUMNS, rows, notes)


THREAD_ROWS = 50_000

THREAD_COLUMNS = (
    ReportColumn("scene", "mechanism"),
    ReportColumn("threads", "threads", "number"),
    ReportColumn("microseconds", "us a row", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("gain", "times one\nthread", "ratio"),
)


def thread_table(scenes: Sequence[BenchScene], rounds: int, rows: int = THREAD_ROWS) -> ReportTable:
    """Everything that is asked of every scene, on 1, 2, 4 ... threads, as many as there are."""
    most = _kernel.available_processors()
    counts = [n for n in (1, 2, 4, 8, 16, 32, 64) if n < most] + [most]
    lines: list[dict[str, Cell]] = []
    for scene in scenes:
        calls = {
            n: scene.kernel("everything", scene.followed, rows, packing=Packing(0, n))
            for n in counts
        }
        times = in_turns(calls, rounds, perf_counter)
        for n, timing in times.items():
            lines.append(
                {
                    "scene": scene.name,
                    "threads": n,
                    "microseconds": MICRO * timing.median / rows,
                    "spread": timing.spread,
                    "gain": times[counts[0]].ratio(timing),
                }
            )
    notes = (f"{rows} rows a call with everything; by the clock on the wall.",)
    return ReportTable("threads", "What threads gain", THREAD_COLUMNS, lines, notes)


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
