"""Figures of large runs, each as a ratio within one run or against its limit; medians, in turns.

    python tests/benchmark/figures.py [NAME ...] [--rounds N] [--rows N] [--json]

NAMEs: platform, million, verdicts, closing, wheels, threads, chains, loops, storeys; without any,
all of them. Times are by the clock on the wall, as threads and files count, those of `wheels` by
the thread's, those of `loops` and `storeys` by the process's; run it on an otherwise idle machine.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parents[1]))

from benchmark.chains import chain_text
from benchmark.kernel_case import (
    BATCH,
    SWEEP_ROWS,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
)
from benchmark.process import command
from benchmark.specimens import sevenr_specimen
from structure.networks import Network, scissors, windows

import mechkin_cli as mk
from benchmarks import rcsr
from mechkin_cli.bench.measurement import Timing, in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, machine, plain_text
from mechkin_cli.bench.scene import ALONE
from mechkin_cli.mobility import drawn_faults
from mechkin_cli.plan.records import Demand
from mechkin_cli.session import Ask
from mechkin_cli.sweep import analyze, at_once, follow_rows
from mechkin_cli.tables.json import json_text

MECHANISMS = HERE.parents[1] / "mechanisms"
ROWS = 100_000
MILLION = 1_000_000
LOOPS = (10, 20, 40, 100)
ROUNDS = 5

COLUMNS = (
    ReportColumn("case", "case"),
    ReportColumn("value", "value", "time"),
    ReportColumn("unit", "unit"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("limit", "limit", "time"),
    ReportColumn("met", "met", "verdict"),
)


def row(
    case: str,
    value: float,
    unit: str,
    spread: float | None = None,
    limit: float | None = None,
    least: float | None = None,
) -> dict[str, Cell]:
    """A line of a table; `limit` is the most that the value may be, `least` the least."""
    met = None if limit is None and least is None else value <= (limit or value)
    if least is not None:
        met = value >= least
    return {
        "case": case,
        "value": value,
        "unit": unit,
        "spread": spread,
        "limit": limit if least is None else least,
        "met": met,
    }


def timed(calls: Mapping[str, Callable[[], object]], rounds: int) -> dict[str, Timing]:
    return in_turns(calls, rounds, perf_counter)


def with_rows(file: str, pattern: str, replacement: str) -> str:
    """A mechanism's text with another number of rows."""
    text = next(MECHANISMS.glob(f"*/{file}")).read_text(encoding="utf-8")
    changed, count = re.subn(pattern, replacement, text)
    assert count == 1, f"{file}: {pattern} is there {count} times"
    return changed


def platform_text(rows: int) -> str:
    """The Stewart platform whose legs move by laws of time, along a curved path."""
    text = (MECHANISMS / "classics" / "stewart.yaml").read_text(encoding="utf-8")
    laws = {"1": "harmonic", "0": "cycloidal"}
    text, legs = re.subn(
        r"L(\d)\.s: \{from: 0, to: (\S+), count: 21, rate: \S+\}",
        lambda m: f"L{m[1]}.s: {{law: {laws[str(int(m[1]) % 2)]}, from: 0, to: {m[2]}}}",
        text,
    )
    assert legs == 6
    return text.replace("motion:\n", f"motion:\n  time: {{from: 0, to: 1, count: {rows}}}\n")


def platform(rounds: int, rows: int) -> ReportTable:
    """A platform on six legs whose inputs have laws of time, with all that its tables read."""
    model = mk.loads(platform_text(rows), "stewart.yaml")
    motion = partial(model.analyze, ["tool.position"], tables=[])
    calls = {"all of its tables": model.analyze, "position alone": motion}
    times = timed(calls, rounds)
    lines = [
        row(name, 1e6 * t.median / rows, "us a row", t.spread, 2.0) for name, t in times.items()
    ]
    return ReportTable("platform", f"platform with laws of time, {rows} rows", COLUMNS, lines, ())


