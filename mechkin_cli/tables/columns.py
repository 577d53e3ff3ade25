"""Tables: what they need of results, uniqueness of cells, columns, and whole tables.

Columns are expressions evaluated over all rows, in the units of the file: float64 arrays of shape
(rows,), nan where a cell stays empty. In a row without solution only inputs, `row.mode`,
`row.status` and `row.proof` keep their cells.

With redundant constraints some reactions are arbitrary. A cell is evaluated for the reactions of
least norm and for two others that are in equilibrium too; where it changes it is not unique and
becomes nan. So sums of reactions that are unique stay, though each part is not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.expressions import ExpressionError, Quantity, Vector
from mechkin_cli.kernel import _kernel
from mechkin_cli.record import NamedTuple, dataclass, replace
from mechkin_cli.tables.layout import (
    ROW_EVENT,
    ROW_NUMBERS,
    ROW_PROOF,
    ColumnLayout,
)
from mechkin_cli.tolerances import UNIQUE_CELL, ZERO_CELL
from mechkin_cli.units import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_JERK,
    ANGULAR_RATE,
    DIMENSIONLESS,
    JERK,
    LENGTH,
    VELOCITY,
    Conversion,
    Dimension,
)
from mechkin_cli.verdict import Proof, Status, are, are_ok, has_solution

if TYPE_CHECKING:
    from mechkin_cli.show import Floats
    from mechkin_cli.units import UnitSystem


# Numbers of a column as text with one number of decimals, for tables that people read.
#
# Declared decimals hold as they are. Undeclared ones give six significant digits to the column's
# largest value, less the zeros that would end every number; a column whose largest value is below
# 1e-6 or from 1e9 on is written with exponents, and what is rounding of zero for the column's size
# (`rounding_of`) is zero. Every text is the exact binary value rounded once, ties to even, so it is
# the same on every machine; zero has no sign.

SIGNIFICANT_DIGITS = 6
PLAIN_EXPONENTS = range(-6, 9)

DecimalColumn = tuple["Floats", bool, int, bool]
"""A column as the kernel takes it: numbers, whether with exponents, decimals, and whether without
the zeros that end every one of them."""


def decimal_column(
    values: Floats, decimals: int | None = None, rounding: float = 0.0
) -> DecimalColumn:
    """The layout of an array of shape (rows,); `decimals` as declared, None to choose them.

    Where they are chosen, numbers up to `rounding` are zero.
    """
    values = number_column(values)
    if decimals is not None:
        return values, False, decimals, False
    values = np.where(np.abs(values) <= rounding, 0.0, values)
    largest = np.abs(values).max(initial=0.0, where=np.isfinite(values))
    # of the rounded value, which may have one digit more
    exponent = int(f"{float(largest):.{SIGNIFICANT_DIGITS - 1}e}".partition("e")[2])
    if exponent not in PLAIN_EXPONENTS:
        return values, True, SIGNIFICANT_DIGITS - 1, False
    return values, False, max(0, SIGNIFICANT_DIGITS - 1 - exponent), True


def column_texts(values: Floats, decimals: int | None = None, rounding: float = 0.0) -> list[str]:
    """One text per value of an array of shape (rows,); a value that is not finite has none."""
    texts: list[str] = _kernel.decimal_texts(decimal_column(values, decimals, rounding))
    return texts


def number_column(values: Floats) -> Floats:
    """The numbers without gaps in memory, shape (rows,)."""
    return np.ascontiguousarray(values, np.float64)


FloatArray = NDArray[np.float64]
StatusArray = NDArray[np.int8]


class TableSource(Protocol):
    """Results of one analysis; every array has the shape (rows,)."""

    @property
    def rows(self) -> int:
        """Number of rows asked for."""

    @property
    def coordinates(self) -> Sequence[str]:
        """Scalar joint coordinates in joint order, such as `O1.theta`."""

    @property
    def inputs(self) -> Mapping[str, FloatArray]:
        """Time where there is one, and values of the driven coordinates, in file units exactly as
        written."""

    @property
    def input_rates(self) -> Mapping[str, FloatArray]:
        """Rates of the driven coordinates, in file units as written; nan in rows without a
        solution."""

    @property
    def mode(self) -> str:
        """Name of the assembly mode that the rows follow."""

    @property
    def letter(self) -> str:
        """The same by its letter, which may have to be searched for."""

    @property
    def run_events(self) -> Sequence[str]:
        """The texts among the events of the whole run, where these are some of its rows."""

    @property
    def events(self) -> Sequence[str]:
        """What happened at each row of a response, "" where nothing did; whether each equilibrium
        is stable; () of a sweep."""
        ...

    @property
    def measure(self) -> str:
        """The number of a row that tells how well energies or loads balance: `energy_error` of
        responses, `imbalance` of equilibria, "" of a sweep."""

    @property
    def status(self) -> StatusArray:
        """Codes of `mechkin_cli.verdict.Status`."""

    @property
    def is_certified(self) -> bool:
        """Whether proofs of the rows have been asked for."""

    @property
    def proven_way(self) -> tuple[bool, int]:
        """Whether all rows are proven to lie on one branch, and how many tubes join them."""

    @property
    def proven_dead_centres(self) -> Sequence[Mapping[str, object]]:
        """What is proven of the dead centres beyond which rows are missing, as plain data."""

    @property
    def proof(self) -> StatusArray:
        """Codes of `mechkin_cli.verdict.Proof`, found now if they were not."""

    @property
    def residual(self) -> FloatArray:
        """Largest closure component of the row, dimensionless; nan where not computed."""

    @property
    def condition(self) -> FloatArray:
        """Condition of the row's closure, dimensionless; nan where not computed."""

    @property
    def power_error(self) -> FloatArray:
        """|sum of powers| / sum of |powers|, dimensionless; nan where not computed."""

    @property
    def units(self) -> UnitSystem:
        """Units of the mechanism file; tables are written in them."""

    @property
    def alternatives(self) -> Sequence[TableSource]:
        """The same rows with other reactions in equilibrium, where constraints are redundant."""

    @property
    def disturbed(self) -> Sequence[TableSource]:
        """The same rows with reactions that are off by their rounding, where constraints are
        redundant."""

    @property
    def length(self) -> float:
        """About the size of the mechanism, in SI."""

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by its dotted name, in SI.

        Raises:
            UnknownName: nothing has this name.
        """


def unique_cells(
    values: Floats, others: Sequence[Floats], disturbed: Sequence[Floats] = ()
) -> Floats:
    """The values with nan where another admissible value differs; all of shape (rows,).

    `disturbed` are the values for reactions that are off by their rounding: what they change is
    the rounding of the cell, whatever the size of its column is.
    """
    if not others:
        return values
    # a row without any load is zero whatever the others, which are of no size there
    loaded = values != 0.0
    sizes = [np.abs(v[np.isfinite(v) & loaded]).max(initial=0.0) for v in (values, *others)]
    limit = np.full(values.shape, UNIQUE_CELL * max(sizes))
    settled = values.copy()
    with np.errstate(invalid="ignore"):
        for other in disturbed:
            limit = np.fmax(limit, np.abs(other - values))
        for other in others:
            alike = np.abs(other - values) <= limit
            # infinite at a dead centre, whatever the arbitrary part is
            alike |= np.isinf(values) & (other == values)
            settled[~alike] = np.nan
    return settled


INFINITE = "inf"
AT = "at"
"""In front of the places of extremes."""


@dataclass(frozen=True, slots=True, eq=False)
class Words:
    """A text per row: `words[codes[i]]`."""

    codes: NDArray[np.int32]
    words: tuple[str, ...]

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.codes.size

    def texts(self, rows: Sequence[int]) -> list[str]:
        """The texts of some rows."""
        return [self.words[self.codes[row]] for row in rows]

    def array(self) -> NDArray[np.str_]:
        """The text of every row, shape (rows,)."""
        return np.array(self.words)[self.codes]


def words_of(texts: Sequence[str], known: Sequence[str] = ()) -> Words:
    """Texts row by row; of rows whose run has others, too, these are the first ones `known`."""
    places = {text: place for place, text in enumerate(dict.fromkeys((*known, *texts)))}
    return Words(np.array([places[text] for text in texts], np.int32), tuple(places))


@dataclass(frozen=True, slots=True, eq=False)
class TableColumn:
    """One evaluated column: `values` in the unit that `unit` names, shape (rows,).

    `unbounded` (rows,) is infinite with its sign in rows at a dead centre towards which the column
    grows without bound, else zero; None where it does in no row. Numbers up to `rounding` are
    rounding of zero.
    """

    label: str
    unit: str
    values: FloatArray | Words
    decimals: int | None = None
    unbounded: FloatArray | None = None
    rounding: float = 0.0

    @property
    def numbers(self) -> FloatArray:
        """The values of a column that is no words, with what is infinite."""
        assert not isinstance(self.values, Words)
        if self.unbounded is None:
            return self.values
        return np.where(self.unbounded == 0.0, self.values, self.unbounded)

    def texts(self, texts: Sequence[str]) -> list[str]:
        """The texts of the values, with words for what is infinite."""
        if self.unbounded is None:
            return list(texts)
        words = np.where(self.unbounded > 0.0, INFINITE, f"-{INFINITE}").tolist()
        is_infinite = (self.unbounded != 0.0).tolist()
        return [w if i else t for t, w, i in zip(texts, words, is_infinite, strict=True)]

    def part(self, rows: NDArray[np.intp] | Sequence[int]) -> TableColumn:
        """Some of the rows."""
        rows, values = np.asarray(rows, dtype=np.intp), self.values
        if isinstance(values, Words):
            return replace(self, values=Words(values.codes[rows], values.words))
        unbounded = None if self.unbounded is None else self.unbounded[rows]
        return replace(self, values=values[rows], unbounded=unbounded)

    def with_values(
        self, values: FloatArray | Words, unbounded: FloatArray | None = None
    ) -> TableColumn:
        """The column with other rows."""
        # as long runs cut their columns, these are many
        return TableColumn(self.label, self.unit, values, self.decimals, unbounded, self.rounding)

    def between(self, rows: slice) -> TableColumn:
        """Some neighbouring rows, without copying them."""
        values, unbounded = self.values, self.unbounded
        if isinstance(values, Words):
            return self.with_values(Words(values.codes[rows], values.words))
        return self.with_values(values[rows], None if unbounded is None else unbounded[rows])

    @property
    def rows(self) -> int:
        """Number of rows."""
        return self.values.rows if isinstance(self.values, Words) else self.values.size


def joined_column(parts: Sequence[TableColumn]) -> TableColumn:
    """The rows of a column of which these are the parts."""
    first = parts[0]
    if len(parts) == 1:
        return first
    if isinstance(first.values, Words):
        codes = [part.values.codes for part in parts if isinstance(part.values, Words)]
        return first.with_values(Words(np.concatenate(codes), first.values.words))
    values = np.concatenate([part.values for part in parts if isinstance(part.values, np.ndarray)])
    if all(part.unbounded is None for part in parts):
        return first.with_values(values)
    nothing = (np.zeros(part.rows) if part.unbounded is None else part.unbounded for part in parts)
    return first.with_values(values, np.concatenate(list(nothing)))


def column_of_numbers(
    label: str, unit: str, numbers: FloatArray | Sequence[float], decimals: int | None = None
) -> TableColumn:
    """A column of numbers (rows,), of which some may be infinite."""
    numbers = np.asarray(numbers, dtype=np.float64)
    infinite = np.isinf(numbers)
    if not infinite.any():
        return TableColumn(label, unit, numbers, decimals)
    unbounded = np.where(infinite, numbers, 0.0)
    return TableColumn(label, unit, np.where(infinite, np.nan, numbers), decimals, unbounded)


_ROW_WORDS: Mapping[str, Callable[[TableSource], Words]] = {
    "row.mode": lambda source: Words(np.zeros(source.rows, np.int32), (source.letter,)),
    "row.status": lambda source: Words(
        source.status.astype(np.int32), tuple(status.label for status in Status)
    ),
    ROW_PROOF: lambda source: Words(
        source.proof.astype(np.int32), tuple(proof.label for proof in Proof)
    ),
    ROW_EVENT: lambda source: words_of(source.events, source.run_events),
}


def row_words(name: str, source: TableSource) -> Words:
    """A quantity of the rows that is a text, by its name."""
    return _ROW_WORDS[name](source)


def solved_rows(source: TableSource) -> NDArray[np.bool_]:
    """Which rows have a solution, shape (rows,)."""
    solved: NDArray[np.bool_] = _solved_codes()[source.status]
    return solved


@cache
def _solved_codes() -> NDArray[np.bool_]:
    """Which verdicts have a solution, by their codes; every column asks."""
    return has_solution(np.arange(1 + max(Status), dtype=np.int8))


def column_of(layout: ColumnLayout, source: TableSource) -> TableColumn:
    """One column in file units; cells that are not unique are nan. Raises as `evaluate`."""
    name = layout.expression.text.strip()
    if name in _ROW_WORDS:
        return TableColumn(layout.label, "", row_words(name, source))
    values = source.inputs.get(name, source.input_rates.get(name))
    if values is not None:
        unit = source.units.label(source.quantity(name).dimension)
        return TableColumn(layout.label, unit, values.copy(), layout.decimals)
    column = _evaluated(layout, source)
    if not source.alternatives:
        return column
    others = [_evaluated(layout, other).values for other in source.alternatives]
    disturbed = [_evaluated(layout, other).values for other in source.disturbed]
    values = unique_cells(column.values, others, disturbed)  # type: ignore[arg-type]
    return replace(column, values=values)


def rounding_of(
    layouts: Sequence[ColumnLayout], columns: Sequence[TableColumn], source: TableSource
) -> tuple[TableColumn, ...]:
    """The columns of a table with the size up to which their numbers are rounding of zero: a small
    part of the largest number that the table has of the same unit, of the mechanism's size for
    lengths, and of 1 for angles and numbers without a unit; as fast as the inputs move, for rates.

    Inputs are as written, and the measures of accuracy are small by nature: these have none.
    """
    sizes = table_sizes(source)
    for column in columns:
        if not isinstance(column.values, Words) and column.unit:
            finite = np.isfinite(column.values)
            largest = float(np.abs(column.values).max(initial=0.0, where=finite))
            sizes[column.unit] = max(largest, sizes.get(column.unit, 0.0))
    return tuple(
        column
        if not _is_rounded(layout, column, source)
        else replace(column, rounding=ZERO_CELL * sizes.get(column.unit, 0.0))
        for layout, column in zip(layouts, columns, strict=True)
    )


def _is_rounded(layout: ColumnLayout, column: TableColumn, source: TableSource) -> bool:
    """Whether a column is a number computed from positions, rates and loads alone."""
    if isinstance(column.values, Words) or layout.expression.text.strip() in source.inputs:
        return False
    measured = any(name.startswith("row.") for name in layout.expression.names)
    return not (measured and column.unit == "")


def table_sizes(source: TableSource) -> dict[str, float]:
    """By their labels in the file's units: lengths, angles and their rates of the mechanism's size,
    and 1 for what has none."""
    rates = [0.0]
    for name, values in source.input_rates.items():
        quantity = source.quantity(name)
        per_size = size_of_rate(quantity.dimension, source)
        if per_size is not None:
            largest = np.abs(values).max(initial=0.0, where=np.isfinite(values))
            rates.append(float(largest) / per_size)
    sizes = {"": 1.0}
    for size, kinds in size_kinds(source):
        for label, conversion in kinds:
            sizes[label] = float(conversion.reverse(size))
            size *= max(rates)
    return sizes


def size_of_rate(dimension: Dimension, source: TableSource) -> float | None:
    """The rate in the file's units at which an input moves by the mechanism's size in a second;
    None of what is no rate."""
    per_size = {ANGULAR_RATE: 1.0, VELOCITY: source.length}.get(dimension)
    return None if per_size is None else float(source.units.from_si(per_size, dimension))


def size_kinds(source: TableSource) -> list[tuple[float, list[tuple[str, Conversion]]]]:
    """The sizes of angles and of lengths in SI, each with the labels of their orders in time and
    the conversions to SI."""
    return [
        (size, [(source.units.label(kind), source.units.conversion(kind)) for kind in kinds])
        for size, kinds in (
            (1.0, (ANGLE, ANGULAR_RATE, ANGULAR_ACCELERATION, ANGULAR_JERK)),
            (source.length, (LENGTH, VELOCITY, ACCELERATION, JERK)),
        )
    ]


def _evaluated(layout: ColumnLayout, source: TableSource) -> TableColumn:
    quantity = layout.expression.evaluate(lambda name: _resolve(name, source))
    value = quantity.value
    if isinstance(value, Vector):
        raise ExpressionError(
            f"column {layout.label!r} is a vector, a column holds one number per row",
            0,
            f"write {value.components_of(layout.expression.text)}",
        )
    in_si = np.asarray(value, dtype=np.float64)
    if not in_si.ndim:
        in_si = np.full(source.rows, in_si)
    values = source.units.from_si(in_si, quantity.dimension)
    if values is in_si:  # the unit is that of SI, and the array may be the source's
        values = in_si.copy()
    # infinite is only what grows without bound towards a dead centre at which its row stands
    infinite = np.isinf(values)
    unit = source.units.label(quantity.dimension)
    if are_ok(source.status):
        if infinite.any():
            values[infinite] = np.nan
        return TableColumn(layout.label, unit, values, layout.decimals)
    is_unbounded = are(source.status, Status.dead_centre)
    values[~solved_rows(source) | infinite & ~is_unbounded] = np.nan
    return column_of_numbers(layout.label, unit, values, layout.decimals)


def _resolve(name: str, source: TableSource) -> Quantity:
    if name in _ROW_WORDS:
        raise ExpressionError(
            f"{name} is a text and cannot be computed with", 0, "make it a column of its own"
        )
    if name in ROW_NUMBERS:
        return Quantity(getattr(source, name.removeprefix("row.")), DIMENSIONLESS)
    return source.quantity(name)


class RunParameter(NamedTuple):
    """What a run goes along: its name, its values (rows,) in the file's units, and their unit."""

    name: str
    values: FloatArray
    unit: str


def run_parameter(source: TableSource) -> RunParameter | None:
    """Time where a run has one, else its first input that moves; None where nothing moves."""
    return moving_input(
        source.inputs, lambda name: source.units.label(source.quantity(name).dimension)
    )


def moving_input(
    inputs: Mapping[str, FloatArray], unit: Callable[[str], str]
) -> RunParameter | None:
    """The first of some inputs that moves; `unit` is that of an input by its name."""
    for name, values in inputs.items():
        if bool((values != values[0]).any()):
            return RunParameter(name, values, unit(name))
    return None
