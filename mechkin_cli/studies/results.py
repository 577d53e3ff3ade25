"""Results of a study: an overview in a few numbers for each column, and all in memory."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.arguments import a_text
from mechkin_cli.diagnostics import LONGEST_NAME, Diagnostic, UsageError, nearest_hint
from mechkin_cli.record import NamedTuple, dataclass
from mechkin_cli.show import Floats, Listed, Listing
from mechkin_cli.studies.chunk import VARIANT, VERDICTS
from mechkin_cli.studies.folder import ROWS, VARIANTS
from mechkin_cli.studies.formats import LINES_AT_ONCE, Records, Values, joined, numbers
from mechkin_cli.tables import Heading

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray


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
class _RunningColumn:
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

    def listing(self, name: str) -> Listing:
        """The overview of a study of some name as a table."""
        rows = tuple(
            (
                s.label,
                s.unit,
                *(f"{value:.6g}" for value in (s.least, s.mean, s.largest, s.deviation)),
            )
            for s in self.spreads
        )
        verdicts = ", ".join(f"{count} {word}" for word, count in self.verdicts.items())
        labels = ("column", "unit", "least", "mean", "largest", "deviation")
        return Listing(f"{name}: {self.variants} variants, {verdicts}", labels, rows)


class RunningOverview:
    """The overview of a study's variants as stretches of them come.

    Args:
        headings: of the variants.
        number: the label of their numbers.
        verdict: the label of their verdicts.
    """

    def __init__(self, headings: Sequence[Heading], number: str, verdict: str) -> None:
        self.number, self.verdict = number, verdict
        self.units = {h.label: h.unit for h in headings if h.kind == "number"}
        self._columns = {label: _RunningColumn() for label in self.units}
        self._verdicts: dict[str, int] = {}
        self._variants = 0

    def add(self, records: Records) -> None:
        """Some variants more, in order: sums are rounded as their stretches have it."""
        self._variants += len(records[self.number])
        words, counts = np.unique(records[self.verdict].astype(str), return_counts=True)
        for word, count in zip(words.tolist(), counts.tolist(), strict=True):
            self._verdicts[word] = self._verdicts.get(word, 0) + count
        variants = np.asarray(records[self.number], dtype=np.int64)
        for label, column in self._columns.items():
            column.add(numbers(records[label]), variants)

    def overview(self) -> Overview:
        """Of the variants so far."""
        spreads = tuple(_spread(label, self.units[label], c) for label, c in self._columns.items())
        ordered = dict(sorted(self._verdicts.items(), key=lambda item: (-item[1], item[0])))
        return Overview(self._variants, ordered, spreads)


class GatheredOverview:
    """The overview of a study's pieces in whatever order they come, as their file will give it.

    Args:
        running: of none yet.
        begin: the number of the first variant.
    """

    def __init__(self, running: RunningOverview, begin: int) -> None:
        self._running, self._next = running, begin
        self._labels = [running.number, running.verdict, *running.units]
        self._early: dict[int, Records] = {}
        self._held: list[Records] = []

    def put(self, begin: int, records: Records) -> None:
        """A piece, the first of its variants with the number `begin`."""
        self._early[begin] = {label: records[label] for label in self._labels}
        while self._next in self._early:
            found = self._early.pop(self._next)
            self._held.append(found)
            self._next += len(found[self._running.number])
        lines = sum(len(records[self._running.number]) for records in self._held)
        while lines >= LINES_AT_ONCE:
            self._take(LINES_AT_ONCE)
            lines -= LINES_AT_ONCE

    def _take(self, lines: int) -> None:
        """Adds the first of the lines that are held: as many as are read of a file at a time."""
        whole = joined(self._held)
        stretch = {label: values[:lines] for label, values in whole.items()}
        for label in self._running.units:
            # a file has no negative zero
            stretch[label] = numbers(stretch[label]) + 0.0
        self._running.add(stretch)
        self._held = [{label: values[lines:] for label, values in whole.items()}]

    def overview(self) -> Overview:
        """Of all pieces."""
        if self._held:
            self._take(LINES_AT_ONCE)
        return self._running.overview()


def overview(
    pieces: Iterable[Records], headings: Sequence[Heading], number: str, verdict: str
) -> Overview:
    """The overview of a study's pieces; `number` and `verdict` are labels of columns."""
    running = RunningOverview(headings, number, verdict)
    for records in pieces:
        running.add(records)
    return running.overview()


