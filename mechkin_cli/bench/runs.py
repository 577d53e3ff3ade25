"""A run of the bench: scenes, methods, timing in turns, errors, everything as records; and a small
set of hard mechanisms whose rows are known, and what becomes of them here.

The set is data: the text of each file beside its true places, decided in double-double by closed
forms or by closing equations that are followed from the drawing. No code of the solver had a part
in them. The project draws them from its families of random mechanisms (`docs/stress.md`).
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from functools import partial
from importlib.resources import files
from time import perf_counter, thread_time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.bench.measurement import (
    Bench,
    Method,
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
from mechkin_cli.verdict import Status, has_solution

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis


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
    asked, moving = scene.asked, scene.names("motion")
    efforts = tuple(name for name in asked["loads"] if name.endswith(".effort"))
    first = (*asked["position"], *asked["velocity"])
    parts = [("position", asked["position"]), ("+ velocity", first), ("+ acceleration", moving)]
    if efforts:
        parts.append(("+ effort", (*moving, *efforts)))
    if len(asked["loads"]) > len(efforts):
        parts.append(("+ reactions of all joints", scene.names("everything")))
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


def methods_of(scene: BenchScene, make: Family) -> tuple[list[Method], str]:
    """All methods of a family that can run, and why others cannot; "" where all can."""
    found: list[Method] = []
    try:
        found.extend(make(scene))
    except ImportError as error:
        name = str(error.name or "").partition(".")[0]
        return found, f"{name} is not installed (pip install 'mechkin[bench]')"
    except Unable as reason:
        return found, str(reason)
    return found, ""


def bench(scene: BenchScene, rounds: Rounds, families: Mapping[str, Family] = FAMILIES) -> Bench:
    """Measures a scene by some families of methods; ours is always among them."""
    wanted = {FAMILY: kernel_methods, **families}
    found = {name: methods_of(scene, make) for name, make in wanted.items()}
    methods = [method for some, _ in found.values() for method in some]
    skipped = {name: why for name, (_, why) in found.items() if why}
    true, exact = exact_values(scene)
    lengths = frozenset(scene.chain.coordinates[k] for k in scene.chain.lengths)
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
    wanted = scene.wanted(scene.names("everything"))
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


KEPT = "hard_mechanisms.json"

ROUNDING = 2.0**-53
WRONG = 100.0
"""Errors above this many roundings times the condition (of rates its square, of accelerations and
forces its cube) are no rounding but another place, unless nine digits are right, which is what
`ok` promises (`CONDITION_NEAR_SINGULAR`)."""
NINE_DIGITS = 1e-9
WRONG_TOLERANCES = 1000.0
"""The same of responses, in their tolerances: errors of steps add up."""
TOLERANCE = 1e-10
"""Of a response that names none."""
CONDITION = "row.condition"
TAKEN = (
    "nearly-common",
    "conventional",
    "hold-ends",
    "undriven-freedom",
    "input-locked",
    "input-dependent",
)
"""Notes of a run that takes axes or points for coinciding: a freedom is held that nothing moves, or
is not driven, or an input does not move anything."""
REFUSED = "refused"
SHOWN = 5
"""Faults of each mechanism that are reported one by one."""


class StressVerdict(IntEnum):
    """What became of a row."""

    right = 0
    right_warned = 1
    """Right, `near-singular` or `rank-unclear`."""
    rightly_none = 2
    """There is none, and none was given."""
    undecided = 3
    """Rounding of the written numbers alone decides whether there is one."""
    false_alarm = 4
    """There is one, and none was given."""
    wrong_warned = 5
    """Wrong, `near-singular` or `rank-unclear`."""
    false_ok = 6
    """Wrong, or there is none, and the row says ok."""
    rates_lost = 7
    """The place is right and says ok, rates, accelerations or forces are not right to nine digits:
    a documented limit of rods that are short beside the mechanism."""
    taken_as_drawn = 8
    """One of these faults where the run itself says that the mechanism is taken for one whose axes
    or points coincide (`COMMON_MOTION`, `LOOP_RANK`): a documented limit."""


FAULTS = (
    StressVerdict.false_ok,
    StressVerdict.wrong_warned,
    StressVerdict.false_alarm,
    StressVerdict.rates_lost,
)
COUNTS = (
    ("right", StressVerdict.right, "right"),
    ("warned", StressVerdict.right_warned, "right,\nwarned"),
    ("none", StressVerdict.rightly_none, "rightly\nnone"),
    ("undecided", StressVerdict.undecided, "un-\ndecided"),
    ("taken", StressVerdict.taken_as_drawn, "as\ndrawn"),
    ("rates_lost", StressVerdict.rates_lost, "rates\nlost"),
    ("wrong_warned", StressVerdict.wrong_warned, "wrong,\nwarned"),
    ("false_alarm", StressVerdict.false_alarm, "false\nalarms"),
    ("false_ok", StressVerdict.false_ok, "false\nok"),
)
"""Columns of tables, as (key, verdict, label)."""

Mask = NDArray[np.bool_]


def verdicts_of(
    codes: NDArray[np.int8],
    exists: Mask,
    decided: Mask,
    wrong: Mask,
    well: Mask,
    noted: Mask,
) -> NDArray[np.int8]:
    """The `Verdict` of every row, all arrays of one shape or broadcast to it.

    Args:
        codes: the rows' `Status`.
        exists: whether the branch gets there, which where it is not `decided` rounding of the
            written numbers could change.
        wrong: whether the place is another one.
        well: whether rates, accelerations and forces are right, too.
        noted: of which runs say that they take axes or points for coinciding.
    """
    solved = has_solution(codes)
    certain = codes == Status.ok
    good = solved & exists & ~wrong
    verdict = np.where(
        solved, np.where(certain, StressVerdict.false_ok, StressVerdict.wrong_warned), 0
    )
    right = np.where(well, StressVerdict.right, StressVerdict.rates_lost)
    verdict = np.where(good, np.where(certain, right, StressVerdict.right_warned), verdict)
    none = np.where(exists, StressVerdict.false_alarm, StressVerdict.rightly_none)
    verdict = np.where(solved, verdict, none)
    verdict = np.where(noted & np.isin(verdict, FAULTS), StressVerdict.taken_as_drawn, verdict)
    return np.where(decided, verdict, StressVerdict.undecided).astype(np.int8)


class Outcome(NamedTuple):
    """What became of one mechanism's rows; `faults` in words."""

    family: str
    rows: int
    verdicts: Counter[str]
    faults: tuple[str, ...]

    @property
    def is_wrong(self) -> bool:
        """Whether a row is wrong and says ok, or the file is refused."""
        return bool(self.verdicts[StressVerdict.false_ok.name] or self.verdicts[REFUSED])

    def record(self) -> dict[str, Any]:
        """As plain data."""
        return self._asdict() | {"verdicts": dict(self.verdicts), "faults": list(self.faults)}


