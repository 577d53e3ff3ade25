"""The parts of the benchmark in the order they are shown; each is computed when it is asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from subprocess import CalledProcessError

from mechkin_cli.benchmark import demand_steps, routes, stress, targets
from mechkin_cli.benchmark.report import Table
from mechkin_cli.benchmark.specimens import rcsr_specimen, sevenr_specimen
from mechkin_cli.benchmark.yardstick import Yardstick, load

RCSR_FILE = Path("mechanisms") / "rcsr.yaml"


def timing_tables(folder: Path | None, say: Callable[[str], None]) -> Iterator[Table]:
    """Routes, demand plan, and the targets as far as their programs are there.

    Args:
        folder: the yardstick's folder, None to look for it.
        say: told what is left out and why.

    Raises:
        UsageError: no yardstick in the folder given.
    """
    yardstick = load(folder)
    specimens = (rcsr_specimen(), sevenr_specimen())
    yield from routes.tables(*specimens)
    yield from map(demand_steps.table, specimens)
    if not isinstance(yardstick, Yardstick):
        say(f"left out: {yardstick}")
        return
    with yardstick:
        for specimen in specimens:
            yield targets.table(specimen, yardstick)
    yield from _process_table(yardstick.folder, say)


def _process_table(folder: Path, say: Callable[[str], None]) -> Iterator[Table]:
    """The whole process, if the mechanism's file is there."""
    rcsr = folder.parents[2] / RCSR_FILE
    if not rcsr.is_file():
        say(f"left out: no whole processes, {rcsr} is not there")
        return
    try:
        yield targets.process_table(rcsr)
    except CalledProcessError as error:
        say(f"left out: no whole processes, {error}")


def stress_tables() -> Iterator[Table]:
    """Sizes and distances to the dead centre."""
    return stress.tables()
