"""The motion of a file over its rows, on a recording of the exact numbers of its text.

The formulas are those of `building.motion`, `building.laws` and `building.course`. Which rows there
are, and on which side of a rise and in which piece of a table they lie, is decided by the doubles.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from math import pi, prod
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.building.fields import Clock, Fields, Path, dimension_of
from mechkin_cli.building.load_laws import joining_of, read_rows
from mechkin_cli.exact import PI, TURN, Exact
from mechkin_cli.expressions import Expression, Quantity, literal, parse, scalar
from mechkin_cli.mechanism import ExactMotion, joined_curve
from mechkin_cli.record import dataclass, field
from mechkin_cli.schema import (
    ConstantAcceleration,
    ConstantRate,
    Cycloidal,
    FollowingInput,
    Harmonic,
    HeldInput,
    Law,
    ListedInput,
    MotionSection,
    Polynomial,
    SweptInput,
    TableLaw,
    TimeSection,
    WithRates,
)
from mechkin_cli.show import Floats
from mechkin_cli.tape import ExactRows, JetNumber, as_recorded, cos, orders_of, sin
from mechkin_cli.units import TIME, Conversion, UnitSystem, conversion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import MotionInputs, ResponseProblem
    from mechkin_cli.schema import ListedTime
    from mechkin_cli.tape import ExactRecorder
    from mechkin_cli.units import Dimension


PowerLaw = ConstantRate | ConstantAcceleration | Polynomial
"""x = c0 + c1 t + c2 t^2 + ..., with t from the first moment of `time`."""


def coefficients(fields: Fields, path: Path, law: PowerLaw, coordinate: str) -> list[float]:
    """c0, c1, ..., where c_k is in the file's unit of the coordinate's derivative of order k.

    Errors are noted in `fields`; zeros replace their values.
    """
    written: list[tuple[Path, str]]
    if isinstance(law, Polynomial):
        written = [(("coefficients", k), text) for k, text in enumerate(law.coefficients)]
    else:
        written = [(("at",), law.at), (("rate",), law.rate)]
    if isinstance(law, ConstantAcceleration):
        written.append((("acceleration",), law.acceleration))
    numbers = [
        fields.written((*path, *key), text, dimension_of(coordinate, k))
        for k, (key, text) in enumerate(written)
    ]
    if isinstance(law, ConstantAcceleration):
        numbers[2] /= 2.0
    return numbers


def span(
    fields: Fields, path: Path, law: Harmonic | Cycloidal, clock: Clock
) -> tuple[float, float]:
    """Start and duration of a rise in the file's unit of time.

    Errors are noted in `fields`; a duration of one replaces a wrong one.
    """
    errors = fields.error_count
    start = clock.first
    if law.start is not None:
        start = fields.written((*path, "start"), law.start, TIME)
    if law.duration is not None:
        duration = fields.written((*path, "duration"), law.duration, TIME)
        place: Path = (*path, "duration")
    else:
        duration, place = clock.last - start, (*path, "start") if law.start is not None else path
    if duration > 0.0:
        return start, duration
    if fields.error_count == errors:
        hint = "give start and duration so that there is time for it"
        measured = f"{duration:g} {fields.units.label(TIME)}"
        fields.error("no-duration", place, "a rise takes a positive time", hint, measured=measured)
    return start, 1.0


def over_time(units: UnitSystem, coordinate: str, have: int, want: int) -> Conversion:
    """From the unit of order `have` times the unit of time to have - want, to that of order
    `want`."""
    before = units.unit(dimension_of(coordinate, have)) * units.unit(TIME ** (have - want))
    return conversion(before.factor / units.unit(dimension_of(coordinate, want)).factor)


Orders = tuple[Any, Any, Any, Any]
"""Value, rate, acceleration, jerk; each a number of the rows or one for all of them."""

_HALF_TURN = Exact(pi, PI)


def exact_motion(
    fields: Fields, section: MotionSection | None, motion: MotionInputs, recorder: ExactRecorder
) -> ExactMotion:
    """A motion without errors over its rows.

    Args:
        fields: units and parameters, recorded; numbers are read as recorded ones.
        section: the motion as written.
        motion: the same in doubles.
        recorder: holds the recorded numbers.

    Raises:
        TraceLost: an input depends on the text in a way that no tape holds.
    """
    rows = ExactRows(recorder, motion.rows)
    if section is None:
        return ExactMotion(rows, {}, {})
    reading = _Reading(fields, section, motion, rows)
    if section.time is not None:
        reading.read_time(section.time)
    for name, item in section.inputs.items():
        if not isinstance(item, FollowingInput):
            reading.add(name, item)
    reading.follow({n: i for n, i in section.inputs.items() if isinstance(i, FollowingInput)})
    written, in_si = dict(reading.written), dict(reading.in_si)
    if section.time is not None:
        written["time"] = reading.moment
        in_si["time"] = fields.units.to_si(reading.moment, TIME)
    return ExactMotion(rows, in_si, written, reading.constraint_rates(motion))


def exact_moments(
    fields: Fields, path: Path, section: TimeSection | ListedTime, over: ExactRows
) -> Any:
    """The moments of a response's rows in the file's unit."""
    if isinstance(section, TimeSection):
        return _spaced(fields, over, path, section, TIME)
    texts = enumerate(section.values)
    listed = [fields.written((*path, "values", i), text, TIME) for i, text in texts]
    return over.picked(listed, np.arange(over.rows))


def start_motion(fields: Fields, response: ResponseProblem, recorder: ExactRecorder) -> ExactMotion:
    """The first moment of a response, as that of `mechanism.response.first_motion` in doubles.

    Args:
        fields: units and parameters, recorded.
        response: with its start recorded and nothing driven.
        recorder: holds the recorded numbers.
    """
    in_si: dict[str, Any] = {"time": float(response.moments.values[0])}
    written: dict[str, Any] = {"time": float(response.moments.written[0])}
    for item in response.start:
        if item.value is not None:
            orders = (item.value, 0.0 if item.rate is None else item.rate, 0.0, 0.0)
            in_si[item.name] = orders
            written[item.name] = _in_file_units(fields.units, item.coordinate, orders)
    return ExactMotion(ExactRows(recorder, 1), in_si, written)


def _in_file_units(units: UnitSystem, coordinate: str, orders: Orders) -> Orders:
    a, b, c, d = (units.from_si(x, dimension_of(coordinate, k)) for k, x in enumerate(orders))
    return a, b, c, d


@dataclass
class _Reading:
    """Inputs by name: orders in the file's units and in SI."""

    fields: Fields
    section: MotionSection
    motion: MotionInputs
    rows: ExactRows
    written: dict[str, Any] = field(default_factory=dict)
    in_si: dict[str, Any] = field(default_factory=dict)
    expressions: dict[str, Expression] = field(default_factory=dict)
    moment: Any = None
    clock: Clock | None = None

    def read_time(self, section: TimeSection) -> None:
        """The moments of the rows in the file's unit."""
        path: Path = ("motion", "time")
        self.moment = _spaced(self.fields, self.rows, path, section, TIME)
        first = self.fields.written((*path, "from"), section.first, TIME)
        last = self.fields.written((*path, "to"), section.last, TIME)
        assert self.motion.time is not None
        self.clock = Clock(self.motion.time, first, last)

    def add(self, name: str, item: WithRates | Law) -> None:
        """An input that does not follow others."""
        path: Path = ("motion", "inputs", name)
        coordinate = name.rpartition(".")[2]
        dimension = dimension_of(coordinate)
        if isinstance(item, (SweptInput, ListedInput, HeldInput)):
            value: Any
            if isinstance(item, HeldInput):
                value = self.fields.written((*path, "at"), item.at, dimension)
            elif isinstance(item, ListedInput):
                texts = enumerate(item.values)
                listed = [
                    self.fields.written((*path, "values", i), text, dimension) for i, text in texts
                ]
                which = self._place(name) if len(listed) > 1 else np.zeros(1, dtype=np.intp)
                value = self.rows.picked(listed, np.resize(which, self.rows.rows))
            else:
                place = self._place(name)
                value = _spaced(self.fields, self.rows, path, item, dimension, place)
            rates = [
                self.fields.written((*path, key), getattr(item, key), dimension_of(coordinate, k))
                for k, key in enumerate(("rate", "acceleration", "jerk"), start=1)
            ]
            self._put(name, (value, *rates))
        elif isinstance(item, Harmonic | Cycloidal):
            self._put(name, self._rise(path, item, coordinate))
        elif isinstance(item, TableLaw):
            self._put(name, self._table(path, item, coordinate))
        elif isinstance(item, PowerLaw):
            self._put(name, self._power_series(path, item, coordinate))

    def _place(self, name: str) -> NDArray[np.intp]:
        """The place of each row (rows,) among the values of an input."""
        rows = np.arange(self.rows.rows)
        if self.motion.grid is None:
            return rows
        slow, fast = np.divmod(rows, self.motion.grid[1])
        return slow if name == self.section.with_rows[0] else fast

    def follow(self, sections: Mapping[str, FollowingInput]) -> None:
        """The inputs that follow others, each after those that it follows."""
        coordinates = set(self.section.inputs)
        waiting: dict[str, Expression] = {}
        for name, item in sections.items():
            path: Path = ("motion", "inputs", name, "with")
            dimension = dimension_of(name.rpartition(".")[2])
            if literal(item.value) is None:
                waiting[name] = parse(item.value).taking_whole(coordinates)
            else:
                self._put(name, (self.fields.written(path, item.value, dimension), 0.0, 0.0, 0.0))
        while waiting:
            name = next(n for n in waiting if not waiting[n].names & waiting.keys())
            self.expressions[name] = expression = waiting.pop(name)
            coordinate = name.rpartition(".")[2]
            orders = self._followed(expression, coordinate, self._quantity)
            self.in_si[name] = orders
            self.written[name] = _in_file_units(self.fields.units, coordinate, orders)

    def constraint_rates(self, motion: MotionInputs) -> tuple[Any, ...]:
        """The rates of constrained inputs by those of their leaders, in the motion's order."""
        names = [item.name for item in motion.inputs]
        rates = []
        for number, leader in motion.constraints:
            seeds: dict[str, Any] = {
                name: (self.in_si[name][0], float(name == names[leader]), 0.0, 0.0)
                for name in self.in_si
            }
            for name, expression in self.expressions.items():
                if name == names[leader]:
                    continue
                resolve = partial(self._quantity, seeds=dict(seeds))
                seeds[name] = self._followed(expression, name.rpartition(".")[2], resolve)
            rates.append(seeds[names[number]][1])
        return tuple(rates)

    def _followed(self, expression: Expression, coordinate: str, resolve: Any) -> Orders:
        value = scalar(expression, dimension_of(coordinate), self.fields.units, resolve)
        return orders_of(value)

    def _quantity(self, name: str, seeds: Mapping[str, Any] | None = None) -> Quantity:
        known = self.in_si if seeds is None else seeds
        moving: Any
        if name in known:
            moving = JetNumber(known[name])
            return Quantity(moving, dimension_of(name.rpartition(".")[2]))
        if name == "time" and self.moment is not None:
            rate = 1.0 if seeds is None else 0.0
            moving = JetNumber([self.fields.units.to_si(self.moment, TIME), rate, 0.0, 0.0])
            return Quantity(moving, TIME)
        return self.fields.resolve(name)

    def _put(self, name: str, orders: Orders) -> None:
        coordinate, to_si = name.rpartition(".")[2], self.fields.units.to_si
        self.written[name] = orders
        self.in_si[name] = tuple(
            to_si(order, dimension_of(coordinate, k)) for k, order in enumerate(orders)
        )

    def _power_series(self, path: Path, law: PowerLaw, coordinate: str) -> Orders:
        written = coefficients(self.fields, path, law, coordinate)
        assert self.clock is not None
        t = self.moment - self.clock.first
        orders: list[Any] = []
        for order in range(4):
            total: Any = 0.0
            for k in range(len(written) - 1, order - 1, -1):
                factor = float(prod(range(k - order + 1, k + 1)))
                conversion = over_time(self.fields.units, coordinate, k, order)
                term = conversion.apply(written[k] * factor)
                total = term if k == len(written) - 1 else total * t + term
            orders.append(total)
        return orders[0], orders[1], orders[2], orders[3]

    def _rise(self, path: Path, law: Harmonic | Cycloidal, coordinate: str) -> Orders:
        dimension, clock = dimension_of(coordinate), self.clock
        assert clock is not None
        first: Any = self.fields.written((*path, "from"), law.first, dimension)
        last: Any = self.fields.written((*path, "to"), law.last, dimension)
        start, duration = span(self.fields, path, law, clock)
        at = (clock.time.written - as_recorded(start)) / as_recorded(duration)
        rising = self._where((at >= 0.0) & (at <= 1.0))
        risen = self._where(at >= 1.0)
        u = (self.moment - start) / duration
        rise: Any = last - first
        shape = _harmonic(u) if isinstance(law, Harmonic) else _cycloidal(u)
        orders: list[Any] = [rising.choose(first + rise * shape[0], risen.choose(last, first))]
        for order in (1, 2, 3):
            rise = rise / duration
            conversion = over_time(self.fields.units, coordinate, 0, order)
            orders.append(rising.choose(conversion.apply(rise * shape[order]), 0.0))
        return orders[0], orders[1], orders[2], orders[3]

    def _table(self, path: Path, law: TableLaw, coordinate: str) -> Orders:
        table = read_rows(self.fields, (*path, "file"), law.file, TIME, dimension_of(coordinate))
        assert table is not None
        assert self.clock is not None
        curve = joined_curve(*table, *joining_of(law))
        knots = np.array([as_recorded(x) for x in table[0]])
        piece = np.searchsorted(knots, self.clock.time.written, side="right") - 1
        piece = np.clip(piece, 0, knots.size - 1)

        def picked(numbers: Any) -> Any:
            return self.rows.picked(list(numbers), piece)

        y, b, c, d = (picked(row) for row in curve.coefficients)
        u = self.moment - picked(table[0])
        value = y + u * (b + u * (c + u * d))
        rates = b + u * (2.0 * c + u * (3.0 * d)), 2.0 * c + u * (6.0 * d), 6.0 * d
        first, second, third, fourth = (
            over_time(self.fields.units, coordinate, 0, k).apply(order)
            for k, order in enumerate((value, *rates))
        )
        return first, second, third, fourth

    def _where(self, rows: Any) -> Any:
        """A condition that holds in some rows, as decided by doubles."""
        chosen: Floats = rows.astype(np.float64)
        return self.rows.given(chosen) == 1.0


