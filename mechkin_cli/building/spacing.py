"""How many rows a run has, and equally spaced values over them.

The equally spaced values of a sweep are the doubles nearest to the decimal numbers: 0, 0.1, 0.2,
0.3 and not 0.30000000000000004. The numbers written are fractions over one power of ten, so x_i =
from + i*step is a quotient of two whole numbers that doubles hold exactly, and a single division
rounds it. Numbers with too many digits for that (results of expressions) are added as doubles.
"""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from functools import partial
from math import floor, inf, isfinite
from typing import TYPE_CHECKING, Final

import numpy as np

from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism import Joint, told_coordinates
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import MechanismFile, SweptInput, TimeSection
from mechkin_cli.tables import default_table
from mechkin_cli.tape import Recorder, Traced, as_recorded
from mechkin_cli.tolerances import LAST_ROW, LONG_RUN, MOST_NUMBERS, MOST_ROWS
from mechkin_cli.units import Dimension
from mechkin_cli.verdict import SWEEP

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.show import Floats

_ROW_COLUMNS: Final = 6
"""Columns of rows.csv beside the inputs."""


def has_too_many_rows(fields: Fields, path: Path, rows: float, per_row: int | None) -> bool:
    """Whether this number of rows, before any of them is made, is too large for memory; that is
    noted at `path`, the place of the number. `per_row`: `numbers_per_row`; None of rows that are
    made part by part, of which no one would see the end."""
    if per_row is None:
        if rows <= MOST_ROWS:
            return False
        text, hint = f"the run has too many rows, {rows:.12g}", "take a larger step"
        fields.error("too-many-rows", path, text, hint, limit=f"{MOST_ROWS:.12g} rows")
        return True
    numbers = rows * per_row
    if numbers <= MOST_NUMBERS:
        return False
    fields.error(
        "too-many-numbers",
        path,
        f"the run has too many numbers, {rows:.12g} rows of {per_row}",
        "take a larger step or fewer columns, or split the sweep into several files",
        measured=f"{numbers:.12g} numbers",
        limit=f"{MOST_NUMBERS} numbers, {MOST_NUMBERS // per_row} rows",
        numbers=(Number("numbers", float(numbers), limit=MOST_NUMBERS),),
    )
    return True


def fit_lines(fields: Fields, grid: tuple[int, int], per_row: int) -> bool:
    """Whether two lines of a grid fit in memory, as parts of its rows have; else that is noted."""
    (_, width), most = grid, MOST_NUMBERS // per_row // 2
    if width <= most:
        return True
    text = f"lines of the grid have too many rows to be held, {width}"
    hint = "exchange the inputs, so that the one with fewer values is the second; or take fewer"
    limit = f"{most} rows"
    fields.error("too-many-rows", ("motion", "inputs"), text, hint, limit=limit)
    fields.failed.add(SWEEP)
    return False


def numbers_per_row(file: MechanismFile, joints: Mapping[str, Joint]) -> int:
    """The numbers of each row of the file's run in memory: the cells of all tables, the columns of
    rows.csv and the freedoms of all joints."""
    motion = file.motion
    inputs = list(motion.inputs) if motion else []
    cells = sum(len(table.columns) for table in file.tables)
    if not file.tables:
        names = told_coordinates(joints.values())
        timed = motion is not None and motion.time is not None
        cells = len(default_table(names, inputs, timed=timed).columns)
    freedoms = sum(joint.type.freedoms for joint in joints.values())
    return cells + _ROW_COLUMNS + len(inputs) + freedoms


EXACT = 2**53
"""Whole numbers up to this one are doubles."""


SAMPLE = 4096
"""Steps of a sample of the rows of a long run."""


def sampled(run_rows: int) -> NDArray[np.int64]:
    """The numbers of some rows of a run, first and last among them."""
    places = np.linspace(0.0, 1.0, SAMPLE + 1) * (run_rows - 1)
    return np.unique(np.rint(places).astype(np.int64))


def is_long(run_rows: int, per_row: int | None) -> bool:
    """Whether the rows of a run are made part by part."""
    return run_rows > LONG_RUN or run_rows * (per_row or 1) > MOST_NUMBERS


class Steps(NamedTuple):
    """Value number i of `rows` is (first + i*step) / over in whole numbers that doubles hold
    exactly; where `over` is 0, first + i*step in doubles, and `last` the last one. The kernel makes
    moments by the same operations (`SpacedTimes`)."""

    rows: int
    first: float
    step: float
    over: float = 0.0
    last: float = 0.0

    def at(self, rows: NDArray[np.int64]) -> Floats:
        """The values of some rows, by their numbers (rows,)."""
        if self.over:
            whole = int(self.first) + rows.astype(np.int64) * int(self.step)
            return np.asarray(whole, dtype=np.float64) / self.over
        values = np.asarray(self.first + rows * self.step, dtype=np.float64)
        return np.where(rows == self.rows - 1, self.last, values)


