"""Responses: error against evaluations, and what lanes and friction cost; medians, in turns.

    python -P tests/benchmark/responses.py [--rounds N] [--variants N] [--json] [FIGURE ...]

Figures: speed, accuracy (steps by tolerance), slopes (equal steps, for the orders of both
integrators), lanes, friction; without names all of them.

Times are those of the kernel's call alone, on one thread by its processor time; run it on an
otherwise idle machine. The yardstick of the same run is one row of RCSR with all that its loads
need, in a kernel call of 2048 rows.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parents[1]))

from benchmark.accuracy import relative_error
from benchmark.kernel_case import (
    BATCH,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
)
from benchmark.specimens import rcsr_specimen
from references import exact

import mechkin_cli as mk
from benchmarks import sevenr
from mechkin_cli.bench.measurement import in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable, machine, plain_text
from mechkin_cli.record import replace
from mechkin_cli.response.integration import integrate
from mechkin_cli.response.report import MotionRows
from mechkin_cli.response.rows import Prepared
from mechkin_cli.response.runs import prepare, read
from mechkin_cli.response.stretches import gathered
from mechkin_cli.session.kernel_run import Ask, RowInputs
from mechkin_cli.session.session import Packing, Session
from mechkin_cli.show import Floats
from mechkin_cli.sweep.sweep import analyze, at_once
from mechkin_cli.tables.json import json_text

MECHANISMS = HERE.parents[1] / "mechanisms"
ROUNDS = 11
VARIANTS = 1000
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
REFERENCE = 1e-13
AUTOMATIC, EXPLICIT, IMPLICIT = range(3)
LEAST_GAIN, MOST_FRICTION = 4.0, 3.0
SOLVED = 1e-10
ASKED = 1e-7
"""The tolerance of the times that are asked for."""

MOST_RCSR, MOST_7R = 0.15, 0.5
"""ms for 2 s of response."""

EQUAL_STEPS = {
    "explicit": (0.05, 0.025, 0.0125),
    "implicit": (0.005, 0.0025),
}
"""Of the double pendulum, s."""

DOUBLE_PENDULUM = """format: 1
name: double pendulum
units: {angle: rad}
links:
  upper: {mass: 1, center_of_mass: [0.5, 0, 0], inertia: {xx: 0.001, yy: 0.08, zz: 0.08}}
  lower: {mass: 1, center_of_mass: [1.5, 0, 0], inertia: {xx: 0.001, yy: 0.08, zz: 0.08}}
joints:
  A: {type: R, links: [ground, upper], point: [0, 0, 0], axis: [0, 1, 0]}
  B: {type: R, links: [upper, lower], point: [1, 0, 0], axis: [0, 1, 0]}
loads: [{type: gravity, g: [0, 0, -9.81]}]
responses:
  run: {start: {A.theta: 0, B.theta: 0.5}, time: {from: 0, to: 3, step: 0.25}}
"""

SPRING_DAMPER = """format: 1
name: stiff spring and damper
links: {block: {mass: 1, center_of_mass: [0, 0, 0]}}
joints: {S: {type: P, links: [ground, block], point: [0, 0, 0], axis: [1, 0, 0]}}
loads:
  - {type: spring, joint: S, coordinate: s, stiffness: 8e5}
  - {type: damper, joint: S, coordinate: s, damping: 4e4}
responses:
  run: {start: {S.s: 0.001}, time: {from: 0, to: 0.2, step: 0.02}}
"""
SLIDER_CRANK = """format: 1
name: slider-crank
links:
  crank: {mass: 0.5, center_of_mass: [0.02, 0, 0], inertia: {xx: 1e-4, yy: 2e-4, zz: 2e-4}}
  rod: {mass: 0.8, center_of_mass: [0.09, 0, 0], inertia: {xx: 2e-4, yy: 1.5e-3, zz: 1.5e-3}}
  piston: {mass: 1.2, center_of_mass: [0.18, 0, 0], inertia: {xx: 3e-4, yy: 3e-4, zz: 3e-4}}
joints:
  A: {type: R, links: [ground, crank], point: [0, 0, 0], axis: [0, 0, 1]}
  B: {type: C, links: [crank, rod], point: [0.04, 0, 0], axis: [0, 0, 1]}
  C: {type: S, links: [rod, piston], point: [0.18, 0, 0]}
  D: {type: P, links: [ground, piston], point: [0.18, 0, 0], axis: [1, 0, 0]}