def million(rounds: int, _: int) -> ReportTable:
    """RCSR from its file to CSV with a million rows; the file has no tables: nine columns."""
    text = with_rows(
        "rcsr.yaml", "from: 150, to: 202, step: 2", f"from: 150, to: 200, count: {MILLION}"
    )
    with TemporaryDirectory(prefix="mechkin-million-") as folder:
        file = Path(folder) / "rcsr.yaml"
        file.write_text(text[: text.index("\ntables:")], encoding="utf-8")
        line = [*command(), "analyze", str(file), "--format", "csv", "--quiet", "--out", folder]
        short = [*command(), "analyze", str(MECHANISMS / "dissertation" / "rcsr.yaml"), *line[3:]]

        run = partial(subprocess.run, check=True, capture_output=True)
        write_again = (Path(folder) / "copy").write_bytes
        run(line)
        content = (Path(folder) / "sweep.csv").read_bytes() + (
            Path(folder) / "rows.csv"
        ).read_bytes()
        calls = {
            "mechkin analyze, 10^6 rows": partial(run, line),
            "mechkin analyze, 27 rows": partial(run, short),
            "as many bytes written": partial(write_again, content),
        }
        times = timed(calls, rounds)
    rows = [row(name, t.median, "s", t.spread) for name, t in times.items()]
    rows[0] = row("mechkin analyze, 10^6 rows", rows[0]["value"], "s", rows[0]["spread"], 1.5)
    return ReportTable("million", "RCSR from file to CSV", COLUMNS, rows, ())


def verdicts(_: int, __: int) -> ReportTable:
    """What the condition costs a general 7R of which only positions are asked."""
    specimen = sevenr_specimen()
    case = KernelCase(specimen, degree_rows(specimen))
    inputs, guesses = repeated(case.inputs), repeated(case.second_order_guesses())
    names = specimen.levels[0]
    bare, judged = (PlannedRun(case, names, more) for more in (Demand.POSITION, Demand.CONDITION))
    times = in_turns(
        {"positions": partial(bare, inputs, guesses), "judged": partial(judged, inputs, guesses)}
    )
    ratio = times["judged"].ratio(times["positions"])
    rows = [
        row(
            "positions",
            1e6 * times["positions"].median / BATCH,
            "us a row",
            times["positions"].spread,
        ),
        row(
            "positions and condition",
            1e6 * times["judged"].median / BATCH,
            "us a row",
            times["judged"].spread,
        ),
        row("ratio", ratio, "", None, 1.25),
    ]
    return ReportTable("verdicts", "general 7R, positions only", COLUMNS, rows, ())


def closing(_: int, __: int) -> ReportTable:
    """What a column of the angle at which a 7R closes, and of its rates, costs against a column of
    the joints' points, which are only read, and against one of their wrenches."""
    specimen = sevenr_specimen()
    case = KernelCase(specimen, degree_rows(specimen))
    inputs, guesses = repeated(case.inputs), repeated(case.second_order_guesses())
    joints = [edge.joint.name for edge in case.layout.graph.edges]
    angles = list(zip(*specimen.motion, strict=True))
    own = [name for names in angles for name in names if name.split(".")[0] in joints]
    at_closing = [name for names in angles for name in names if name.split(".")[0] not in joints]
    points = [f"{joint}.point" for joint in joints]
    wrenches = [f"{joint}.{kind}" for joint in joints for kind in ("force", "moment")]
    effort = next(name for name in specimen.levels[2] if name.endswith(".effort"))
    compared = {
        "closing angle": (own, at_closing, len(at_closing)),
        "points": (own, points, 3 * len(points)),
        "wrenches": ([*own, effort], wrenches, 3 * len(wrenches)),
    }
    calls = {}
    for name, (base, columns, _) in compared.items():
        calls[name, "with"] = partial(PlannedRun(case, [*base, *columns]), inputs, guesses)
        calls[name, "without"] = partial(PlannedRun(case, base), inputs, guesses)
    times = in_turns(calls)
    cost = {
        name: 1e9 * (times[name, "with"].median - times[name, "without"].median) / BATCH / count
        for name, (_, _, count) in compared.items()
    }
    rows = [row(name, value, "ns a column and row") for name, value in cost.items()]
    for name in ("points", "wrenches"):
        rows.append(row(f"angle over {name}", cost["closing angle"] / cost[name], ""))
    return ReportTable("closing", "general 7R, columns of its closing joint", COLUMNS, rows, ())