class Spacing(NamedTuple):
    """Equally spaced values, one for each row: from the first towards the last by a positive step,
    or without one to the last. `name` is that of recorded numbers among these."""

    first: float
    last: float
    step: float | None
    rows: int
    name: str = ""

    def values(self, rows: NDArray[np.int64] | None = None) -> Floats:
        """The values in some rows, by their numbers from 0 (rows,); None: in all. Of recorded
        numbers they are inputs of their tape, as no operation of one goes by decimals."""
        recorder = self._recorder if self.name else None
        if recorder is not None:
            if self.step is None:
                return recorder.take(self.name, partial(_counted, self.rows), self.first, self.last)
            return recorder.take(self.name, _stepped, self.first, self.last, self.step)
        return self.steps.at(np.arange(self.rows) if rows is None else rows)

    @property
    def steps(self) -> Steps:
        """How the values follow from the numbers of their rows; none of them is recorded."""
        gaps, rows = self.rows - 1, self.rows
        if self.step is not None:
            step = self.step if self.last >= self.first else -self.step
            (start, stride), power = _whole_numbers(self.first, step)
            if power <= EXACT and _is_exact(start, stride, rows):
                return Steps(rows, start, stride, float(power))
            return Steps(rows, self.first, step, last=self.first + gaps * step)
        if not gaps:
            return Steps(rows, self.first, 0.0, last=self.first)
        (start, end), power = _whole_numbers(self.first, self.last)
        if power * gaps <= EXACT and _is_exact(start * gaps, end - start, rows):
            return Steps(rows, start * gaps, end - start, float(power * gaps))
        return Steps(rows, self.first, self.last / gaps - self.first / gaps, last=self.last)

    @property
    def _recorder(self) -> Recorder | None:
        """That of the numbers, if they are recorded."""
        for number in (self.first, self.last, self.step):
            if isinstance(number, Traced):
                recorder: Recorder = number.recorder
                return recorder
        return None


def _counted(count: int, first: float, last: float) -> Floats:
    """`count` values; none where they are not finite."""
    if not isfinite(last - first):
        return np.empty(0)
    return Spacing(first, last, None, count).values()


def _stepped(first: float, last: float, step: float) -> Floats:
    """The values a positive step apart; none where they are without end."""
    ratio = abs(last - first) / step + LAST_ROW if step else inf
    if not ratio < MOST_NUMBERS:
        return np.empty(0)
    return Spacing(first, last, step, int(ratio) + 1).values()


def _whole_numbers(*values: float) -> tuple[tuple[int, ...], int]:
    """Whole numbers and the power of ten over which they are the values' shortest decimals."""
    decimals = [Decimal(repr(float(value))) for value in values]
    exponents = [int(number.as_tuple().exponent) for number in decimals]
    power = 10 ** max(0, *(-exponent for exponent in exponents))
    return tuple(int(number * power) for number in decimals), power


def _is_exact(start: int, stride: int, count: int) -> bool:
    """Whether start + i*stride of all `count` rows are exact doubles."""
    return max(abs(start), abs(stride), abs(start + (count - 1) * stride)) <= EXACT


def spacing(
    fields: Fields,
    path: Path,
    section: SweptInput | TimeSection,
    dimension: Dimension,
    per_row: int | None,
) -> Spacing:
    """The values or moments of the rows in the file's units: n = floor(|to - from|/|step| + 1e-9) +
    1 values x_i = from + i*step, or `count` values. Errors are noted in `fields`, with one
    value."""
    errors = fields.error_count
    first = fields.written((*path, "from"), section.first, dimension)
    last = fields.written((*path, "to"), section.last, dimension)
    one = Spacing(first, first, None, 1)
    name = ".".join(map(str, path)) if isinstance(section, SweptInput) else ""
    if section.count is not None:
        at = (*path, "count")
        if fields.error_count > errors or has_too_many_rows(fields, at, section.count, per_row):
            return one
        return Spacing(first, last, None, section.count, name)
    assert section.step is not None  # the schema wants one of the two
    step = abs(fields.written((*path, "step"), section.step, dimension))
    if fields.error_count > errors:
        return one
    if step == 0.0:
        if first != last:
            hint = "give the distance of rows"
            fields.error("zero-step", (*path, "step"), "the step is zero", hint)
        return one
    ratio = as_recorded(abs(last - first) / step) + LAST_ROW
    rows = floor(ratio) + 1 if isfinite(ratio) else ratio
    if has_too_many_rows(fields, (*path, "step"), rows, per_row):
        return one
    return Spacing(first, last, step, int(ratio) + 1, name)