motion: {inputs: {A.theta: {from: 10 deg, to: 370 deg, count: 361, rate: 20 rad/s}}}
loads:
  - {type: gravity, g: [0, -9.81, 0]}
  - {type: force, link: piston, point: [0.18, 0.003, 0.012], force: [-300, 0, 40]}
  - {type: friction, joint: A, coefficient: 0.12, radius: 0.008, length: 0.06}
  - {type: friction, joint: D, coefficient: 0.08, length: 0.07, width: 0.04, across: [0, 0, 1]}
  - {type: friction, joint: B, coefficient: 0.1, radius: 0.006, length: 0.03}
  - {type: friction, joint: C, coefficient: 0.15, radius: 0.005}
"""
RCSR_RUBBING = """
  - {type: friction, joint: O1, coefficient: 0.1, radius: 0.1, length: 1, collar: 0.15}
  - {type: friction, joint: O2, coefficient: 0.1, radius: 0.1, length: 1}
  - {type: friction, joint: O3, coefficient: {static: 0.15, sliding: 0.1, speed: 1}, radius: 0.1}
  - {type: friction, joint: O4, coefficient: 0.1, radius: 0.1, length: 1, collar: 0.15}
"""
STIFFNESS, DAMPING, STRETCHED = 8e5, 4e4, 1e-3

COLUMNS = (
    ReportColumn("case", "case"),
    ReportColumn("tolerance", "tole-\nrance", "error"),
    ReportColumn("evaluations", "evalu-\nations", "number"),
    ReportColumn("steps", "steps", "number"),
    ReportColumn("error", "largest\nerror", "error"),
    ReportColumn("energy", "energy\nerror", "error"),
    ReportColumn("time", "time\nms", "time"),
    ReportColumn("rows", "in rows", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
)
SLOPES = (
    ReportColumn("case", "case"),
    ReportColumn("step", "step\nms", "number"),
    ReportColumn("evaluations", "evalu-\nations", "number"),
    ReportColumn("error", "largest\nerror", "error"),
    ReportColumn("order", "order", "ratio"),
    ReportColumn("digits", "right digits"),
)
COSTS = (
    ReportColumn("case", "case"),
    ReportColumn("value", "value", "time"),
    ReportColumn("unit", "unit"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("limit", "asked", "time"),
    ReportColumn("met", "met", "verdict"),
)


@dataclass(frozen=True)
class Case:
    """A response of a file, and what of it is held against `known` values, in the file's units."""

    name: str
    text: str
    coordinate: str
    tolerances: tuple[float, ...]
    methods: Mapping[str, int]
    known: Callable[[Case], Floats]

    @cached_property
    def prepared(self) -> Prepared:
        problem = mk.loads(self.text, self.name).problem
        (response,) = problem.responses.values()
        return prepare(problem, response)

    def integrate(
        self,
        tolerance: float,
        method: int = AUTOMATIC,
        starts: int = 1,
        fixed_step: float | None = None,
    ) -> list[MotionRows]:
        """The kernel's call alone, on one thread, for so many variants."""
        one = self.prepared
        assert one.begun is not None
        begun, times = one.begun, one.response.moments.values
        return integrate(
            [(one.free.plan, begun)] * starts,
            float(times[0]),
            times,
            replace(one.response, tolerance=tolerance, fixed_step=fixed_step),
            stops=(),
            packing=Packing(0, 1),
            method=method,
        )

    def answer(self, found: MotionRows) -> tuple[Floats, float]:
        """The coordinate over the rows, and the largest energy error."""
        result = gathered(self.prepared, Packing(0, 1), found)
        read(result, [self.coordinate, "row.energy_error"])
        lost = np.asarray(result.quantity("row.energy_error").value)
        quantity = result.quantity(self.coordinate)
        written = result.units.from_si(np.array(quantity.value), quantity.dimension)
        return written, float(np.max(np.abs(lost)))


def of_rcsr(_: Case) -> Floats:
    return np.array(exact("rcsr_response")["theta1"][::10], dtype=float)


def of_itself(case: Case) -> Floats:
    """With the tightest steps."""
    (found,) = case.integrate(REFERENCE)
    return case.answer(found)[0]


def of_spring(case: Case) -> Floats:
    """x0 (f e^(s t) - s e^(f t))/(f - s) with the slow and fast roots s, f of x^2 + c x + k."""
    root = np.sqrt(DAMPING * DAMPING / 4 - STIFFNESS)
    fast = -DAMPING / 2 - root
    slow = STIFFNESS / fast
    t = case.prepared.response.moments.values
    return STRETCHED * (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow)


