"""Run time against error: the kernel, the sweep, and what engineers do by hand."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from benchmark.accuracy import errors
from benchmark.arithmetic import Arithmetic, extended
from benchmark.closure import drawing, kinematics
from benchmark.exact import ExactSpecimen
from benchmark.kernel_case import (
    BATCH,
    SWEEP_ROWS,
    KernelCase,
    PlannedRun,
    degree_rows,
    repeated,
    sweep_rows,
)
from benchmark.peers import Closure, dense_loads, differences, fsolve_positions
from benchmark.reference import POSITIONS

from benchmarks.rcsr import Dimensions, dimensions
from mechkin_cli.bench.measurement import Timing, in_turns
from mechkin_cli.bench.report import Cell, ReportColumn, ReportTable

if TYPE_CHECKING:
    from mechkin_cli.show import Floats

BY_HAND_ROUNDS = 5
"""The peers in Python take a thousand times as long; they are timed in few rounds."""

COLUMNS = (
    ReportColumn("route", "route"),
    ReportColumn("microseconds", "us per\nrow", "time"),
    ReportColumn("spread", "+-\n%", "percent"),
    ReportColumn("ratio", "times\nkernel", "time"),
    ReportColumn("position", "error:\nposi-\ntion", "error"),
    ReportColumn("velocity", "velo-\ncity", "error"),
    ReportColumn("acceleration", "acceler-\nation", "error"),
    ReportColumn("loads", "\nloads", "error"),
)


@dataclass(frozen=True)
class Route:
    """A way to the answers: what is timed, for how many rows, and what it finds."""

    name: str
    call: Callable[[], object]
    rows: int
    found: dict[str, Any]
    exact: dict[str, Any]


NATIVE_NOTES = (
    f"kernel: {BATCH} rows a call, 1 degree apart, each predicted to second order.",
    f"sweep: {SWEEP_ROWS} rows; follow and run: the calls that analyze() makes of the kernel.",
)
BY_HAND_NOTES = (
    "differences: central ones, from three positions a row, instead of derivatives.",
    "dense 24x24 system: the loads alone, from an exact motion.",
)


def tables(rcsr: ExactSpecimen, sevenr: ExactSpecimen) -> Iterator[ReportTable]:
    """Times and errors of all routes: RCSR with what is done by hand, 7R without."""
    yield _table(rcsr, partial(_rcsr_routes, dimensions()), BY_HAND_NOTES)
    yield _table(sevenr, lambda specimen, case: [], ())


def _table(
    specimen: ExactSpecimen,
    peers: Callable[[ExactSpecimen, KernelCase], list[Route]],
    notes: tuple[str, ...],
) -> ReportTable:
    coarse = KernelCase(specimen, degree_rows(specimen))
    fine = KernelCase(specimen, sweep_rows(specimen))
    native = [*_kernel_routes(specimen, coarse), *_sweep_routes(specimen, fine)]
    by_hand = peers(specimen, coarse)
    times = in_turns({route.name: route.call for route in native})
    times |= in_turns({route.name: route.call for route in by_hand}, BY_HAND_ROUNDS)
    unit = next(route for route in native if route.name == "kernel, converged")
    rows = [
        _row(specimen, route, times[route.name], times[unit.name], unit.rows)
        for route in native + by_hand
    ]
    measure = f"errors in parts of the largest value; exact: {extended().name}."
    name, title = f"routes_{specimen.name.lower()}", f"run time against error, {specimen.name}"
    return ReportTable(
        name, f"{title}, one thread", COLUMNS, rows, (*NATIVE_NOTES, *notes, measure)
    )


def exact_solution(specimen: ExactSpecimen, case: KernelCase) -> dict[str, Any]:
    """The independent solution at a case's rows."""
    return specimen.solution(case.positions, [case.found[name] for name in specimen.coordinates])


def _row(
    specimen: ExactSpecimen, route: Route, time: Timing, unit: Timing, unit_rows: int
) -> dict[str, Cell]:
    found = errors(specimen, route.found, route.exact)
    return {
        "route": route.name,
        "microseconds": 1e6 * time.median / route.rows,
        "spread": time.spread,
        "ratio": (time.median / route.rows) / (unit.median / unit_rows),
        **vars(found),
    }


def _kernel_routes(specimen: ExactSpecimen, case: KernelCase) -> list[Route]:
    exact, guess = exact_solution(specimen, case), case.second_order_guesses()
    inputs, guesses = repeated(case.inputs), repeated(guess)
    everything, positions = (PlannedRun(case, specimen.levels[level]) for level in (2, 0))

    def route(name: str, planned: PlannedRun, iterations: int) -> Route:
        found = planned.quantities(planned(case.inputs, guess, iterations))
        call = partial(planned, inputs, guesses, iterations)
        return Route(name, call, BATCH, found, exact)

    return [
        route("kernel, 1 Newton step", everything, 1),
        route("kernel, 2 Newton steps", everything, 2),
        route("kernel, converged", everything, 6),
        route("kernel, positions only", positions, 6),
    ]


def _sweep_routes(specimen: ExactSpecimen, case: KernelCase) -> list[Route]:
    names = specimen.levels[2]
    exact, everything = exact_solution(specimen, case), PlannedRun(case, names)

    sweep = case.sweep(everything)
    analyze = partial(case.model.analyze, names)
    analysis = analyze()
    found = {name: analysis[name] for name in names}
    swept = everything.quantities(sweep())
    return [
        Route("sweep, follow and run", sweep, SWEEP_ROWS, swept, exact),
        Route("sweep, model.analyze()", analyze, SWEEP_ROWS, found, exact),
    ]


def _rcsr_routes(size: Dimensions, specimen: ExactSpecimen, case: KernelCase) -> list[Route]:
    """Differences of the kernel's positions, and what engineers do by hand."""
    exact, theta1 = exact_solution(specimen, case), case.positions
    d = drawing(size, _double())
    closure, start = Closure(d), np.array([case.found[name][0] for name in POSITIONS])
    solved = partial(fsolve_positions, closure, start=start)

    motion = kinematics(d, theta1, [case.found[name] for name in POSITIONS])
    loads = partial(dense_loads, size, d, motion)
    positions = dict(zip(POSITIONS, solved(theta1), strict=True))
    rows = theta1.size
    planned, guess = PlannedRun(case, POSITIONS), case.second_order_guesses()

    def shifted(theta1: Floats) -> Floats:
        batch = planned(np.ascontiguousarray(theta1[None, :]), repeated(guess, theta1.size))
        return np.stack([planned.quantities(batch)[name] for name in POSITIONS])

    return [
        Route(
            "kernel and differences",
            partial(differences, shifted, repeated(case.inputs)[0]),
            BATCH,
            differences(shifted, theta1),
            exact,
        ),
        Route("fsolve on 4x4 matrices", partial(solved, theta1), rows, positions, exact),
        Route(
            "fsolve and differences",
            partial(differences, solved, theta1),
            rows,
            differences(solved, theta1),
            exact,
        ),
        Route("dense 24x24 system", loads, rows, loads(), exact),
    ]


def _double() -> Arithmetic:
    return Arithmetic("double", 2.0**-52, np.float64, np.cos, np.sin)
