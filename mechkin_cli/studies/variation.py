"""Which variants a study has: values of parameters by the number of the variant.

Variants are all combinations of the lists, of the lines of a table and of the samples. Of the
numbers, those of samples change fastest, then the table's, then the last list's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import prod
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats
    from mechkin_cli.studies.draws import Draws

Distribution = Callable[["Floats"], "Floats"]
"""From samples (n,) between 0 and 1 to values (n,)."""


@dataclass(frozen=True)
class Samples:
    """What is drawn: how many samples, and the distribution of each parameter, in order of the
    dimensions."""

    count: int
    draws: Draws
    distributions: Mapping[str, Distribution]


@dataclass(frozen=True)
class Variation:
    """The variants of a study.

    Attributes:
        lists: values (n,) of a parameter, by name.
        together: lists go step by step, and have one length; else each with each.
        table: lines of values (n,), by name.
        samples: what is drawn.
    """

    lists: Mapping[str, Floats] = field(default_factory=dict)
    together: bool = False
    table: Mapping[str, Floats] = field(default_factory=dict)
    samples: Samples | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters that vary."""
        drawn = self.samples.distributions if self.samples is not None else {}
        return (*self.lists, *self.table, *drawn)

    @property
    def counts(self) -> tuple[int, int, int]:
        """Combinations of the lists, lines of the table, samples."""
        lengths = [len(values) for values in self.lists.values()]
        combinations = (lengths[0] if lengths else 1) if self.together else prod(lengths)
        lines = len(next(iter(self.table.values()))) if self.table else 1
        return combinations, lines, 1 if self.samples is None else self.samples.count

    def __len__(self) -> int:
        return prod(self.counts)

    def values(self, begin: int, end: int) -> dict[str, Floats]:
        """Values of variants `begin` to `end` (without it), (variants,) by name."""
        _, lines, samples = self.counts
        numbers = np.arange(begin, end, dtype=np.int64)
        of_samples, rest = numbers % samples, numbers // samples
        of_lines, of_lists = rest % lines, rest // lines
        found = self._listed(of_lists)
        found |= {name: values[of_lines] for name, values in self.table.items()}
        return found | self._drawn(of_samples)

    def _listed(self, numbers: NDArray[np.int64]) -> dict[str, Floats]:
        if self.together:
            return {name: values[numbers] for name, values in self.lists.items()}
        found: dict[str, Floats] = {}
        for name, values in reversed(list(self.lists.items())):
            found[name] = values[numbers % len(values)]
            numbers = numbers // len(values)
        return {name: found[name] for name in self.lists}

    def _drawn(self, numbers: NDArray[np.int64]) -> dict[str, Floats]:
        if self.samples is None or not numbers.size:
            return {}
        first, last = int(numbers.min()), int(numbers.max()) + 1
        drawn = self.samples.draws.stretch(first, last)[numbers - first]
        distributions = self.samples.distributions
        return {n: shape(drawn[:, k]) for k, (n, shape) in enumerate(distributions.items())}
