"""What stands below a table: extremes with their places, means and ranges of its columns.

Rows without a cell do not count, and `rows` says how many do. Mean and RMS are integrals over the
run's parameter by the trapezoidal rule (`mean`), so that they do not depend on where rows are
dense; the stretch to a row without a cell, or with an infinite one, is left out.
Places are values of that parameter, of the first row that has the extreme; where nothing moves,
numbers of rows.

A value may be infinite: what grows without bound towards a row at a dead centre. Extremes count
it, and are infinite at its place. Means do not: whether the integral up to there is finite (a
rate, which goes as one over the root of what is left of the way) or not (its square), one row
cannot decide, so the integral ends at the last row beside it, as it does where there is no value.

Sums are added row by row, in order: their bits do not depend on the machine.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.columns import (
    AT,
    FloatArray,
    RunParameter,
    TableColumn,
    TableSource,
    Words,
    column_of_numbers,
    column_texts,
    run_parameter,
)
from mechkin_cli.tables.layout import ROW_NUMBER, ColumnLayout
from mechkin_cli.verdict import Status

if TYPE_CHECKING:
    from mechkin_cli.show import Floats


Reduction = Callable[["Floats"], "Floats"]
"""From values (variants, rows), nan where there is none, to (variants,)."""


def largest(values: Floats) -> Floats:
    """The largest value."""
    return np.asarray(np.fmax.reduce(values, axis=1) + 0.0)


def smallest(values: Floats) -> Floats:
    """The smallest value."""
    return np.asarray(np.fmin.reduce(values, axis=1) + 0.0)


def peak(values: Floats) -> Floats:
    """The largest magnitude."""
    return largest(np.abs(values))


def span(values: Floats) -> Floats:
    """The difference of the largest and the smallest value; none between infinite ones."""
    with np.errstate(invalid="ignore"):
        return largest(values) - smallest(values)


def mean(values: Floats, at: Floats | None = None) -> Floats:
    """The mean over the way, by the trapezoidal rule over the stretches between neighbouring rows
    that both have a finite value, divided by their length; nan where no row has one.

    A row without a neighbour has no way and does not count beside those that have. Where no
    stretch has a length every row counts the same.

    Args:
        values: (variants, rows).
        at: where the rows stand, (rows,) or (variants, rows); None: nowhere, as where nothing
            moves.
    """
    total, count = _sum(values, None if at is None else _ways(values, at))
    return total / count


def root_mean_square(values: Floats, at: Floats | None = None) -> Floats:
    """The root of the mean of the squares, as `mean`."""
    # a power of two in front keeps squares from running over, and changes no bit
    _, exponent = np.frexp(peak(np.where(np.isfinite(values), values, np.nan)))
    scaled = np.ldexp(values, -exponent[:, None])
    total, count = _sum(scaled * scaled, None if at is None else _ways(values, at))
    return np.ldexp(np.sqrt(total / count), exponent)


def row_weights(at: Floats) -> Floats:
    """What rows at these places (rows,) count for in a mean over the way where all have a value:
    half the way to each neighbour; all the same where nothing moves."""
    weights = _halves(0.5 * np.abs(np.diff(at)))
    return weights if weights.any() else np.ones(at.shape)


def _ways(values: Floats, at: Floats) -> Floats:
    """What rows count for, (rows,) or (variants, rows): half of each stretch at whose other end
    there is a finite value, too."""
    there = np.isfinite(values)
    if at.ndim == 2 and bool((at == at[:1]).all()):
        at = at[0]
    if at.ndim == 1 and there.all():
        return row_weights(at)
    both = there[:, 1:] & there[:, :-1]
    weights = _halves(np.where(both, 0.5 * np.abs(np.diff(at)), 0.0))
    weights[~weights.any(axis=1)] = 1.0
    return weights


def _halves(stretches: Floats) -> Floats:
    weights = np.zeros((*stretches.shape[:-1], stretches.shape[-1] + 1))
    weights[..., :-1] += stretches
    weights[..., 1:] += stretches
    return weights


def _sum(values: Floats, weights: Floats | None) -> tuple[Floats, Floats]:
    """Weighted sum and weight of the finite values; nan where there is none."""
    there = np.isfinite(values)
    if weights is None:
        total = _in_order(np.where(there, values, 0.0))
        count = np.count_nonzero(there, axis=1).astype(np.float64)
    else:
        total = _in_order(np.multiply(values, weights, out=np.zeros(values.shape), where=there))
        count = _in_order(np.where(there, weights, 0.0))
    return total, np.where(count == 0.0, np.nan, count)


def _in_order(values: Floats) -> Floats:
    found: Floats = np.cumsum(values, axis=1)[:, -1]
    return found


REDUCTIONS: dict[str, Reduction] = {
    "max": largest,
    "min": smallest,
    "peak": peak,
    "range": span,
    "mean": mean,
    "rms": root_mean_square,
}
"""By the names under which they are asked for."""

OVER_THE_WAY: tuple[Reduction, ...] = (mean, root_mean_square)
"""Those that take the places of the rows, too."""


class Extreme(NamedTuple):
    """A value and its place: what the run's parameter is there, in the file's units."""

    value: float
    place: float


class Statistics(NamedTuple):
    """Of one column, in the file's units; nan where no row has a cell.

    `peak` is the largest magnitude, `range` the difference of max and min, `rows` how many rows
    have a cell, `infinite` how many of these are infinite, at a dead centre: they count for no
    mean.
    """

    max: Extreme
    min: Extreme
    peak: Extreme
    mean: float
    rms: float
    range: float
    rows: int
    infinite: int = 0


def statistics(values: FloatArray, source: TableSource) -> Statistics:
    """The numbers of a column (rows,), nan where a row has no cell."""
    along = run_parameter(source)
    places = np.arange(1.0, source.rows + 1) if along is None else along.values
    way = None if along is None else places
    row = values[None]
    numbers = {word: float(reduce(row)[0]) for word, reduce in REDUCTIONS.items()}

    def extreme(word: str, sizes: FloatArray) -> Extreme:
        at = np.flatnonzero(sizes == numbers[word])
        return Extreme(numbers[word], float(places[at[0]]) if at.size else np.nan)

    return Statistics(
        extreme("max", values),
        extreme("min", values),
        extreme("peak", np.abs(values)),
        float(mean(row, way)[0]),
        float(root_mean_square(row, way)[0]),
        numbers["range"],
        int(np.count_nonzero(~np.isnan(values))),
        int(np.count_nonzero(np.isinf(values))),
    )


class RunningStatistics:
    """The numbers of a column whose rows come block by block: what `statistics` finds of all of
    them at once, bit for bit.

    Args:
        words: those of `REDUCTIONS` that are wanted; the others are nan.
        moves: whether rows have places along the way; else all count the same in a mean.
    """

    def __init__(self, words: Iterable[str], *, moves: bool) -> None:
        self._words, self._moves = frozenset(words), moves
        nothing = Extreme(np.nan, np.nan)
        self._extremes = dict.fromkeys(("max", "min", "peak"), nothing)
        self._mean = _RunningMean(moves) if "mean" in self._words else None
        self._squares = _RunningSquares(moves) if "rms" in self._words else None
        self._rows = self._infinite = 0

    def add(self, values: Floats, places: Floats) -> None:
        """Adds rows: values (rows,), nan without a cell, at places (rows,) along the way."""
        found = _kernel.extremes(np.ascontiguousarray(values))
        cells, infinite, largest, smallest = found
        self._rows += cells
        self._infinite += infinite
        if cells:
            if "range" in self._words or "max" in self._words:
                self._take("max", largest, values, places)
            if "range" in self._words or "min" in self._words:
                self._take("min", smallest, values, places)
            if "peak" in self._words:
                self._take("peak", max(largest, -smallest), values, places)
        if self._mean is not None:
            self._mean.add(values, places)
        if self._squares is not None:
            self._squares.add(values, places)

    def found(self) -> Statistics:
        """The numbers of the rows so far."""
        most, least = self._extremes["max"], self._extremes["min"]
        shown = {
            word: each if word in self._words else Extreme(np.nan, np.nan)
            for word, each in self._extremes.items()
        }
        return Statistics(
            **shown,
            mean=self._mean.found() if self._mean else np.nan,
            rms=self._squares.found() if self._squares else np.nan,
            range=most.value - least.value if "range" in self._words else np.nan,
            rows=self._rows,
            infinite=self._infinite,
        )

    def _take(self, word: str, found: float, values: Floats, places: Floats) -> None:
        """Takes an extreme of some rows, with its first place, where it is the run's."""
        own = self._extremes[word].value
        better = found < own if word == "min" else found > own
        if better or np.isnan(own):
            sizes = np.abs(values) if word == "peak" else values
            # 0 has no sign
            self._extremes[word] = Extreme(found + 0.0, float(places[np.argmax(sizes == found)]))


