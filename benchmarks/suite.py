"""What is measured here: the known mechanisms by all families of methods, variants, responses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from benchmarks.peers import FAMILIES
from benchmarks.processes import process_table
from benchmarks.responses.table import response_table
from benchmarks.scenes import known_scenes, texts
from benchmarks.variant_table import variant_table
from mechkin_cli.bench.report import ReportTable
from mechkin_cli.bench.runs import Rounds, Suite, demand_table, setting_tables, thread_table
from mechkin_cli.bench.scene import BenchScene

COMMAND = "python -m benchmarks"

DEMAND_SCENES = ("RCSR", "7R", "Stewart")
"""Of the known mechanisms, those whose demand plan and threads are looked at."""

PROCESS_SCENES = ("RCSR", "7R")


def whole_tables(scenes: Sequence[BenchScene], rounds: Rounds) -> Iterator[ReportTable]:
    """What the settings of a run cost, variants and responses."""
    chosen = [scene for scene in scenes if scene.name in DEMAND_SCENES]
    yield from (demand_table(scene, rounds.fast) for scene in chosen)
    if rounds.slow > 1:
        for scene in scenes:
            if scene.name in PROCESS_SCENES:
                yield process_table(scene.name, texts()[scene.name](), rounds.slow)
    yield thread_table(chosen, rounds.slow)
    yield variant_table(rounds.slow)
    yield response_table(rounds.slow)


WHOLE = Suite(
    COMMAND, known_scenes, FAMILIES, whole_tables, "demand plan, threads, variants, responses"
)
OF_FILES = WHOLE._replace(tables=setting_tables, words="demand plan, threads")
"""The same of files, which have no variants and responses that others could be held against."""
