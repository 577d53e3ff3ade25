"""Which mechanisms a run takes: the rows are shared among the families."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from mechkin_cli.benchmark.stress.families.table import FAMILIES

BLOCK_ROWS = 4000
"""Rows of a block: arrays of this length stay in the cache, and calls on them cost little."""
BLOCK_MECHANISMS = 100


class Task(NamedTuple):
    """One block: mechanisms of one make of a family, by their numbers."""

    family: str
    numbers: tuple[int, ...]


def tasks(rows: int, families: Sequence[str]) -> Iterator[Task]:
    """Blocks of about `rows` rows in all, at least one mechanism of each make."""
    shared = [name for name in families if not FAMILIES[name].lengths]
    share = rows // max(len(shared), 1)
    for name in families:
        family = FAMILIES[name]
        if family.lengths:
            fitting = [k for k, length in enumerate(family.lengths) if length <= max(rows, 1000)]
            yield from (Task(name, (k,)) for k in fitting)
            continue
        makes = len(family.makes)
        count = max(share // family.rows, makes)
        for make in range(makes):
            numbers = range(make, count, makes)
            size = max(min(BLOCK_ROWS // family.rows, BLOCK_MECHANISMS), 1)
            for first in range(0, len(numbers), size):
                yield Task(name, tuple(numbers[first : first + size]))
