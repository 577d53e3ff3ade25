"""The motion of the inputs over the rows."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.mechanism.pairs import is_angle
from mechkin_cli.record import NamedTuple, dataclass, field, replace
from mechkin_cli.tape import differ
from mechkin_cli.tolerances import AT_LIMIT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.diagnostics import Diagnostic, Place
    from mechkin_cli.kernel import _kernel
    from mechkin_cli.mechanism.constraint import InputConstraint
    from mechkin_cli.show import Bools, Floats
    from mechkin_cli.tape import ExactRows, Tape
    from mechkin_cli.units import Dimension
    from mechkin_cli.verdict import Status


ORDERS = ("", "_dot", "_ddot", "_dddot")
"""What the names of a coordinate's derivatives end in, from order 0 on."""


class DrivenInput(NamedTuple):
    """One driven coordinate over the rows, in rad, m and s.

    `written_orders` (4, rows) holds values, rates, accelerations and jerks in the file's units, as
    they were written. `follows` says whether it is an expression of other inputs.
    """

    joint: str
    coordinate: str
    values: Floats
    rates: Floats
    accelerations: Floats
    jerks: Floats
    written_orders: Floats
    follows: bool = False

    @property
    def name(self) -> str:
        """The coordinate's full name, `O1.theta`."""
        return f"{self.joint}.{self.coordinate}"

    @property
    def written(self) -> Floats:
        """Values in the file's units, as written."""
        values: Floats = self.written_orders[0]
        return values

    @property
    def orders(self) -> dict[str, tuple[Floats, Floats]]:
        """In SI and as written, by name: `O1.theta`, `O1.theta_dot`, ..."""
        in_si = (self.values, self.rates, self.accelerations, self.jerks)
        names = (self.name + suffix for suffix in ORDERS)
        return dict(zip(names, zip(in_si, self.written_orders, strict=True), strict=True))

    def part(self, rows: slice) -> DrivenInput:
        """Some of the rows."""
        return self._replace(
            values=self.values[rows],
            rates=self.rates[rows],
            accelerations=self.accelerations[rows],
            jerks=self.jerks[rows],
            written_orders=self.written_orders[:, rows],
        )


class Moments(NamedTuple):
    """The moments of the rows in s, and as written in the file's units."""

    values: Floats
    written: Floats

    @property
    def rows(self) -> int:
        """How many there are."""
        return int(self.values.size)

    @property
    def duration(self) -> float:
        """From the first to the last, s."""
        return float(self.values[-1] - self.values[0])

    def part(self, rows: slice) -> Moments:
        """Those of some neighbouring rows."""
        return Moments(self.values[rows], self.written[rows])


class SpacedMoments:
    """What `Moments` has, of very many that are equally spaced: they are made as they are wanted.

    Args:
        rows: how many.
        written: gives them in the file's units, by the numbers of rows.
        in_si: makes moments in the file's units (rows,) those in s.
        steps: by which the kernel makes them.
    """

    def __init__(
        self,
        rows: int,
        written: Callable[[NDArray[np.int64]], Floats],
        in_si: Callable[[Floats], Floats],
        steps: _kernel.SpacedTimes,
    ) -> None:
        self.rows, self.steps = rows, steps
        self._written, self._in_si = written, in_si

    @property
    def values(self) -> Floats:
        """In s (rows,), all of them."""
        return self.part(slice(None)).values

    @property
    def written(self) -> Floats:
        """In the file's units (rows,), all of them."""
        return self.part(slice(None)).written

    @property
    def duration(self) -> float:
        """From the first to the last, s."""
        return self.steps.at(self.rows - 1) - self.steps.at(0)

    def part(self, rows: slice) -> Moments:
        """Those of some neighbouring rows."""
        return self.at(np.arange(*rows.indices(self.rows)))

    def at(self, rows: NDArray[np.int64]) -> Moments:
        """Those of some rows, by their numbers."""
        written = self._written(rows)
        return Moments(self._in_si(written.copy()), written)

    def beside(self, written: Floats) -> tuple[Floats, Floats]:
        """Of times (times,) from the first moment to the last, the moments next to each, below and
        above it; all in the file's unit."""
        first, last = self._written(np.array([0, self.rows - 1])).tolist()
        number = np.floor((written - first) / (last - first) * (self.rows - 1)).astype(np.int64)
        # rounding may be off by one
        near = np.clip(number[:, None] + np.arange(-1, 3), 0, self.rows - 1)
        moments = self._written(near.ravel()).reshape(near.shape)
        place = np.clip(np.count_nonzero(moments < written[:, None], axis=1), 1, 3)
        row = np.arange(place.size)
        return moments[row, place - 1], moments[row, place]


