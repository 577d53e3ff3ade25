"""What threads gain over rows: `python tests/benchmark/thread_gain.py [ROWS [PAIRS]]`.

The kernel's run of everything, one thread against all, in interleaved pairs; medians of the times
and of the pairs' ratios. `threshold` looks for the rows from which two threads pay.
"""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parents[2]))

from benchmark.kernel_case import KernelCase, PlannedRun, driven, repeated, sweep_rows
from benchmark.specimens import rcsr_specimen, sevenr_specimen

from mechkin_cli.kernel import _kernel
from mechkin_cli.plan.outputs import Readout
from mechkin_cli.session.kernel_run import Ask, RowInputs, run


def timed(planned: PlannedRun, inputs: Any, guess: Any, threads: int, repeats: int = 1) -> float:
    """Seconds of one run."""
    rates, accelerations = driven(planned.specimen, inputs.shape[1])
    before = perf_counter()
    for _ in range(repeats):
        run(
            planned.plan,
            RowInputs(inputs, guess, rates, accelerations),
            Ask(planned.demand, Readout(planned.outputs.outputs, planned.outputs.slots, ())),
            threads=threads,
        )
    return (perf_counter() - before) / repeats


def main(rows: int = 100_000, pairs: int = 21) -> None:
    """Prints a line for each specimen and number of rows."""
    processors = _kernel.available_processors()
    for specimen in (rcsr_specimen(), sevenr_specimen()):
        case = KernelCase(specimen, sweep_rows(specimen))
        planned = PlannedRun(case, specimen.levels[2])
        for count in (128, 256, 512, 1024, 2048, rows):
            inputs = repeated(case.inputs, count)
            guess = repeated(case.second_order_guesses(), count)
            repeats = max(1, 20_000 // count)
            timed(planned, inputs, guess, processors)
            times = [
                [timed(planned, inputs, guess, threads, repeats) for threads in (1, processors)]
                for _ in range(pairs)
            ]
            one, all_of_them = (median(column) for column in np.transpose(times).tolist())
            gain = median(single / many for single, many in times)
            print(
                f"{specimen.name:5} {count:7} rows  1 thread {one / count * 1e6:6.3f} us/row  "
                f"{processors} threads {all_of_them / count * 1e6:6.3f} us/row  gain {gain:.2f}"
            )


if __name__ == "__main__":
    main(*(int(argument) for argument in sys.argv[1:]))