class _RunningMean:
    """A mean as `mean` has it. The last row waits for the next one: what it counts for is half the
    way to either side."""

    def __init__(self, moves: bool) -> None:
        self._moves = moves
        self._last: tuple[float, float, float] | None = None
        # nothing is changed by what is added to -0
        self._over_way, self._over_rows = (-0.0, 0.0), (-0.0, 0.0)

    def add(self, values: Floats, places: Floats) -> None:
        there = np.isfinite(values)
        clean = np.where(there, values, 0.0)
        self._over_rows = (
            _summed(self._over_rows[0], clean),
            self._over_rows[1] + float(np.count_nonzero(there)),
        )
        if not self._moves or not values.size:
            return
        before = self._last
        if before is not None:
            values = np.concatenate([[before[0]], values])
            places = np.concatenate([[before[1]], places])
            there = np.isfinite(values)
            clean = np.where(there, values, 0.0)
        ways = np.where(there[1:] & there[:-1], 0.5 * np.abs(np.diff(places)), 0.0)
        weights = ways.copy()
        weights[1:] += ways[:-1]
        if before is not None and ways.size:
            weights[0] += before[2]
        counts = np.where(there[:-1], weights, 0.0)
        self._over_way = (
            _summed(self._over_way[0], clean[:-1] * counts),
            _summed(self._over_way[1], counts),
        )
        left = float(ways[-1]) if ways.size else 0.0
        self._last = float(values[-1]), float(places[-1]), left

    def rescale(self, factor: float) -> None:
        """Multiplies all values so far by a power of two, which changes no bit."""
        self._over_way = self._over_way[0] * factor, self._over_way[1]
        self._over_rows = self._over_rows[0] * factor, self._over_rows[1]
        if self._last is not None:
            self._last = (self._last[0] * factor, *self._last[1:])

    def found(self) -> float:
        total, count = self._over_way
        if self._last is not None and np.isfinite(self._last[0]):
            value, _, left = self._last
            total, count = total + value * left, count + left
        if not count:
            total, count = self._over_rows
        return total / count if count else np.nan


