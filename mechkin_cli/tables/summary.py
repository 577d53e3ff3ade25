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

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechkin_cli.record import NamedTuple
from mechkin_cli.tables.columns import (
    AT,
    FloatArray,
    TableColumn,
    TableSource,
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
    name, unit = (ROW_NUMBER, "") if along is None else (along.name, along.unit)
    return Summary(words, name, unit, summed, tuple(_notes(words, summed, source)))


def _notes(
    words: tuple[str, ...], columns: Sequence[SummaryColumn], source: TableSource
) -> list[str]:
    found = []
    missing = {c.label: source.rows - c.statistics.rows for c in columns}
    missing = {label: count for label, count in missing.items() if count}
    if len(missing) == len(columns) and len(set(missing.values())) == 1:
        missing = {"any column": max(missing.values())}
    for label, count in missing.items():
        have, do = ("has", "does") if count == 1 else ("have", "do")
        found.append(f"{count} of {source.rows} rows {have} no cell of {label} and {do} not count")
    found += _infinite(words, columns, source)
    for status in Status:
        count = int(np.count_nonzero(source.status == status))
        if status is not Status.ok and status.has_solution and count:
            found.append(f"{count} of the rows {'is' if count == 1 else 'are'} {status.label}")
    return found


def _infinite(
    words: tuple[str, ...], columns: Sequence[SummaryColumn], source: TableSource
) -> list[str]:
    means = " and ".join(word for word in ("mean", "rms") if word in words)
    counts = {c.label: c.statistics.infinite for c in columns if means}
    found = []
    for count in sorted({*counts.values()} - {0}):
        labels = ", ".join(label for label, each in counts.items() if each == count)
        are, do = ("is", "does") if count == 1 else ("are", "do")
        rows = f"{count} of {source.rows} rows {are} infinite in {labels}"
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