def wheels(rounds: int, _: int) -> ReportTable:
    """RCSR whose crank a motor turns through wheels over RCSR: the sweep, its kernel alone (it
    follows and runs), and its run alone, whose guesses are of fewer steps with wheels, since the
    motor's way counts in a step's turn."""
    texts = (
        rcsr.dimensions().text(f"from: 150 deg, to: 202 deg, count: {SWEEP_ROWS}"),
        rcsr.behind_wheels(f"from: -300 deg, to: -404 deg, count: {SWEEP_ROWS}"),
    )
    rows = []
    motion = [f"{name}{order}" for order in ("", "_dot", "_ddot") for name in rcsr.COORDINATES]
    asked = {"position": rcsr.COORDINATES, "motion": motion, "all": [*motion, *rcsr.WRENCHES]}
    for level, names in asked.items():
        alone, behind = (sweep_calls(mk.loads(text), names) for text in texts)
        for part in alone:
            # single calls in turns, so that what else the machine does meets both
            pair = {"alone": alone[part], "behind": behind[part]}
            times = in_turns(pair, 100 * rounds, shortest=0.0)
            ratio = times["behind"].ratio(times["alone"])
            spread = times["behind"].spread
            limit = None if part == "run" else 1.15
            rows.append(row(f"{level}: {part}", ratio, "times RCSR", spread, limit))
    return ReportTable("wheels", f"RCSR behind wheels, {SWEEP_ROWS} rows", COLUMNS, rows, ())


def sweep_calls(model: mk.Model, names: Sequence[str]) -> dict[str, Callable[[], object]]:
    """A sweep on one thread, what it lets the kernel follow and run, and the run alone."""
    result = analyze(model.session.packed(ALONE), names)
    session, known = result.session, model.problem.quantities()
    wanted, demand = at_once(session, [known[name] for name in names], verdicts=True)
    ask = Ask(demand, session.readout(wanted))
    follow = partial(follow_rows, session, result.start, every_row=False)
    followed = follow()
    inputs = session.row_inputs(followed.states, followed.turns)

    def kernel() -> None:
        follow()
        session.run(inputs, ask)

    return {
        "sweep": partial(model.analyze, names, tables=[], threads=1),
        "kernel": kernel,
        "run": partial(session.run, inputs, ask),
    }


def threads(rounds: int, count: int) -> ReportTable:
    """One thread against two, for everything that RCSR and the 7R can be asked."""
    sources = {
        "RCSR": with_rows(
            "rcsr.yaml", "from: 150, to: 202, step: 2", f"from: 150, to: 200, count: {count}"
        ),
        "7R": sevenr_specimen().text(f"from: 0 deg, to: 360 deg, count: {count}"),
    }
    rows = []
    for name, text in sources.items():
        model = mk.loads(text, name)
        try:
            model.analyze(threads=2)
        except TypeError:
            rows.append(row(f"{name}: analyze() has no threads", float("nan"), ""))
            continue
        times = timed({str(n): partial(model.analyze, threads=n) for n in (1, 2)}, rounds)
        one, two = times["1"], times["2"]
        rows.append(row(f"{name}, one thread", 1e6 * one.median / count, "us a row", one.spread))
        rows.append(row(f"{name}, two threads", 1e6 * two.median / count, "us a row", two.spread))
        rows.append(row(f"{name}, one over two", one.ratio(two), "times", None, least=1.8))
    return ReportTable("threads", f"threads over {count} rows", COLUMNS, rows, ())


