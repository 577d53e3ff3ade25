"""What double-double costs: `python -P tests/benchmark/double_double.py [ROWS [PAIRS]]`.

The kernel's run of everything on one thread, in doubles from second-order guesses and in
double-double from the states that it finds, at every width and in turns, by the thread's processor
time; medians of the times and of the pairs' ratios to doubles at the widest, with half the distance
between the ratios' quartiles.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import thread_time
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parents[2]))

from benchmark.kernel_case import KernelCase, PlannedRun, driven, repeated, sweep_rows
from benchmark.specimens import rcsr_specimen, sevenr_specimen

from mechkin_cli.kernel.functions import widths
from mechkin_cli.plan.outputs import Readout
from mechkin_cli.plan.records import Demand
from mechkin_cli.session.kernel_run import Ask, PreciseConstants, RowInputs, run


def seconds(work: Callable[[], Any]) -> float:
    before = thread_time()
    work()
    return thread_time() - before


class Case:
    """A specimen's rows with everything, as calls."""

    def __init__(self, specimen: Any, rows: int) -> None:
        case = KernelCase(specimen, sweep_rows(specimen))
        self.planned = PlannedRun(case, specimen.levels[2])
        self.inputs = repeated(case.inputs, rows)
        self.guess = repeated(case.second_order_guesses(), rows)
        rates, accelerations = driven(specimen, rows)
        self.rows = RowInputs(self.inputs, self.guess, rates, accelerations)
        readout = Readout(self.planned.outputs.outputs, self.planned.outputs.slots, ())
        self.ask = Ask(self.planned.demand, readout)
        self.closed = self.rows._replace(guess=self.doubles().states)

    def doubles(self) -> Any:
        return run(self.planned.plan, self.rows, self.ask, threads=1)

    def precise(self, lanes: int) -> Any:
        ask = self.ask._replace(demand=self.planned.demand & ~Demand.CONDITION)
        constants = PreciseConstants()
        return run(self.planned.plan, self.closed, ask, constants, lanes=lanes, threads=1)


def main(rows: int = 2048, pairs: int = 21) -> None:
    """Prints a line for each specimen and width of double-double."""
    for specimen in (rcsr_specimen(), sevenr_specimen()):
        case = Case(specimen, rows)
        for lanes in sorted({2, max(widths())}):
            if not case.precise(lanes).good.all():
                raise SystemExit(f"{specimen.name}: rows are not closed")
            precise = partial(case.precise, lanes)
            times = np.array([[seconds(case.doubles), seconds(precise)] for _ in range(pairs)])
            low, middle, high = np.percentile(times[:, 1] / times[:, 0], [25, 50, 75])
            one, other = np.median(times, axis=0) * 1e6
            print(
                f"{specimen.name}, {rows} rows: doubles {one:.0f} us, double-double at {lanes} "
                f"lanes {other:.0f} us, {middle:.1f} +- {(high - low) / 2:.1f} times"
            )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