def _spaced(
    fields: Fields,
    over: ExactRows,
    path: Path,
    section: SweptInput | TimeSection,
    dimension: Dimension,
    place: NDArray[np.intp] | None = None,
) -> Any:
    """first + i step, or first + i (last - first)/(count - 1), with i the row, or its `place`."""
    first: Any = fields.written((*path, "from"), section.first, dimension)
    last: Any = fields.written((*path, "to"), section.last, dimension)
    place = np.arange(over.rows) if place is None else place
    if not place.any():
        return first
    number: Any = over.given(place.astype(np.float64))
    if section.count is not None:
        return first + number * (last - first) / float(section.count - 1)
    assert section.step is not None
    step: Any = abs(fields.written((*path, "step"), section.step, dimension))
    return first + number * (step if last >= first else -step)


def _harmonic(u: Any) -> Orders:
    """(1 - cos(pi u))/2 and its derivatives."""
    sine, cosine = sin(u * _HALF_TURN), cos(u * _HALF_TURN)
    return (
        (1.0 - cosine) / 2.0,
        sine * _HALF_TURN / 2.0,
        cosine * _HALF_TURN * _HALF_TURN / 2.0,
        -(sine * _HALF_TURN * _HALF_TURN * _HALF_TURN / 2.0),
    )


def _cycloidal(u: Any) -> Orders:
    """u - sin(2 pi u)/(2 pi) and its derivatives."""
    sine, cosine = sin(u * TURN), cos(u * TURN)
    return (u - sine / TURN, 1.0 - cosine, sine * TURN, cosine * TURN * TURN)
