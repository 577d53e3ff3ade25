"""Which mechanisms a run takes: the rows are shared among the families."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.family import Family

BLOCK_ROWS = 4000
"""Rows of a block: arrays of this length stay in the cache, and calls on them cost little."""
BLOCK_MECHANISMS = 100


class Task(NamedTuple):
    """One block: mechanisms of one make of a family, by their numbers."""

    family: str
    numbers: tuple[int, ...]


def tasks(rows: int, families: Sequence[str]) -> list[Task]:
    """Blocks of about `rows` rows in all, at least one mechanism of each make.

    The longest come first, so that no process is left alone with one at the end; then all families
    go forward together, so that what is done tells what is left.
    """
    chosen = [FAMILIES[name] for name in families]
    weights = sum(family.weight for family in chosen if not family.lengths)
    long, shared = [], []
    for family in chosen:
        if family.lengths:
            fitting = [k for k, length in enumerate(family.lengths) if length <= max(rows, 1000)]
            long += [Task(family.name, (k,)) for k in reversed(fitting)]
        else:
            shared.append(list(_blocks(family, int(rows * family.weight / weights))))
    mixed = [task for turn in zip_longest(*shared) for task in turn if task is not None]
    return long + mixed


def _blocks(family: Family, rows: int) -> Iterator[Task]:
    makes = len(family.makes)
    count = max(rows // family.rows, makes)
    size = max(min(BLOCK_ROWS // family.rows, BLOCK_MECHANISMS), 1)
    for make in range(makes):
        numbers = range(make, count, makes)
        for first in range(0, len(numbers), size):
            yield Task(family.name, tuple(numbers[first : first + size]))