def _spread(label: str, unit: str, column: _RunningColumn) -> Spread:
    if not column.count:
        return Spread(label, unit, 0, np.nan, -1, np.nan, -1, np.nan, np.nan)
    ends = (*column.least, *column.largest)
    if column.infinite != 0.0:
        return Spread(label, unit, column.count, *ends, column.infinite, np.nan)
    mean = column.first / column.count
    variance = max(column.second / column.count - mean * mean, 0.0)
    deviation = float(np.sqrt(variance))
    return Spread(label, unit, column.count, *ends, column.origin + mean, deviation)


class StudyFiles(NamedTuple):
    """What a study has written, and its overview."""

    name: str
    files: tuple[Path, ...]
    overview: Overview
    diagnostics: tuple[Diagnostic, ...]

    @property
    def listing(self) -> Listing:
        """The overview as a table, and the files."""
        seen = self.overview.listing(self.name)
        return seen._replace(notes=tuple(map(str, (*self.diagnostics, *self.files))))

    def __repr__(self) -> str:
        return self.listing.text()


class StudyResults(Listed):
    """The results of all variants: `r["peak(O1.effort)"]` is an array over them, in the file's
    units.

    Attributes:
        name: of the study.
        rows: columns of all rows of all variants by label, empty where the study keeps none.
        diagnostics: messages on the study.
    """

    def __init__(
        self,
        name: str,
        headings: Mapping[str, Sequence[Heading]],
        records: Mapping[str, Records],
        diagnostics: tuple[Diagnostic, ...],
    ) -> None:
        self.name = name
        self.diagnostics = diagnostics
        self.rows: Records = records.get(ROWS, {})
        self._headings = headings
        self._columns = records[VARIANTS]

    def __len__(self) -> int:
        return len(self._columns[VARIANT.label])

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __contains__(self, label: object) -> bool:
        return label in self._columns

    def __getitem__(self, label: str) -> Values:
        """A column over the variants (variants,); nan where a variant has no such number.

        Raises:
            UsageError: there is no such column.
        """
        if a_text("a column", label, '"peak(O1.effort)"') not in self._columns:
            labels = list(self._columns)
            hint = nearest_hint(label, labels) or f"columns are {', '.join(labels)}"
            raise UsageError(f"there is no column {label[:LONGEST_NAME]}; {hint}")
        return self._columns[label]

    def unit(self, label: str) -> str:
        """The unit of a column; "" where it has none."""
        self[label]
        return next(h.unit for h in self._headings[VARIANTS] if h.label == label)

    @property
    def overview(self) -> Overview:
        """Counts of verdicts, and least, largest and mean values of the columns."""
        headings = self._headings[VARIANTS]
        return overview([self._columns], headings, VARIANT.label, VERDICTS[1].label)

    @property
    def listing(self) -> Listing:
        """The overview as a table."""
        seen = self.overview.listing(self.name)
        return seen._replace(notes=tuple(map(str, self.diagnostics)))

    def to_pandas(self, table: str = VARIANTS) -> pandas.DataFrame:
        """`variants` or `rows` as a DataFrame; `attrs["units"]` has the unit of each column.

        Raises:
            UsageError: pandas is not installed, or there is no such table.
        """
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas needs pandas: pip install 'mechkin[pandas]'") from None
        if a_text("table", table, f'"{VARIANTS}"') not in self._headings:
            raise UsageError(
                f"there is no table {table[:LONGEST_NAME]}; tables are {', '.join(self._headings)}"
            )
        columns: Any = self._columns if table == VARIANTS else self.rows
        order = [heading.label for heading in self._headings[table]]
        frame = pandas.DataFrame({label: columns[label] for label in order})
        frame.attrs |= {"units": {h.label: h.unit for h in self._headings[table]}}
        return frame