def cases() -> tuple[Case, ...]:
    rcsr = (MECHANISMS / "dissertation" / "rcsr_response.yaml").read_text(encoding="utf-8")
    rcsr = rcsr[: rcsr.index("\ntables:")].replace("step: 0.1}", "step: 1}")
    both = {"explicit": EXPLICIT, "implicit": IMPLICIT}
    return (
        Case("RCSR", rcsr, "O1.theta", TOLERANCES, {"": AUTOMATIC}, of_rcsr),
        Case("double pendulum", DOUBLE_PENDULUM, "B.theta", TOLERANCES[:4], both, of_itself),
        Case("spring-damper", SPRING_DAMPER, "S.s", (1e-6, 1e-7, 1e-8), both, of_spring),
    )


def loops() -> dict[str, tuple[Case, float | None]]:
    """Responses of 2 s whose times are told, with what is asked of them, ms."""
    free, falling = (
        Case("7R", sevenr_response(falls), "J1.theta", (ASKED,), {"": AUTOMATIC}, of_itself)
        for falls in (False, True)
    )
    return {
        "RCSR": (cases()[0], MOST_RCSR),
        "7R, at 1 rad/s without gravity": (free, MOST_7R),
        "7R, falling": (falling, None),
    }


def sevenr_response(falls: bool) -> str:
    """The general 7R loop, let go at a rate."""
    links = sevenr.text().partition("motion:")[0]
    gravity = f"loads: [{{type: gravity, g: {list(sevenr.GRAVITY)}}}]\n" if falls else ""
    start = "start: {J1.theta: 0, J1.theta_dot: 1}"
    return f"{links}{gravity}responses:\n  run: {{{start}, time: {{from: 0, to: 2, step: 1}}}}\n"


def speed(rounds: int, _: int) -> ReportTable:
    """The kernel's time of whole responses at the tolerance that is asked for."""
    known = loops()
    times = in_turns(
        {name: partial(case.integrate, ASKED) for name, (case, _) in known.items()}, rounds
    )
    lines = []
    for name, (case, limit) in known.items():
        evaluations = case.integrate(ASKED)[0].report.evaluations
        text = f"{name}: {evaluations} evaluations"
        lines.append(cost(text, 1e3 * times[name].median, "ms", times[name].spread, limit=limit))
    return ReportTable("speed", f"2 s of response, tolerance {ASKED:g}", COSTS, lines, ())


def yardstick() -> Callable[[], object]:
    """A kernel call of `BATCH` rows of RCSR with everything."""
    specimen = rcsr_specimen()
    case = KernelCase(specimen, degree_rows(specimen))
    planned = PlannedRun(case, specimen.levels[2])
    return partial(planned, repeated(case.inputs), repeated(case.second_order_guesses()))


def accuracy(rounds: int, _: int) -> ReportTable:
    """Error against evaluations."""
    lines = [line for case in cases() for line in accuracy_of(case, rounds)]
    note = "time also in rows of RCSR with all that its tables may ask, in calls of 2048"
    return ReportTable("accuracy", "responses: error against work", COLUMNS, lines, (note,))


def accuracy_of(case: Case, rounds: int) -> Iterator[dict[str, Cell]]:
    """A line for each method and tolerance."""
    asked = [(name, t) for name in case.methods for t in case.tolerances]
    calls = {(name, t): partial(case.integrate, t, case.methods[name]) for name, t in asked} | {
        ("row", 0.0): yardstick()
    }
    times, known = in_turns(calls, rounds), case.known(case)
    for name, tolerance in asked:
        (found,) = case.integrate(tolerance, case.methods[name])
        values, lost = case.answer(found)
        time = times[name, tolerance]
        yield {
            "case": f"{case.name} {name}".strip(),
            "tolerance": tolerance,
            "evaluations": found.report.evaluations,
            "steps": found.report.steps,
            "error": relative_error(values, known),
            "energy": lost,
            "time": 1e3 * time.median,
            "rows": time.ratio(times["row", 0.0], 1.0 / BATCH),
            "spread": time.spread,
        }


def slopes(_: int, __: int) -> ReportTable:
    """Error against evaluations in equal steps, and by which power of the step it falls."""
    case = cases()[1]
    known = case.known(case)
    lines = []
    for name, steps in EQUAL_STEPS.items():
        before = None
        for step in steps:
            # the tolerance is that of solving the implicit stages
            (found,) = case.integrate(SOLVED, case.methods[name], fixed_step=step)
            error = relative_error(case.answer(found)[0], known)
            lines.append(
                {
                    "case": f"{case.name} {name}",
                    "step": 1e3 * step,
                    "evaluations": found.report.evaluations,
                    "error": error,
                    "order": None if before is None else float(np.log2(before / error)),
                    "digits": "#" * max(0, round(-2.0 * np.log10(error))),
                }
            )
            before = error
    note = "order: power of the step in the error; DOP853 has 8, Radau IIA 5; ## is a right digit"
    return ReportTable(
        "slopes", "responses: error against work in equal steps", SLOPES, lines, (note,)
    )