def kept() -> list[dict[str, Any]]:
    """The mechanisms of the set.

    Each has its `family`, the `text` of its file, whether that is a `response`, its `size` in m,
    of each row whether it `exists` and is `decided`, and `places`: of some coordinates `name`,
    `kind`, the true `value` in deg or m and that of the nearest `other` assembly, or None.
    """
    text = files("mechkin_cli.bench").joinpath(KEPT).read_text(encoding="utf-8")
    found: list[dict[str, Any]] = json.loads(text)["mechanisms"]
    return found


def outcomes(mechanisms: Iterable[Mapping[str, Any]]) -> Iterator[Outcome]:
    """Runs mechanisms whose rows are known, and judges every row."""
    return map(_outcome, mechanisms)


def _outcome(known: Mapping[str, Any]) -> Outcome:
    rows = len(known["exists"])
    try:
        analysis = _run(known)
    # whatever a file brings about is a finding, and no end of the others
    except Exception as error:
        words = f"{REFUSED}: {type(error).__name__}: {error}"
        return Outcome(known["family"], rows, Counter({REFUSED: 1}), (words,))
    codes = np.asarray(analysis.result.status, np.int8)
    exists, decided = (np.array(known[name], bool) for name in ("exists", "decided"))
    wrong = _is_wrong(analysis, known)
    noted = np.array(any(note.code in TAKEN for note in analysis.diagnostics))
    judged = verdicts_of(codes, exists, decided, wrong, np.ones(rows, bool), noted)
    counts = Counter(StressVerdict(code).name for code in judged.tolist())
    at = np.flatnonzero(np.isin(judged, FAULTS))[:SHOWN].tolist()
    faults = tuple(
        f"row {row + 1}: {StressVerdict(int(judged[row])).name.replace('_', ' ')}: "
        f"{Status(int(codes[row])).label}"
        for row in at
    )
    return Outcome(known["family"], rows, counts, faults)


