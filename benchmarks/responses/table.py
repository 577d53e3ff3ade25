"""Responses: time against error over tolerances, beside others' integrators."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial

import numpy as np

from benchmarks.responses.cases import RUN, TOLERANCES, Case, cases
from benchmarks.responses.peers import Way, peers
from mechkin_cli.bench.measurement import in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, cell_text
from mechkin_cli.model.model import Model

MILLI = 1000.0

COLUMNS = (
    ReportColumn("case", "response"),
    ReportColumn("method", "method"),
    ReportColumn("setting", "setting"),
    ReportColumn("milliseconds", "ms", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times\nmechkin", "time"),
    ReportColumn("error", "largest\nerror", "error"),
)
OWN = "mechkin, respond()"


def response_table(
    rounds: int,
    tolerances: tuple[float, ...] = TOLERANCES,
    names: Iterable[str] | None = None,
) -> ReportTable:
    """All cases, or those of some names."""
    wanted = None if names is None else set(names)
    rows: list[dict[str, Cell]] = []
    missing: dict[str, None] = {}
    for case in cases():
        if wanted is None or case.name in wanted:
            rows += _case(case, rounds, tolerances, missing)
    notes = (
        "the model is read before, the response runs anew each time. others: scipy's integrators",
        "on dense equations in numpy (of the double pendulum and the spring written by hand),",
        "Pinocchio's accelerations in scipy's DOP853, MuJoCo's own classical Runge-Kutta steps,",
        "their number between two rows. times mechkin: against respond() at the roughest tolerance",
        "at which it is as exact, or at its smallest. errors: of all coordinates in rad and m,",
        "against an extrapolated motion in numpy's widest numbers, or a closed form (spring).",
        *summary(rows),
        *(f"{library} is left out: it is not installed." for library in missing),
    )
    return ReportTable("responses", "Responses: time against error", COLUMNS, rows, notes)


def summary(rows: Iterable[Mapping[str, Cell]]) -> list[str]:
    """Of each response, how many times the fastest other method takes at no smaller error."""
    least: dict[str, float] = {}
    for row in rows:
        case, ratio = str(row["case"]), row["ratio"]
        if row["method"] != OWN and isinstance(ratio, float):
            least[case] = min(ratio, least.get(case, ratio))
    said = ", ".join(f"{case} {cell_text(ratio, 'time')}" for case, ratio in least.items())
    if not said:
        return []
    return [f"The fastest other method whose error is no larger: {said} times as fast."]


def _case(
    case: Case, rounds: int, tolerances: tuple[float, ...], missing: dict[str, None]
) -> list[dict[str, Cell]]:
    ways = [_own(case, tolerance) for tolerance in tolerances]
    others, absent = peers(case, tolerances)
    missing |= dict.fromkeys(absent)
    ways += others
    times = in_turns({k: way.call for k, way in enumerate(ways)}, rounds)
    errors = [float(np.max(np.abs(way.read() - case.true))) for way in ways]
    rows: list[dict[str, Cell]] = []
    for k, way in enumerate(ways):
        beside = _as_exact(errors[: len(tolerances)], errors[k])
        rows.append(
            {
                "case": case.name,
                "method": way.method,
                "setting": way.setting,
                "milliseconds": MILLI * times[k].median,
                "spread": times[k].spread,
                "ratio": times[k].ratio(times[beside]),
                "error": errors[k],
            }
        )
    return rows


def _as_exact(own: list[float], error: float) -> int:
    """Which of our runs another is held against: the least exact one that is as exact as it, else
    the most exact one."""
    enough = [k for k, mine in enumerate(own) if mine <= error]
    return max(enough, key=lambda k: own[k]) if enough else int(np.argmin(own))


def _own(case: Case, tolerance: float) -> Way:
    model = case.model(tolerance)
    run = partial(_responded, model, case.names)
    return Way(OWN, f"{tolerance:.0e}", run, run)


def _responded(model: Model, names: tuple[str, ...]) -> np.ndarray:
    found = model.respond(RUN, names, tables=[], threads=1).result
    return np.array([np.asarray(found.quantity(name).value, float) for name in names])