class Limit(NamedTuple):
    """Where a coordinate ends (rad, m): its least and its largest value, infinite where there is
    none; `place` in the file. A response rebounds there by the `restitution`, where there is one,
    else it ends."""

    joint: str
    coordinate: str
    low: float
    high: float
    place: Place
    restitution: float | None = None

    @property
    def name(self) -> str:
        """The coordinate's full name, `O1.theta`."""
        return f"{self.joint}.{self.coordinate}"

    def beyond(self, values: Floats, length: float) -> Floats:
        """By how much values of the coordinate lie beyond its limits: negative below the least,
        positive above the largest one, 0 within or at them, as far as rounding of a mechanism of
        some `length` (m) leaves it open; nan stays."""
        slack = AT_LIMIT * (1.0 if is_angle(self.coordinate) else length)
        below, above = values - self.low, values - self.high
        return np.where(above > slack, above, np.where(below < -slack, below, 0.0 * values))


class Span(NamedTuple):
    """Which of the rows of a run are meant: the number of the first one, how many they are, and how
    many the run has."""

    first: int
    rows: int
    run_rows: int


class Rest(NamedTuple):
    """Which inputs of a sweep nothing drives, by number: in each row they are where the loads
    balance. `names`: those of the file (joint, coordinate), which may be others. `course`: that of
    the driven inputs, where they move by laws or follow others. `solved`: the rows' values are
    those; then the rows from `first` to `last` have one, and the `ends` say with which status and
    words the others have none."""

    inputs: tuple[int, ...]
    names: tuple[tuple[str, str], ...] = ()
    course: Course | None = None
    solved: bool = False
    first: int = 0
    last: int = 0
    ends: tuple[tuple[Status, Diagnostic], ...] = ()
    notes: tuple[Diagnostic, ...] = ()

    @property
    def rows(self) -> int:
        """How many rows have an equilibrium."""
        return self.last + 1 - self.first

    def part(self, first: int, last: int) -> Rest:
        """That of the rows from `first` to `last`, both included."""
        rows = last + 1 - first
        begin, end = self.first - first, self.last - first
        course = None if self.course is None else self.course.part(first, last)
        return self._replace(
            course=course, first=min(max(begin, 0), rows), last=min(max(end, -1), rows - 1)
        )


class MotionInputs(NamedTuple):
    """All inputs; a mechanism without inputs has one row. `time` is there where the file has it,
    `course` where inputs move by laws or follow others; `paths` are all inputs as functions of each
    one that others follow (`building.course`). Of `constraints` between inputs `constraint_rates`
    (constraints, rows) are the rates of the input by its leader. `unrated` are the inputs that rest
    only since the file gives them no rate. `grid`: how many values each of the two inputs has whose
    pairs are the rows, the slow one first. Of a part of a longer run `span` says which it is, and
    `leader` the number of the run's leading input. `rest`: what nothing drives, where there is
    any."""

    inputs: tuple[DrivenInput, ...]
    rows: int
    time: Moments | None = None
    course: Course | None = None
    paths: tuple[tuple[str, Tape], ...] = ()
    constraints: tuple[InputConstraint, ...] = ()
    constraint_rates: Floats | None = None
    unrated: tuple[str, ...] = ()
    grid: tuple[int, int] | None = None
    span: Span | None = None
    leader: int | None = None
    rest: Rest | None = None

    @property
    def without_numbers(self) -> MotionInputs:
        """The inputs of a part by their names, and whether there is time."""
        none = np.empty(0)
        items = tuple(
            DrivenInput(item.joint, item.coordinate, none, none, none, none, np.empty((4, 0)))
            for item in self.inputs
        )
        time = None if self.time is None else Moments(none, none)
        leader = self.leading_number
        return MotionInputs(items, 0, time, span=self.span, leader=leader, rest=self.rest)

    def part(self, first: int, last: int) -> MotionInputs:
        """The rows from `first` to `last`, both included, of a motion that is no grid."""
        assert self.grid is None
        rows = slice(first, last + 1)
        time, course, rates = self.time, self.course, self.constraint_rates
        return self._replace(
            inputs=tuple(item.part(rows) for item in self.inputs),
            rows=last + 1 - first,
            time=None if time is None else Moments(time.values[rows], time.written[rows]),
            course=None if course is None else course.part(first, last),
            constraint_rates=None if rates is None else rates[:, rows],
            span=Span(first, last + 1 - first, self.rows),
            leader=self.leading_number,
            rest=None if self.rest is None else self.rest.part(first, last),
        )

    @property
    def driven(self) -> list[tuple[str, str]]:
        """(joint, coordinate) of the inputs."""
        return [(i.joint, i.coordinate) for i in self.inputs]

    @property
    def leading(self) -> DrivenInput | None:
        """The first input that moves over the rows of the run; the first of all if none does."""
        return self.inputs[self.leading_number] if self.inputs else None

    @property
    def leading_number(self) -> int:
        """The number of that input; 0 where there is none."""
        if self.leader is not None:
            return self.leader
        moving = (number for number, item in enumerate(self.inputs) if differ(item.values))
        return next(moving, 0)


