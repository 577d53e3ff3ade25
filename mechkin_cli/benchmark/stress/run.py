"""A stress test: all families, each with its tally."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from mechkin_cli.benchmark.stress.plan import tasks
from mechkin_cli.benchmark.stress.tally import Tally
from mechkin_cli.benchmark.stress.workers import results

FEW_ROWS = 20_000
"""Up to this many rows one process is done before others have started."""


def stress(
    rows: int,
    seed: int,
    families: Sequence[str],
    processes: int = 1,
    progress: Callable[[int, int], None] = lambda done, count: None,
) -> list[Tally]:
    """The tallies of the families, which depend on rows and seed alone; `progress` hears how many
    blocks of how many are done."""
    blocks = list(tasks(rows, families))
    tallies = {name: Tally(name) for name in families}
    shared = processes if rows > FEW_ROWS else 1
    for count, tally in enumerate(results(blocks, seed, shared), start=1):
        tallies[tally.family].merge(tally)
        progress(count, len(blocks))
    return [tally.in_order() for tally in tallies.values()]