class _RunningSquares:
    """A root mean square as `root_mean_square` has it."""

    def __init__(self, moves: bool) -> None:
        self._mean = _RunningMean(moves)
        self._exponent: int | None = None

    def add(self, values: Floats, places: Floats) -> None:
        largest = np.where(np.isfinite(values), np.abs(values), 0.0).max(initial=0.0)
        exponent = int(np.frexp(largest)[1])
        if largest and (self._exponent is None or exponent > self._exponent):
            if self._exponent is not None:
                self._mean.rescale(float(np.ldexp(1.0, 2 * (self._exponent - exponent))))
            self._exponent = exponent
        scaled = np.ldexp(values, -(self._exponent or 0))
        self._mean.add(scaled * scaled, places)

    def found(self) -> float:
        return float(np.ldexp(np.sqrt(self._mean.found()), self._exponent or 0))


def _summed(total: float, values: Floats) -> float:
    """A total and further values, added in order."""
    if not values.size:
        return total
    first = values.copy()
    first[0] += total
    return float(np.cumsum(first, out=first)[-1])


def summary_of(
    words: tuple[str, ...],
    layouts: Sequence[ColumnLayout],
    columns: Sequence[TableColumn],
    source: TableSource,
) -> Summary:
    """The rows below a table; time, inputs and words are left out."""
    along = run_parameter(source)
    summed = tuple(
        SummaryColumn(
            number,
            column.label,
            column.unit,
            column.decimals,
            statistics(column.numbers, source),
            column.rounding,
        )
        for number, (layout, column) in enumerate(zip(layouts, columns, strict=True))
        if isinstance(column.values, np.ndarray)
        and layout.expression.text.strip() not in source.inputs
    )
    counts = {status: int(np.count_nonzero(source.status == status)) for status in Status}
    return _summary(words, along, summed, source.rows, counts)


def _summary(
    words: tuple[str, ...],
    along: RunParameter | None,
    columns: tuple[SummaryColumn, ...],
    rows: int,
    counts: Mapping[Status, int],
) -> Summary:
    """The rows below a table of so many rows, of which so many have each status."""
    name, unit = (ROW_NUMBER, "") if along is None else (along.name, along.unit)
    return Summary(words, name, unit, columns, tuple(_notes(words, columns, rows, counts)))


class RunningSummary:
    """The rows below a table whose rows come block by block: what `summary_of` finds of all of them
    at once.

    Args:
        words: of `REDUCTIONS`.
        layouts: of the table's columns.
        along: what the run goes along.
        inputs: names of what is not summed up: time and inputs.
    """

    def __init__(
        self,
        words: tuple[str, ...],
        layouts: Sequence[ColumnLayout],
        along: RunParameter | None,
        inputs: Collection[str],
    ) -> None:
        self._words, self._along = words, along
        self._summed = [
            number
            for number, layout in enumerate(layouts)
            if layout.expression.text.strip() not in inputs
        ]
        self._sums: dict[int, RunningStatistics] = {}
        self._columns: dict[int, TableColumn] = {}

    def add(self, columns: Sequence[TableColumn], places: Floats) -> None:
        """Adds rows: all columns of the table, and where the rows stand along the run."""
        for number in self._summed:
            column = columns[number]
            if isinstance(column.values, Words):
                continue
            if number not in self._sums:
                moves = self._along is not None
                self._sums[number] = RunningStatistics(self._words, moves=moves)
                self._columns[number] = column
            self._sums[number].add(column.numbers, places)

    def found(self, rows: int, counts: Mapping[Status, int]) -> Summary:
        """The rows below; of so many rows so many have each status."""
        summed = tuple(
            SummaryColumn(number, column.label, column.unit, column.decimals, sums.found())
            for (number, column), sums in zip(
                self._columns.items(), self._sums.values(), strict=True
            )
        )
        return _summary(self._words, self._along, summed, rows, counts)


