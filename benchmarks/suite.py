"""What is measured here: the known mechanisms by all families of methods, variants, responses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from benchmarks.peers import FAMILIES
from benchmarks.responses.table import response_table
from benchmarks.scenes import subjects
from benchmarks.variant_table import variant_table
from mechkin_cli.bench.report import ReportTable
from mechkin_cli.bench.runs import Rounds, Suite, setting_tables
from mechkin_cli.bench.scene import Subject
from mechkin_cli.bench.settings import demand_table, process_table, thread_table

COMMAND = "python -m benchmarks"

DEMAND_SCENES = ("RCSR", "7R", "Stewart")
"""Of the known mechanisms, those whose demand plan and threads are looked at."""

PROCESS_SCENES = ("RCSR", "7R")


def whole_tables(subjects: Sequence[Subject], rounds: Rounds) -> Iterator[ReportTable]:
    """What the settings of a run cost, variants and responses."""
    chosen = [subject for subject in subjects if subject.name in DEMAND_SCENES]
    for subject in chosen:
        yield demand_table(subject, rounds.fast, rounds.processes)
    if rounds.processes:
        for subject in subjects:
            if subject.name in PROCESS_SCENES:
                yield process_table(subject, rounds.processes)
    yield thread_table([subject.scene for subject in chosen], rounds.slow)
    yield variant_table(rounds.slow)
    yield response_table(rounds.slow)


WHOLE = Suite(
    COMMAND, subjects, FAMILIES, whole_tables, "demand plan, threads, variants, responses"
)
OF_FILES = WHOLE._replace(tables=setting_tables, words="demand plan, threads")
"""The same of files, which have no variants and responses that others could be held against."""
