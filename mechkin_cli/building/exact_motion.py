"""The motion of a file over its rows, on a recording of the exact numbers of its text.

The formulas are those of `building.motion`, `building.laws` and `building.law_shapes`. Which rows
there are, and in which piece of a law they lie, is decided by the doubles.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.building.fields import Clock, Fields, Path, dimension_of
from mechkin_cli.building.law_reading import over_moments, read_law
from mechkin_cli.building.law_shapes import Orders
from mechkin_cli.expressions import Expression, Quantity, literal, parse, scalar
from mechkin_cli.mechanism import ExactMotion
from mechkin_cli.record import dataclass, field
from mechkin_cli.schema import (
    FollowingInput,
    HeldInput,
    Law,
    ListedInput,
    MotionSection,
    SweptInput,
    TimeSection,
)
from mechkin_cli.tape import ExactRows, JetNumber, orders_of
from mechkin_cli.units import TIME, UnitSystem

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.mechanism import MotionInputs, ResponseProblem
    from mechkin_cli.schema import HeldCoordinate, ListedTime
    from mechkin_cli.tape import ExactRecorder
    from mechkin_cli.units import Dimension


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


def exact_moment(fields: Fields, path: Path, text: str | None, over: ExactRows) -> Any:
    """The moment of equilibria in the file's unit, 0 where none is written."""
    number = 0.0 if text is None else fields.written(path, text, TIME)
    return over.picked([number], np.zeros(over.rows, dtype=np.intp))


def start_motion(
    fields: Fields,
    response: ResponseProblem,
    recorder: ExactRecorder,
    held: Mapping[str, HeldCoordinate] = MappingProxyType({}),
) -> ExactMotion:
    """The first moment of a response, as that of `mechanism.response.first_motion` in doubles.

    Args:
        fields: units and parameters, recorded.
        response: with its start recorded and nothing driven.
        recorder: holds the recorded numbers.
        held: coordinates that are held, as written.
    """
    first = response.moments.part(slice(1))
    in_si: dict[str, Any] = {"time": float(first.values[0])}
    written: dict[str, Any] = {"time": float(first.written[0])}
    for name, one in held.items():
        path: Path = (response.section, response.name, "driven", name, "at")
        dimension = dimension_of(name.rpartition(".")[2])
        value = fields.written(path, one.at, dimension)
        written[name] = (value, 0.0, 0.0, 0.0)
        in_si[name] = (fields.units.to_si(value, dimension), 0.0, 0.0, 0.0)
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
        self.clock = Clock(self.motion.time, first, last, self.motion.rows)

    def add(self, name: str, item: SweptInput | ListedInput | HeldInput | Law) -> None:
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
        else:
            assert self.clock is not None
            law = read_law(self.fields, path, item, dimension, over_moments(self.clock))
            at = self.clock.time.written
            self._put(name, law.recorded(self.rows, self.moment, at))

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
