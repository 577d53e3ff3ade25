"""What a study has found, in a few numbers for each column."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mechkin_cli.studies.records import Heading, Records, numbers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.arrays import Floats


class Spread(NamedTuple):
    """Of a column of numbers: how many are found, the least and the largest and the variants that
    have them, mean and standard deviation."""

    label: str
    unit: str
    found: int
    least: float
    least_at: int
    largest: float
    largest_at: int
    mean: float
    deviation: float

    @property
    def shown(self) -> tuple[float, float, float, float]:
        """Least, mean and largest value, and the deviation."""
        return self.least, self.mean, self.largest, self.deviation


@dataclass
class _Column:
    """Sums about the first value, so that a narrow band far from zero keeps its digits."""

    count: int = 0
    finite: int = 0
    origin: float = 0.0
    first: float = 0.0
    second: float = 0.0
    least: tuple[float, int] = (np.inf, -1)
    largest: tuple[float, int] = (-np.inf, -1)
    infinite: float = 0.0

    def add(self, values: Floats, variants: NDArray[np.int64]) -> None:
        there = ~np.isnan(values)
        if not there.any():
            return
        values, variants = values[there], variants[there]
        low, high = int(values.argmin()), int(values.argmax())
        if values[low] < self.least[0]:
            self.least = float(values[low]), int(variants[low])
        if values[high] > self.largest[0]:
            self.largest = float(values[high]), int(variants[high])
        finite = values[np.isfinite(values)]
        if finite.size < values.size:
            # infinite of both signs have no mean
            self.infinite += float(np.unique(values[np.isinf(values)]).sum())
        if finite.size and not self.finite:
            self.origin = float(finite[0])
        off = finite - self.origin
        self.count += values.size
        self.finite += finite.size
        self.first += float(off.sum())
        self.second += float((off * off).sum())


class Overview(NamedTuple):
    """A study's variants: how many, how many have each verdict, and the spreads of columns."""

    variants: int
    verdicts: dict[str, int]
    spreads: tuple[Spread, ...]


def overview(
    pieces: Iterable[Records], headings: Sequence[Heading], number: str, verdict: str
) -> Overview:
    """The overview of a study's pieces; `number` and `verdict` are labels of columns."""
    columns = {h.label: _Column() for h in headings if h.kind == "number"}
    verdicts: dict[str, int] = {}
    variants = 0
    for records in pieces:
        variants += len(records[number])
        words, counts = np.unique(records[verdict].astype(str), return_counts=True)
        for word, count in zip(words.tolist(), counts.tolist(), strict=True):
            verdicts[word] = verdicts.get(word, 0) + count
        for label, column in columns.items():
            column.add(numbers(records[label]), np.asarray(records[number], dtype=np.int64))
    units = {heading.label: heading.unit for heading in headings}
    spreads = tuple(_spread(label, units[label], column) for label, column in columns.items())
    ordered = dict(sorted(verdicts.items(), key=lambda item: (-item[1], item[0])))
    return Overview(variants, ordered, spreads)


def _spread(label: str, unit: str, column: _Column) -> Spread:
    if not column.count:
        return Spread(label, unit, 0, np.nan, -1, np.nan, -1, np.nan, np.nan)
    if column.infinite != 0.0:
        ends = (*column.least, *column.largest)
        return Spread(label, unit, column.count, *ends, column.infinite, np.nan)
    mean = column.first / column.count
    variance = max(column.second / column.count - mean * mean, 0.0)
    return Spread(
        label,
        unit,
        column.count,
        *column.least,
        *column.largest,
        column.origin + mean,
        float(np.sqrt(variance)),
    )
