"""The page of a run: the machine, the figure, what it shows in words, and all tables."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from statistics import median
from typing import TYPE_CHECKING

from mechkin_cli.benchmark.methods.kernel import ANALYZED, FAMILY, FOLLOWED, UNIT
from mechkin_cli.benchmark.report import Cell, Column, Table, cell_text
from mechkin_cli.benchmark.tables import bench_table, markdown

if TYPE_CHECKING:
    from mechkin_cli.benchmark.measurement import Measurement
    from mechkin_cli.benchmark.runs import Bench


MOTION = ("position", "velocity", "acceleration")
SAME = 10.0
"""Errors within this factor count as the same."""

FASTER = {
    "kernel_ratio": "the kernel alone is",
    "followed_ratio": "a sweep followed and closed",
    "sweep_ratio": "`analyze` with all that it does besides",
}

BEST_COLUMNS = (
    Column("scene", "mechanism"),
    Column("level", "asked for"),
    Column("peer", "fastest other method as exact"),
    Column("peer_error", "its error", "error"),
    Column("peer_us", "us per row", "time"),
    Column("own_error", "mechkin's error", "error"),
    Column("sweep_us", "`analyze` with verdicts, us per row", "time"),
    Column("sweep_ratio", "times faster", "time"),
    Column("followed_us", "followed and closed, us per row", "time"),
    Column("followed_ratio", "times faster", "time"),
    Column("kernel_us", "kernel alone, us per row", "time"),
    Column("kernel_ratio", "times faster", "time"),
)


def best_table(benches: Sequence[Bench]) -> Table:
    """For positions and for the motion: the fastest other method whose error is no more than ten
    times that of mechkin's sweep."""
    rows = [
        row for bench in benches for level in ("position", "motion") for row in _best(bench, level)
    ]
    notes = (
        "as exact: every error at most ten times that of mechkin's sweep with its verdicts.",
        "`analyze` finds the first assembly, follows, closes and judges every row. Followed and",
        "closed: its two calls of the kernel.",
        *_beside(benches),
        "Kernel alone: guesses are given.",
        "CasADi's code takes a second and more to compile for every mechanism, which is not",
        "counted; it neither follows nor judges.",
    )
    return Table("ahead", "The fastest other method that is as exact", BEST_COLUMNS, rows, notes)


def _beside(benches: Iterable[Bench]) -> list[str]:
    """What `analyze` of the positions takes beside its two calls of the kernel, in words."""
    beside = []
    for bench in benches:
        own = {m.curve: m for m in bench.measurements if m.setting == "position"}
        if ANALYZED in own and FOLLOWED in own:
            us = own[ANALYZED].microseconds - own[FOLLOWED].microseconds
            beside.append(1e-3 * us * bench.scene.result.rows)
    if not beside:
        return []
    return [
        f"Beside them `analyze` takes {cell_text(median(beside), 'time')} ms, the median over the",
        "mechanisms, however few the rows are.",
    ]


def summary(table: Table) -> str:
    """What `best_table` says, in a sentence."""
    parts = []
    for key, words in FASTER.items():
        found = [v for v in (row.get(key) for row in table.rows) if isinstance(v, float)]
        if found:
            low, high = (cell_text(end(found), "time") for end in (min, max))
            parts.append(f"{words} {low} to {high} times")
    if not parts:
        return "No other method was measured."
    return (
        "Against the fastest other method whose error is at most ten times as large, over all "
        "mechanisms and levels: "
        f"{', '.join(parts)} as fast. Below 1 the other method is faster."
    )


def responses_summary(tables: Iterable[Table]) -> list[str]:
    """Of each response, how many times the fastest other method takes at no smaller error."""
    least: dict[str, float] = {}
    for row in (row for table in tables if table.name == "responses" for row in table.rows):
        case, ratio = str(row["case"]), row["ratio"]
        if not str(row["method"]).startswith(FAMILY) and isinstance(ratio, float):
            least[case] = min(ratio, least.get(case, ratio))
    said = ", ".join(f"{case} {cell_text(ratio, 'time')}" for case, ratio in least.items())
    if not said:
        return []
    return [
        "",
        "Responses against the fastest other method whose error is no larger: "
        f"{said} times as fast.",
    ]


def _best(bench: Bench, level: str) -> list[dict[str, Cell]]:
    own = {m.curve: m for m in bench.measurements if m.family == FAMILY and m.setting == level}
    others = [m for m in bench.measurements if m.family != FAMILY and m.level == level]
    if not others:
        return []
    sweep = own[ANALYZED]
    limits = {kind: SAME * (getattr(sweep, kind) or 0.0) for kind in MOTION}

    def is_exact(m: Measurement) -> bool:
        return all((getattr(m, kind) or 0.0) <= limits[kind] for kind in MOTION if limits[kind])

    row: dict[str, Cell] = {"scene": bench.scene.name, "level": level, "own_error": _worst(sweep)}
    row["peer"] = "none"
    exact = [m for m in others if is_exact(m)]
    peer = min(exact, key=lambda m: m.microseconds, default=None)
    if peer is not None:
        row["peer"] = f"{peer.family}, {peer.curve}, {peer.setting}"
        row |= {"peer_error": _worst(peer), "peer_us": peer.microseconds}
    for key, curve in (("sweep", ANALYZED), ("followed", FOLLOWED), ("kernel", UNIT)):
        if curve in own:
            row[f"{key}_us"] = own[curve].microseconds
            if peer is not None:
                row[f"{key}_ratio"] = peer.microseconds / own[curve].microseconds
    return [row]


def _worst(m: Measurement) -> float | None:
    found = [e for e in (m.position, m.velocity, m.acceleration) if e is not None]
    return max(found, default=None)


def page(
    machine: Mapping[str, str],
    benches: Sequence[Bench],
    tables: Iterable[Table],
    figure: str,
    command: str,
) -> str:
    """The page as Markdown; `figure` is where the picture lies, `command` what made it."""
    said = ", ".join(f"{name} {value}" for name, value in machine.items())
    best, tables = best_table(benches), list(tables)
    head = [
        "# What mechkin costs, and what it is worth",
        "",
        "How long does a position take, and how far is it from the true one, here and with other",
        "libraries? Every method gets the same tree of joints and the same closing joints. The",
        "other libraries start each row from the row before, as a script would. Errors are true",
        "errors, against double-double arithmetic from the file's text.",
        "",
        f"Made by `{command}` on {said};",
        "one thread, unless a line says otherwise. Times are medians of rounds in which all",
        "methods of a table take turns, and `+-` is half the distance of the quartiles. On another",
        "machine times differ, ratios less.",
        "",
        "*Kernel* is the compiled core, given first guesses; *followed and closed* also follows",
        "the branch from row to row; *`analyze`* also finds the first assembly and judges every",
        "row; *process* is the whole command, with Python's start and the reading of the file.",
        "",
        f"![time per position against error]({figure})",
        "",
        summary(best),
        *responses_summary(tables),
        "",
        markdown(best),
    ]
    rest = [markdown(table) for table in tables]
    rest += [markdown(bench_table(bench)) for bench in benches]
    return "\n".join([*head, *rest])
