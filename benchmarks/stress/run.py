"""A stress test: all families, each with its tally."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from benchmarks.stress.forecast import Forecast
from benchmarks.stress.plan import tasks
from benchmarks.stress.tally import Tally
from benchmarks.stress.workers import results

FEW_ROWS = 20_000
"""Up to this many rows one process is done before others have started."""
Heard = Callable[[int, int, float | None], None]


def stress(
    rows: int,
    seed: int,
    families: Sequence[str],
    processes: int = 1,
    progress: Heard = lambda done, count, left: None,
) -> list[Tally]:
    """The tallies of the families, which depend on rows and seed alone; `progress` hears how many
    blocks of how many are done, and what is left in s as far as that is known."""
    blocks = tasks(rows, families)
    tallies = {name: Tally(name) for name in families}
    shared = processes if rows > FEW_ROWS else 1
    forecast = Forecast(blocks, shared)
    for count, done in enumerate(results(blocks, seed, shared), start=1):
        tallies[done.tally.family].merge(done.tally)
        forecast.done(done.task, done.seconds)
        progress(count, len(blocks), forecast.seconds)
    return [tally.in_order() for tally in tallies.values()]
