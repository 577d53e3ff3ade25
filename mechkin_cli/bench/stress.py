"""A small set of hard mechanisms whose rows are known, and what becomes of them here.

The set is kept as data: the text of each file beside its true places, decided in double-double by
closed forms or by closing equations that are followed from the drawing. No code of the solver had a
part in them. The project draws them from its families of random mechanisms, of which
`docs/stress.md` tells.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import IntEnum
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable
from mechkin_cli.model import loads
from mechkin_cli.verdict import Status, has_solution

if TYPE_CHECKING:
    from mechkin_cli.analysis import Analysis


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
"""Faults of each mechanism that are told."""


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
        return {
            "family": self.family,
            "rows": self.rows,
            "verdicts": dict(self.verdicts),
            "faults": list(self.faults),
        }


def kept() -> list[dict[str, Any]]:
    """The mechanisms of the set.

    Each has its `family`, the `text` of its file, whether that is a `response`, its `size` in m,
    of each row whether it `exists` and is `decided`, and `places`: of some coordinates `name`,
    `kind`, the true `value` in deg or m and that of the nearest `other` assembly, or None.
    """
    text = files("mechkin_cli.bench").joinpath(KEPT).read_text(encoding="utf-8")
    found: list[dict[str, Any]] = json.loads(text)["mechanisms"]
    return found


def outcomes(mechanisms: Sequence[Mapping[str, Any]] | None = None) -> Iterator[Outcome]:
    """Runs the set, or other mechanisms that are known as well, and judges every row."""
    for known in kept() if mechanisms is None else mechanisms:
        yield _outcome(known)


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


def stress(heard: Callable[[str], None]) -> list[Outcome]:
    """Runs the set; `heard` is told the family that is at work."""
    found: list[Outcome] = []
    for known in kept():
        heard(known["family"])
        found += outcomes([known])
    return found