def lanes(rounds: int, variants: int) -> ReportTable:
    """What a variant costs among many, against one alone."""
    lines = []
    for case in cases()[:2]:
        calls = {count: partial(case.integrate, 1e-10, starts=count) for count in (1, variants)}
        times = in_turns(calls, rounds)
        one, each = times[1], times[variants]
        lines += [
            cost(f"{case.name}, alone", 1e6 * one.median, "us", one.spread),
            cost(f"one of {variants}", 1e6 * each.median / variants, "us", each.spread),
            cost("alone over one of many", one.ratio(each, 1.0 / variants), least=LEAST_GAIN),
        ]
    return ReportTable("lanes", f"{variants} variants in lanes, tolerance 1e-10", COSTS, lines, ())


def friction(rounds: int, _: int) -> ReportTable:
    """A sweep's row with friction in its joints against the same without."""
    calls = {name: sweep_call(*case) for name, case in sweep_cases().items()}
    times = in_turns(calls, rounds)
    lines = [cost(name, 1e6 * t.median / BATCH, "us a row", t.spread) for name, t in times.items()]
    for name in calls:
        own, _, where = name.partition(", ")
        if where != "none":
            ratio = times[name].ratio(times[f"{own}, none"])
            lines.append(cost(f"{name} over none", ratio, limit=MOST_FRICTION))
    return ReportTable("friction", "sweep with friction", COSTS, lines, ())


def cost(
    case: str,
    value: float,
    unit: str = "times",
    spread: float | None = None,
    limit: float | None = None,
    least: float | None = None,
) -> dict[str, Cell]:
    """A line of a table; at most `limit` or at least `least` is asked."""
    met = None if limit is None and least is None else value <= (limit or value)
    if least is not None:
        met = value >= least
    asked = limit if least is None else least
    return {
        "case": case,
        "value": value,
        "unit": unit,
        "spread": spread,
        "limit": asked,
        "met": met,
    }


def sweep_cases() -> dict[str, tuple[str, str]]:
    """Mechanisms without redundant constraints and the effort asked for: a slider-crank without
    friction, with it at two joints and at all four, and RCSR without and with it at all four."""
    lines = SLIDER_CRANK.splitlines(keepends=True)
    rubbing = [line for line in lines if "friction" in line]
    bare = "".join(line for line in lines if line not in rubbing)
    rcsr = (
        (MECHANISMS / "dissertation" / "rcsr.yaml")
        .read_text(encoding="utf-8")
        .partition("\ntables:")[0]
        .rstrip()
    )
    return {
        "crank, none": (bare, "A.effort"),
        "crank, two joints": (bare + "".join(rubbing[:2]), "A.effort"),
        "crank, four": (bare + "".join(rubbing), "A.effort"),
        "RCSR, none": (rcsr, "O1.effort"),
        "RCSR, four": (rcsr + RCSR_RUBBING, "O1.effort"),
    }


def sweep_call(text: str, effort: str) -> Callable[[], object]:
    """The kernel's run of `BATCH` rows with the input's effort, verdicts included."""
    result = analyze(Session.of(mk.loads(text).problem), [effort])
    known, session = result.problem.quantities(), result.session
    wanted, demand = at_once(session, [known[effort]], verdicts=True)
    wanted += result.friction.beside(result.problem, wanted, demand)
    inputs = session.inputs
    rows = RowInputs(
        repeated(inputs.reduced),
        repeated(result.row_states.states),
        repeated(inputs.rates),
        repeated(inputs.accelerations),
    )
    ask = Ask(demand, session.readout(wanted))
    return partial(session.packed(Packing(0, 1)).run, rows, ask)


FIGURES = {f.__name__: f for f in (speed, accuracy, slopes, lanes, friction)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    parser.add_argument("--variants", type=int, default=VARIANTS)
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.add_argument("figures", nargs="*", metavar="FIGURE", help=", ".join(FIGURES))
    options = parser.parse_args()
    unknown = [name for name in options.figures if name not in FIGURES]
    if unknown:
        parser.error(f"unknown figure {unknown[0]}; figures are {', '.join(FIGURES)}")
    wanted = [FIGURES[name] for name in options.figures or FIGURES]
    found = (figure(options.rounds, options.variants) for figure in wanted)
    if options.json:
        record = {"machine": machine()} | {table.name: table.record() for table in found}
        print(json_text(record), end="")
        return
    print(", ".join(f"{name} {value}" for name, value in machine().items()))
    for table in found:
        print(f"\n{plain_text(table)}", end="", flush=True)


if __name__ == "__main__":
    main()
