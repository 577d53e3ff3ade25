"""The parts of the benchmark in the order they are shown; each is computed when it is asked for."""

from __future__ import annotations

from collections.abc import Iterator

from mechkin_cli.benchmark import demand_steps, sweeps
from mechkin_cli.benchmark.report import Table
from mechkin_cli.benchmark.specimens import rcsr_specimen, sevenr_specimen
from mechkin_cli.benchmark.timing import ROUNDS

QUICK_ROUNDS = 5


def timing_tables(*, quick: bool = False) -> Iterator[Table]:
    """What a row costs, and what each part of the demand plan costs; `quick` in few rounds."""
    rounds = QUICK_ROUNDS if quick else ROUNDS
    for specimen in (rcsr_specimen(), sevenr_specimen()):
        yield sweeps.table(specimen, rounds)
        yield demand_steps.table(specimen, rounds)