def graph_of(text: str) -> object:
    """What a model needs before it can be analyzed."""
    return mk.loads(text).graph


def chains(rounds: int, _: int) -> ReportTable:
    """Reading, building and the solver graph of four-bars in a chain."""
    calls: dict[str, Callable[[], object]] = {}
    rows = []
    for loops in LOOPS:
        text = chain_text(loops)
        try:
            graph_of(text)
        except mk.MechkinError as error:
            rows.append(row(f"{loops} loops: {str(error)[:40]}", float("nan"), ""))
            continue
        calls[str(loops)] = partial(graph_of, text)
    for name, t in timed(calls, rounds).items():
        rows.append(row(f"{name} loops", 1e3 * t.median / int(name), "ms a loop", t.spread, 1.0))
    return ReportTable("chains", "load and graph of chains of four-bars", COLUMNS, rows, ())


def among_few_and_many(
    case: str, question: Callable[[int], Callable[[], object]], few: int, many: int, rounds: int
) -> dict[str, Cell]:
    """What one of many costs against one of few."""
    calls = {str(count): question(count) for count in (few, many)}
    times = in_turns(calls, rounds, process_time)
    ratio = times[str(many)].median / times[str(few)].median * few / many
    spread = max(timing.spread for timing in times.values())
    return row(f"{case}: one of {many} against one of {few}", ratio, "", spread, 2.0)


def loops(rounds: int, _: int) -> ReportTable:
    """Machines of many loops: what each costs where there are thousands."""

    def whole(network: Callable[[int], Network], count: int) -> Callable[[], object]:
        text = network(count).text
        return lambda: mk.loads(text).analyze()

    def moving(network: Callable[[int], Network], count: int) -> Callable[[], object]:
        text = network(count).text
        return lambda: drawn_faults(mk.loads(text).session)

    rows = []
    for name, network in {"four-bars": windows, "scissors": scissors}.items():
        rows.append(
            among_few_and_many(f"{name}, load and run", partial(whole, network), 100, 2_000, rounds)
        )
        rows.append(
            among_few_and_many(f"{name}, check", partial(moving, network), 100, 2_000, rounds)
        )
    return ReportTable("loops", "a loop in machines of few and many", COLUMNS, rows, ())


def storeys(rounds: int, _: int) -> ReportTable:
    """Scissors, whose assemblies double with every storey: what each assembly costs."""

    def modes(count: int) -> Callable[[], object]:
        text = scissors(1 + count.bit_length() - 1).text
        return lambda: mk.loads(text).modes()

    def ranges(count: int) -> Callable[[], object]:
        text = scissors(1 + count.bit_length() - 1).text
        return lambda: mk.loads(text).ranges()

    rows = [
        among_few_and_many("modes of scissors", modes, 64, 4096, rounds),
        among_few_and_many("ranges of scissors", ranges, 16, 128, rounds),
    ]
    return ReportTable("storeys", "an assembly of few and of many", COLUMNS, rows, ())


FIGURES = {
    f.__name__: f
    for f in (platform, million, verdicts, closing, wheels, threads, chains, loops, storeys)
}


def tables(names: list[str], rounds: int, count: int) -> Iterator[ReportTable]:
    for name in names or FIGURES:
        yield FIGURES[name](rounds, count)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", choices=[[], *FIGURES], metavar="NAME")
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--rows", type=int, default=ROWS, help="of platform and threads")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    options = parser.parse_args()
    found = tables(options.names, options.rounds, options.rows)
    if options.json:
        record = {"machine": machine()} | {table.name: table.record() for table in found}
        print(json_text(record), end="")
        return
    print(", ".join(f"{name} {value}" for name, value in machine().items()))
    for table in found:
        print(f"\n{plain_text(table)}", end="", flush=True)


if __name__ == "__main__":
    main()