def _notes(
    words: tuple[str, ...],
    columns: Sequence[SummaryColumn],
    rows: int,
    counts: Mapping[Status, int],
) -> list[str]:
    found = []
    missing = {c.label: rows - c.statistics.rows for c in columns}
    missing = {label: count for label, count in missing.items() if count}
    if len(missing) == len(columns) and len(set(missing.values())) == 1:
        missing = {"any column": max(missing.values())}
    for label, count in missing.items():
        have, do = ("has", "does") if count == 1 else ("have", "do")
        found.append(f"{count} of {rows} rows {have} no cell of {label} and {do} not count")
    found += _infinite(words, columns, rows)
    for status in Status:
        count = counts.get(status, 0)
        if status is not Status.ok and status.has_solution and count:
            found.append(f"{count} of the rows {'is' if count == 1 else 'are'} {status.label}")
    return found


def _infinite(words: tuple[str, ...], columns: Sequence[SummaryColumn], all_rows: int) -> list[str]:
    means = " and ".join(word for word in ("mean", "rms") if word in words)
    counts = {c.label: c.statistics.infinite for c in columns if means}
    found = []
    for count in sorted({*counts.values()} - {0}):
        labels = ", ".join(label for label, each in counts.items() if each == count)
        are, do = ("is", "does") if count == 1 else ("are", "do")
        rows = f"{count} of {all_rows} rows {are} infinite in {labels}"
        found.append(f"{rows} and {do} not count for {means}")
    return found


ROWS = "rows"
"""In front of the numbers of rows with a cell."""

_WITH_PLACE = ("max", "min", "peak")


class SummaryColumn(NamedTuple):
    """A column that is summed up; `number` is its place among the table's columns."""

    number: int
    label: str
    unit: str
    decimals: int | None
    statistics: Statistics
    rounding: float = 0.0


class Summary(NamedTuple):
    """The rows below a table: which, of what parameter the places are (with its unit), and the
    numbers of each column; `notes` say what does not count or is doubtful."""

    words: tuple[str, ...]
    parameter: str
    unit: str
    columns: tuple[SummaryColumn, ...]
    notes: tuple[str, ...]

    def written_notes(self, written: Callable[[str], str] = str) -> list[str]:
        """What is said below the rows; `written` makes of a label what is to stand in the file."""
        over = "" if self.parameter == ROW_NUMBER else f"; mean and rms over {self.parameter}"
        has_mean = {"mean", "rms"}.intersection(self.words)
        has_place = set(_WITH_PLACE).intersection(self.words)
        said = [f"{AT}: {self.places}{over if has_mean else ''}"] if has_place else []
        if has_mean and not has_place and over:
            said = [over.removeprefix("; ")]
        return [written(text) for text in (*said, *self.notes)]

    @property
    def lines(self) -> tuple[str, ...]:
        """Words in front of the rows."""
        found: list[str] = []
        for word in self.words:
            found += [word, AT] if word in _WITH_PLACE else [word]
        return (*found, ROWS)

    @property
    def places(self) -> str:
        """What places are values of, with the unit."""
        return f"{self.parameter} [{self.unit}]" if self.unit else self.parameter

    def numbers(self, column: SummaryColumn) -> list[float]:
        """The numbers of a column, one for each of the lines."""
        found: list[float] = []
        for word in self.words:
            value = getattr(column.statistics, word)
            found += [*value] if word in _WITH_PLACE else [value]
        return [*found, float(column.statistics.rows)]

    def texts(self, column: SummaryColumn) -> list[str]:
        """The same as people read them: with the column's decimals, places with nine digits."""
        numbers = np.array(self.numbers(column))
        is_value = np.array([line not in (AT, ROWS) for line in self.lines])
        own = column_of_numbers("", "", numbers[is_value])
        values = iter(own.texts(column_texts(numbers[is_value], column.decimals, column.rounding)))
        others = (f"{n + 0.0:.9g}" if np.isfinite(n) else "" for n in numbers[~is_value].tolist())
        return [next(values) if mine else next(others) for mine in is_value]
