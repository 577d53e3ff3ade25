"""The inputs over the rows and between them: from their laws, and those that follow others.

Laws are read by `law_reading`. The course of the inputs between the rows is recorded from their
laws, with inputs that follow others: `with:` an expression of their coordinates. Its parameter is
the time where there is one, else the one input that the others follow, else the number of the row.
Laws and expressions are recorded on a tape as they stand in the file; that tape shows where they
bend, jump or rest (`session.cells`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Clock, Fields, Path, dimension_of
from mechkin_cli.building.law_reading import AnyLaw, note_bends, over_moments, read_law
from mechkin_cli.building.law_shapes import Piece, PiecewiseLaw
from mechkin_cli.expressions import (
    Expression,
    ExpressionError,
    Jet,
    Quantity,
    UnknownName,
    constant_jet,
    derivatives,
    literal,
    parse,
    scalar,
)
from mechkin_cli.mechanism import Course, DrivenInput, Moments, Parameter
from mechkin_cli.schema import (
    FollowingInput,
    HeldCoordinate,
    HeldInput,
    Law,
    ListedInput,
    SweptInput,
)
from mechkin_cli.session import Formula, cells_of, places_of
from mechkin_cli.show import Floats
from mechkin_cli.tape import Recorder, Tape, Traced, TraceLost, is_traced, register
from mechkin_cli.units import TIME

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from mechkin_cli.schema import InputMotion
    from mechkin_cli.units import Dimension


def law_values(fields: Fields, path: Path, law: Law, coordinate: str, clock: Clock) -> Floats:
    """Value, rate, acceleration and jerk (4, rows) in the file's units.

    Errors are noted in `fields`; zeros stand in.
    """
    errors = fields.error_count
    dimension, over = dimension_of(coordinate), over_moments(clock)
    read = read_law(fields, path, law, dimension, over)
    orders = read.orders(clock.time.written)
    if fields.error_count > errors:
        return orders
    note_bends(fields, path, law, dimension, over)
    rows = np.flatnonzero(~np.isfinite(orders).all(axis=0))
    if rows.size:
        row = int(rows[0])
        moment = f"time = {clock.time.written[row]:.12g} {fields.units.label(TIME)}"
        number = row if clock.numbers is None else int(clock.numbers[row])
        _note_undefined(fields, (*path, "value"), str(path[-1]), orders[:, row], number, moment)
        return np.zeros_like(orders)
    return orders


def _dimension(name: str) -> Dimension:
    return dimension_of(name.rpartition(".")[2])


_NO_LAWS = (SweptInput, ListedInput, HeldInput, FollowingInput, HeldCoordinate)


def build_course(
    fields: Fields,
    path: Path,
    sections: Mapping[str, InputMotion | HeldCoordinate],
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    clock: Clock | None,
    *,
    grid: bool,
) -> Course | None:
    """The course of inputs without errors; None where they only run straight from row to row.

    Args:
        fields: of the file, with units and parameters.
        path: of the section with the driven coordinates.
        sections: the coordinates as written.
        inputs: with their values in all rows, in the order of the file.
        expressions: of the inputs that follow, in an order in which they can be evaluated.
        clock: of the laws, where the rows are moments.
        grid: whether the rows are those of a grid.

    Raises:
        TraceLost: the inputs depend on a parameter that is recorded.
    """
    rows = inputs[0].values.size if inputs else 0
    if rows < 2 or not (expressions or clock is not None):
        return None
    if any(is_traced(item.values) for item in inputs):
        raise TraceLost("the course of inputs depends on a varied parameter")
    sources = _sources(fields, path, sections, inputs, expressions, clock, grid=grid)
    if sources is None:
        return None
    parameter, at, _ = sources
    formula = _recorded(fields, inputs, expressions, *sources)
    cells = cells_of(formula, at, None if clock is None else clock.beside)
    values = np.stack([item.values for item in inputs])
    return places_of(formula, cells, parameter, at, values)


def _sources(
    fields: Fields,
    path: Path,
    sections: Mapping[str, InputMotion | HeldCoordinate],
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    clock: Clock | None,
    *,
    grid: bool,
) -> tuple[Parameter, Floats, Mapping[str, AnyLaw]] | None:
    """The parameter, its values in the rows, and the inputs that are functions of it alone."""
    if clock is not None:
        laws = {
            name: read_law(fields, (*path, name), item, _dimension(name), over_moments(clock))
            for name, item in sections.items()
            if not isinstance(item, _NO_LAWS)
        }
        return Parameter("time", TIME), clock.time.written, laws
    moving = [i for i in inputs if i.name not in expressions and (i.written != i.written[0]).any()]
    follow = [i for i in inputs if i.name in expressions and (i.values != i.values[0]).any()]
    if not moving or not follow:
        return None
    if len(moving) == 1:
        name = moving[0].name
        itself = PiecewiseLaw([Piece(-inf, 0.0, polynomials=[[0.0, 1.0], [1.0], [], []])])
        dimension = dimension_of(moving[0].coordinate)
        return Parameter(name, dimension), moving[0].written, {name: itself}
    numbers = np.arange(moving[0].written.size, dtype=np.float64)
    chords = {
        i.name: _chords(i.written, isinstance(sections[i.name], SweptInput) and not grid)
        for i in moving
    }
    return Parameter("row"), numbers, chords


def _chords(written: Floats, even: bool) -> PiecewiseLaw:
    """Straight from row to row, in one piece where they are evenly spaced."""
    last = written.size - 1
    rises = [(written[-1] - written[0]) / last] if even else np.diff(written).tolist()
    pieces = []
    for k, (value, rise) in enumerate(zip(written.tolist(), rises, strict=False)):
        straight = [[value, float(rise)], [float(rise)], [], []]
        pieces.append(Piece(float(k) if k else -inf, 0.0, float(k), polynomials=straight))
    return PiecewiseLaw(pieces)


def _recorded(
    fields: Fields,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    parameter: Parameter,
    at: Floats,
    laws: Mapping[str, AnyLaw],
) -> Formula:
    """The tape from the parameter and the constants of all pieces to the inputs in SI."""

    def constants(place: float) -> list[float]:
        return [c for pieces in laws.values() for c in pieces.constants(place)]

    first = float(at[0])
    values = [first, *constants(first)]
    recorder = Recorder([f"c{k}" for k in range(len(values))], values)
    registers = [Traced(recorder, number) for number in range(len(values))]
    known: dict[str, Quantity] = {}
    if parameter.name == "time":
        moment: Any = registers[0]
        known["time"] = Quantity(fields.units.to_si(moment, TIME), TIME)
    used = 1
    for name, pieces in laws.items():
        dimension = dimension_of(name.rpartition(".")[2])
        count = len(pieces.constants(first))
        written: Any = pieces.value(registers[0], registers[used : used + count])
        known[name] = Quantity(fields.units.to_si(written, dimension), dimension)
        used += count
    tape = _tape(fields, inputs, expressions, known, recorder)
    return Formula(tape, [edge for pieces in laws.values() for edge in pieces.edges], constants)


def build_paths(
    fields: Fields,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    time: Moments | None,
) -> tuple[tuple[str, Tape], ...]:
    """Each input that others follow, and all inputs as a function of it in SI.

    The further inputs of a tape are those that follow none, in the order of the file, and the time
    where there is one.
    """
    free = [item for item in inputs if item.name not in expressions]
    leaders = {name for expression in expressions.values() for name in expression.names}
    others = [float(item.values[0]) for item in free]
    others += [] if time is None else [float(time.values[0])]
    paths = []
    for leader in free:
        if leader.name not in leaders:
            continue
        values = [float(leader.values[0]), *others]
        recorder = Recorder([f"c{k}" for k in range(len(values))], values)
        registers: list[Any] = [Traced(recorder, number) for number in range(len(values))]
        known = {}
        for k, item in enumerate(free, start=1):
            register = registers[0 if item is leader else k]
            known[item.name] = Quantity(register, dimension_of(item.coordinate))
        if time is not None:
            known["time"] = Quantity(registers[-1], TIME)
        paths.append((leader.name, _tape(fields, inputs, expressions, known, recorder)))
    return tuple(paths)


def _tape(
    fields: Fields,
    inputs: Sequence[DrivenInput],
    expressions: Mapping[str, Expression],
    known: dict[str, Quantity],
    recorder: Recorder,
) -> Tape:
    """The tape to all inputs in SI, from those `known`; evaluates the others."""

    def find(name: str) -> Quantity:
        return known[name] if name in known else fields.resolve(name)

    for item in inputs:
        if item.name not in known and item.name not in expressions:
            known[item.name] = Quantity(float(item.values[0]), dimension_of(item.coordinate))
    for name, expression in expressions.items():
        dimension = dimension_of(name.rpartition(".")[2])
        known[name] = Quantity(scalar(expression, dimension, fields.units, find), dimension)
    outputs = [register(recorder, known[item.name].value) for item in inputs]
    return recorder.tape(outputs, guarded=False)


def _note_undefined(
    fields: Fields, path: Path, name: str, orders: Floats, row: int, measured: str
) -> None:
    """Notes that an input has no finite value, or no such rate, in a row: `orders` (4,)."""
    words = ("value", "rate", "second rate", "third rate")
    order = int(np.argmax(~np.isfinite(orders)))
    fields.error(
        "undefined-rate" if order else "undefined-value",
        path,
        f"{name} has no finite {words[order]} in row {row + 1}",
        "write an expression that is smooth over all rows, or move the rows",
        measured=measured,
    )


class Following:
    """Evaluates the inputs that follow others, one after another.

    Rates, accelerations and jerks follow by the chain rule from those of the inputs in the
    expression; inputs may follow inputs that follow, in any order.

    `orders` holds value, rate, acceleration and jerk (4, rows) in the file's units of the inputs
    that are known, by name, and `path` leads to their section; `expressions` gets those of inputs
    that follow, in the order in which they are evaluated; `constrained` are those that the
    motors of others move. `numbers` are those of the rows, where they are not all of a run.
    """

    def __init__(
        self,
        fields: Fields,
        orders: dict[str, Floats],
        rows: int,
        time: Moments | None,
        path: Path,
        numbers: NDArray[np.int64] | None = None,
    ) -> None:
        self.fields = fields
        self.orders = orders
        self.rows = rows
        self.time = time
        self.path = path
        self.numbers = numbers
        self.expressions: dict[str, Expression] = {}
        self.constrained: set[str] = set()

    def add_all(self, sections: Mapping[str, FollowingInput], coordinates: frozenset[str]) -> None:
        """Adds all inputs of some sections to `orders`; errors are noted in `fields`.

        `coordinates` are the names of all joint coordinates, for messages.
        """
        waiting: dict[str, Expression] = {}
        for name, section in sections.items():
            if section.drive == "tie":
                self.constrained.add(name)
            if literal(section.value) is not None:
                self._hold(name, section.value)
                continue
            try:
                waiting[name] = self._parsed(name, section.value, sections, coordinates)
            except ExpressionError as error:
                self._refuse(name, error)
        while waiting:
            ready = [name for name in waiting if not waiting[name].names & waiting.keys()]
            if not ready:
                self._note_cycle(waiting)
                return
            for name in ready:
                self._follow(name, waiting.pop(name))

    def constraint_rates(self) -> dict[tuple[str, str], Floats]:
        """Rates (rows,) in SI of each constrained input by each free one that it follows, through
        others or not; a constrained input that follows none is noted in `fields`."""
        rates: dict[str, dict[str, Floats]] = {}
        for name, expression in self.expressions.items():
            if name not in self.constrained:
                continue
            own = rates[name] = {}
            for used in sorted(expression.names & self.orders.keys()):
                rate = self._partial(expression, used)
                leaders = rates.get(used) or {used: np.ones(self.rows)}
                for leader, through in leaders.items():
                    own[leader] = own.get(leader, np.zeros(self.rows)) + rate * through
        for name in sorted(self.constrained - {name for name, own in rates.items() if own}):
            text, path = f"{name} follows no input whose motor could move it", (*self.path, name)
            self.fields.error("tied-to-nothing", (*path, "drive"), text, "remove drive: tie")
        return {(name, leader): r for name, own in rates.items() for leader, r in own.items()}

    def _partial(self, expression: Expression, name: str) -> Floats:
        """Rate (rows,) of an expression by one of its inputs, in SI."""
        jets = {}
        for used in expression.names:
            jet = np.zeros_like(np.broadcast_to(self._jet(used), (4, self.rows)))
            jet[0] = self._jet(used)[0]
            jet[1] = 1.0 if used == name else 0.0
            jets[used] = jet
        orders: Floats = np.broadcast_to(derivatives(expression, jets), (4, self.rows))[1].copy()
        return orders

    def _hold(self, name: str, text: str) -> None:
        value = self.fields.written(self._path(name), text, dimension_of(name.rpartition(".")[2]))
        self.orders[name] = np.zeros((4, self.rows))
        self.orders[name][0] = value

    def _parsed(
        self,
        name: str,
        text: str,
        sections: Mapping[str, FollowingInput],
        coordinates: frozenset[str],
    ) -> Expression:
        expression = parse(text).taking_whole(coordinates)
        for used in sorted(expression.names, key=expression.offset_of):
            if used == name:
                message, hint = f"{name} follows itself", "name the inputs that it follows"
            elif used in coordinates - self.orders.keys() - sections.keys():
                message, inputs = f"{used} is not an input", ", ".join(self.orders)
                hint = (
                    f"inputs are {inputs}" if inputs else "drive it, too; there are no other inputs"
                )
                if name in coordinates:
                    hint += f"; a gear or rack between {used} and {name} is a coupling: couplings: "
                    hint += f"{{K: {{type: linear, terms: {{{name}: 1, {used}: ...}}}}}}"
            else:
                continue
            if not self.fields.is_refused(used):
                raise ExpressionError(message, expression.offset_of(used), hint)
        return expression

    def _refuse(self, name: str, error: ExpressionError) -> None:
        self.fields.expression_error(self._path(name), error)
        self.fields.refused.add(name)

    def _note_cycle(self, waiting: Mapping[str, Expression]) -> None:
        """Notes one circle among inputs of which each waits for another."""
        chain = [next(iter(waiting))]
        while True:
            need = min(waiting[chain[-1]].names & waiting.keys())
            if need in chain:
                break
            chain.append(need)
        circle = chain[chain.index(need) :]
        error = ExpressionError(
            f"inputs follow each other in a circle: {' -> '.join([*circle, need])}",
            waiting[circle[-1]].offset_of(need),
            "give one of them values of its own",
        )
        self._refuse(circle[-1], error)

    def _follow(self, name: str, expression: Expression) -> None:
        coordinate = name.rpartition(".")[2]
        units = self.fields.units
        try:
            value = scalar(expression, dimension_of(coordinate), units, self._quantity)
        except ExpressionError as error:
            self._refuse(name, error)
            return
        jet = derivatives(expression, {used: self._jet(used) for used in expression.names})
        in_si = np.broadcast_to(jet, (4, self.rows)).copy()
        in_si[0] = value
        rows = np.flatnonzero(~np.isfinite(in_si).all(axis=0))
        if rows.size:
            row = int(rows[0])
            places = ", ".join(self._place(used, row) for used in sorted(expression.names))
            number = row if self.numbers is None else int(self.numbers[row])
            _note_undefined(self.fields, self._path(name), name, in_si[:, row], number, places)
            self.fields.refused.add(name)
            return
        self.orders[name] = np.stack(
            [units.from_si(in_si[k], dimension_of(coordinate, k)) for k in range(4)]
        )
        self.expressions[name] = expression

    def _place(self, name: str, row: int) -> str:
        """`O1.theta = 90 deg`: a quantity of the expression in one row."""
        quantity = self._quantity(name)
        value = np.broadcast_to(np.asarray(quantity.value, dtype=float), (self.rows,))[row]
        return f"{name} = {self.fields.units.text(float(value), quantity.dimension)}"

    def _jet(self, name: str) -> Jet:
        """A name's own value and derivatives over time, in SI."""
        if name in self.fields.parameters:
            return constant_jet(float(self.fields.parameters[name].value))  # type: ignore[arg-type]
        if name == "time" and self.time is not None:
            t = self.time.values
            return np.stack([t, np.ones_like(t), np.zeros_like(t), np.zeros_like(t)])
        to_si, coordinate = self.fields.units.to_si, name.rpartition(".")[2]
        orders = np.broadcast_to(self.orders[name], (4, self.rows))
        return np.stack([to_si(orders[k], dimension_of(coordinate, k)) for k in range(4)])

    def _quantity(self, name: str) -> Quantity:
        if name in self.orders:
            return Quantity(self._jet(name)[0], dimension_of(name.rpartition(".")[2]))
        if name == "time" and self.time is not None:
            return Quantity(self.time.values, TIME)
        if self.fields.is_refused(name):
            raise AlreadyRefused(name)
        if name in self.fields.parameters:
            return self.fields.resolve(name)
        raise UnknownName(name, [*self.fields.parameters, *self.orders])

    def _path(self, name: str) -> Path:
        return (*self.path, name, "with")
