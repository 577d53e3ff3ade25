"""How long a stress test will take, by the blocks of it that are done."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from benchmarks.stress.families.table import FAMILIES
from benchmarks.stress.plan import Task


class Forecast:
    """What is left, by the time that the rows of each family have taken so far."""

    def __init__(self, tasks: Iterable[Task], processes: int) -> None:
        self.processes = processes
        self._left: Counter[str] = Counter()
        for task in tasks:
            self._left[task.family] += _rows(task)
        self._done: Counter[str] = Counter()
        self._took: dict[str, float] = {}

    def done(self, task: Task, seconds: float) -> None:
        """Takes note of a block."""
        self._left[task.family] -= _rows(task)
        self._done[task.family] += _rows(task)
        self._took[task.family] = self._took.get(task.family, 0.0) + seconds

    @property
    def seconds(self) -> float | None:
        """What is left; None as long as there is a family of which nothing is known."""
        total = 0.0
        for family, rows in self._left.items():
            if rows and not self._done[family]:
                return None
            if rows:
                total += rows * self._took[family] / self._done[family]
        return total / self.processes


def _rows(task: Task) -> int:
    family = FAMILIES[task.family]
    return sum(family.rows_of(number) for number in task.numbers)