@dataclass(frozen=True)
class Assembly:
    """Which assembly is meant at the first row: near some coordinates (rad, m), a mode, or
    neither; `straight`: branch points are passed along the smooth continuation."""

    near: Mapping[str, float] = field(default_factory=dict)
    mode: str | None = None
    turns: int = 1
    straight: bool = False


# The course of the inputs: their laws between the rows, as data.
#
# A course is a function of one parameter (the time, the one input that others follow, or the number
# of the row where several are swept together), recorded as a tape. It is smooth on each *cell*
# between two kinks; `places` are the rows and, between them, the ends of cells that the motion
# passes.


class CellKind(IntEnum):
    """What moves on a cell: nothing or one input, so that it is straight, or several."""

    STRAIGHT = 0
    CURVED = 1


class Parameter(NamedTuple):
    """What the course is a function of: `time`, an input by its name, or `row`."""

    name: str
    dimension: Dimension | None = None


@dataclass(frozen=True, eq=False)
class Course:
    """Inputs as a function of a parameter in the file's units.

    Attributes:
        parameter: what the tape's first input is.
        tape: from the parameter and the constants of a cell to the inputs in SI.
        edges: (cells + 1,) values of the parameter, rising.
        kinds: (cells,) of `CellKind`.
        constants: (cells, tape inputs - 1).
        ways: (cells, switches) which way each choice of the tape goes.
        powers: (cells, 2) order in which the inputs leave the lower and the upper end: 1, or more
            where all of them rest.
        rows: (places,) number of the row, -1 between rows.
        at: (places,) the parameter.
        values: (inputs, places) in SI.
        cells: (places - 1,) the cell between a place and the next; -1 where the motion jumps.
    """

    parameter: Parameter
    tape: Tape
    edges: Floats
    kinds: NDArray[np.int8]
    constants: Floats
    ways: Floats
    powers: NDArray[np.int64]
    rows: NDArray[np.int64]
    at: Floats
    values: Floats
    cells: NDArray[np.int64]

    @property
    def bends(self) -> Bools:
        """Inner edges (cells - 1,) at which the inputs pass from one formula to another; at the
        others they turn."""
        changed = (self.constants[1:] != self.constants[:-1]).any(axis=1)
        bends: Bools = changed | (self.ways[1:] != self.ways[:-1]).any(axis=1)
        return bends

    @property
    def ends(self) -> Floats:
        """The parameters at which a formula ends: where the inputs bend, and the last one."""
        return np.append(self.edges[1:-1][self.bends], self.edges[-1])

    def part(self, first: int, last: int) -> Course:
        """The places from the row `first` to the row `last`, whose numbers begin with 0."""
        # rows stand in order, with the ends of cells between them
        begin, end = np.flatnonzero((self.rows == first) | (self.rows == last))[[0, -1]].tolist()
        places = slice(begin, end + 1)
        rows = self.rows[places]
        return replace(
            self,
            rows=np.where(rows < 0, -1, rows - first),
            at=self.at[places],
            values=self.values[:, places],
            cells=self.cells[begin:end],
        )


# The motion of the inputs as the text says it: numbers over the rows, on a recording.


class ExactMotion(NamedTuple):
    """Inputs by name, each with value, rate, acceleration and jerk; `time` has its value alone.

    Attributes:
        rows: holds the numbers that differ from row to row.
        in_si: in rad, m and s.
        written: in the file's units.
        constraint_rates: as `MotionInputs` has them, in SI.
    """

    rows: ExactRows
    in_si: Mapping[str, Any]
    written: Mapping[str, Any]
    constraint_rates: tuple[Any, ...] = ()