def _run(known: Mapping[str, Any]) -> Analysis:
    model = loads(known["text"])
    names = [*(place["name"] for place in known["places"]), CONDITION]
    if known["response"]:
        return model.respond(quantities=names, tables=[], threads=1)
    return model.analyze(names, tables=[], threads=1)


def _is_wrong(analysis: Analysis, known: Mapping[str, Any]) -> Mask:
    """Whether a row is too far from the true place, or nearer to another assembly."""
    error, elsewhere = np.zeros(len(known["exists"])), np.full(len(known["exists"]), np.inf)
    for place in known["places"]:
        unit = known["size"] if place["kind"] == "length" else float(np.degrees(1.0))
        given, right = analysis[place["name"]], np.array(place["value"], float)
        far = np.maximum(1.0, np.abs(right) / unit)
        error = np.maximum(error, _apart(given, right, place["kind"]) / unit / far)
        if place["other"] is not None:
            other = _apart(given, np.array(place["other"], float), place["kind"]) / unit
            elsewhere = np.fmin(elsewhere, other)
    limit: Any = WRONG_TOLERANCES * TOLERANCE
    if not known["response"]:
        condition = np.fmax(analysis[CONDITION], 1.0)
        limit = np.maximum(WRONG * ROUNDING * condition, NINE_DIGITS)
    # written so that a row without numbers is wrong
    wrong: Mask = (elsewhere < error) | ~(error <= limit)
    return wrong


def _apart(given: Any, right: Any, kind: str) -> Any:
    """How far a coordinate is from a value, in m or deg; angles but for whole turns."""
    miss = given - right
    if kind == "angle":
        miss = miss - 360.0 * np.rint(miss / 360.0)
    return np.abs(miss)


def stress_table(found: Sequence[Outcome]) -> ReportTable:
    """What became of the rows of each mechanism."""
    columns = (
        ReportColumn("family", "family"),
        ReportColumn("rows", "rows", "number"),
        *(ReportColumn(key, label, "number") for key, _, label in COUNTS),
    )
    rows: list[dict[str, Cell]] = []
    for outcome in found:
        counts: dict[str, Cell] = {key: outcome.verdicts[v.name] for key, v, _ in COUNTS}
        rows.append({"family": outcome.family, "rows": outcome.rows, **counts})
    faults = [f"{outcome.family}, {words}" for outcome in found for words in outcome.faults]
    return ReportTable("verdicts", "What became of hard mechanisms' rows", columns, rows, faults)


def judge_hard_mechanisms(progress: Callable[[str], None]) -> list[Outcome]:
    """Runs the set; `progress` is called with the family of each mechanism before it runs."""
    judged = []
    for known in kept():
        progress(known["family"])
        judged.append(_outcome(known))
    return judged
