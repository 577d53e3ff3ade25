"""Laws of motion of a file, over any variable.

`read_law` reads a law over a variable (`Over`): the moment of a row, or a coordinate that another
one follows. What it returns has the interface of a `PiecewiseLaw` (`law_shapes`), with numbers in
the file's units or, with `Over.in_si`, in SI. A law over a coordinate, as a tape:

    law = read_law(fields, path, section, LENGTH, Over(ANGLE, 0.0, None, in_si=True))
    recorder = Recorder(names, [x, *law.constants(x)])
    at, *constants = [Traced(recorder, k) for k in range(1 + len(law.constants(x)))]
    tape = recorder.tape([register(recorder, law.value(at, constants))], guarded=False)

holds for all pieces, each with its constants; pieces begin at `law.edges`.

With t from the first value of the variable and u = (x - start)/duration the laws are

- constant rate, constant acceleration, polynomial: c0 + c1 t + c2 t^2 + ...; bare coefficients
  must be in the file's angle (length) and time throughout
- expression of the variable: `FormulaLaw`
- sine: offset + amplitude sin(2 pi frequency t + phase)
- rises, from + (to - from) s(u), with rest before and after: `SHAPES`
- sequence: rises and rests one after another; over an angle that it spans a turn of again and again
- table: the curve through the rows of a CSV file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from fractions import Fraction
from math import inf, prod
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from mechkin_cli.building.fields import AlreadyRefused, Clock, Fields, Path
from mechkin_cli.building.law_shapes import (
    HALF_TURN,
    SHAPES,
    Orders,
    Piece,
    PiecewiseLaw,
    rest,
    risen,
    waves_of,
)
from mechkin_cli.building.load_laws import (
    join,
    joining_of,
    note_overshoot,
    read_curve,
    read_rows,
)
from mechkin_cli.diagnostics import Diagnostic
from mechkin_cli.exact import TURN
from mechkin_cli.expressions import (
    Expression,
    ExpressionError,
    Quantity,
    UnknownName,
    constant_jet,
    derivatives,
    literal,
    parse,
    scalar,
)
from mechkin_cli.mechanism import Curve
from mechkin_cli.record import NamedTuple, replace
from mechkin_cli.schema import (
    ConstantAcceleration,
    ConstantRate,
    ExpressionLaw,
    Law,
    Polynomial,
    Rise,
    Sequence,
    Sine,
    TableLaw,
)
from mechkin_cli.tape import JetNumber, is_traced, orders_of
from mechkin_cli.tolerances import COURSE_JUMP, COURSE_SAME, SMALLEST_DIVISOR
from mechkin_cli.units import ANGLE, DIMENSIONLESS, TIME, Conversion, Dimension, conversion

if TYPE_CHECKING:
    from mechkin_cli.show import Floats
    from mechkin_cli.tape import ExactRows

_ORDERS = range(4)


class Over(NamedTuple):
    """What a law runs over: its variable, time or a coordinate.

    Attributes:
        dimension: what it measures.
        first: its first value, in the units of the law.
        last: its last value, at which a rise without a duration ends; None where there is none.
        met: the least and the largest value at rows, where they are known: a table has to reach
            them, and jumps beyond them are not told.
        in_si: whether the law is in SI, else in the file's units.
        name: its name in expressions.
    """

    dimension: Dimension
    first: float
    last: float | None = None
    met: tuple[float, ...] = ()
    in_si: bool = False
    name: str = "time"


def over_moments(clock: Clock) -> Over:
    """What a law over time runs over: the moments of the rows, in the file's unit of time."""
    written = clock.time.written
    return Over(TIME, clock.first, clock.last, (float(written[0]), float(written[-1])))


class _Reading(NamedTuple):
    """How a law is read: where it stands, what it gives, what it runs over."""

    fields: Fields
    path: Path
    dimension: Dimension
    over: Over

    def of_order(self, order: int) -> Dimension:
        """The dimension of a derivative."""
        return self.dimension / self.over.dimension**order

    def number(self, key: Path, text: str, dimension: Dimension) -> float:
        """A number of the file in the units of the law."""
        read = self.fields.number if self.over.in_si else self.fields.written
        return read((*self.path, *key), text, dimension)

    def between(self, have: int, want: int) -> Conversion:
        """From the unit of order `have` times that of the variable to have - want, to the unit of
        order `want`."""
        if self.over.in_si:
            return Conversion(1.0, 1.0)
        unit, more = self.fields.units.unit, self.over.dimension ** (have - want)
        before = unit(self.of_order(have)) * unit(more)
        return conversion(before.factor / unit(self.of_order(want)).factor)

    def scales(self, rise: Any, length: Any) -> list[Any]:
        """What one unit of each order of a function of w from 0 to 1 is."""
        found = []
        for order in _ORDERS:
            found.append(self.between(0, order).apply(rise))
            rise = rise / length
        return found


class FormulaLaw:
    """A law as an expression of its variable, with the interface of a `PiecewiseLaw`; where it
    bends its tape tells."""

    edges: tuple[float, ...] = ()
    period = None

    def __init__(self, reading: _Reading, expression: Expression) -> None:
        self._reading, self._expression = reading, expression

    def constants(self, _: float) -> list[float]:
        """None: it is one piece."""
        return []

    def value(self, x: Any, _: Iterable[Any] = ()) -> Any:
        """The value at x, a float, doubles (rows,) or a recorded number."""
        return self._in_own_units(self._in_si(self._variable_in_si(x)), 0)

    def orders(self, x: Floats) -> Floats:
        """As `PiecewiseLaw.orders`; nan or infinite where there is no such derivative."""
        variable = self._variable_in_si(x)
        moving = np.stack([variable, np.ones_like(x), np.zeros_like(x), np.zeros_like(x)])
        parameters = self._reading.fields.parameters
        names = {
            # a recorded parameter refuses to become a float
            name: constant_jet(float(parameters[name].value)) if name in parameters else moving  # type: ignore[arg-type]
            for name in self._expression.names
        }
        with np.errstate(all="ignore"):
            found = np.broadcast_to(derivatives(self._expression, names), (4, x.size)).copy()
            found[0] = self._in_si(variable)
        return np.stack([self._in_own_units(order, k) for k, order in enumerate(found)])

    def recorded(self, _: ExactRows, x: Any, __: Floats) -> Orders:
        """As `PiecewiseLaw.recorded`."""
        moving: Any = JetNumber([self._variable_in_si(x), 1.0, 0.0, 0.0])
        orders = orders_of(self._in_si(moving))
        a, b, c, d = (self._in_own_units(order, k) for k, order in enumerate(orders))
        return a, b, c, d

    def check(self) -> None:
        """Notes what is wrong with the expression, whatever its variable is."""
        reading, sample = self._reading, np.ones(1)
        try:
            scalar(
                self._expression.in_doubles,
                reading.dimension,
                reading.fields.units,
                lambda name: self._named(name, sample, recorded=False),
            )
        except ExpressionError as error:
            reading.fields.expression_error((*reading.path, "value"), error)

    def _in_si(self, variable: Any) -> Any:
        reading = self._reading
        return scalar(
            self._expression,
            reading.dimension,
            reading.fields.units,
            lambda name: self._named(name, variable),
        )

    def _named(self, name: str, variable: Any, *, recorded: bool = True) -> Quantity:
        """The quantity of a name, with a value of the variable in SI."""
        fields, over = self._reading.fields, self._reading.over
        if name == over.name:
            return Quantity(variable, over.dimension)
        if fields.is_refused(name):
            raise AlreadyRefused(name)
        if name not in fields.parameters:
            hint = f"a law is an expression of {over.name} and parameters"
            hint += "; {with: ...} follows other inputs" if "." in name else ""
            raise UnknownName(name, [*fields.parameters, over.name], hint)
        parameter = fields.parameters[name]
        return (
            parameter
            if recorded or not is_traced(parameter.value)
            else replace(parameter, value=np.ones(1))
        )

    def _variable_in_si(self, x: Any) -> Any:
        over, units = self._reading.over, self._reading.fields.units
        return x if over.in_si else units.to_si(x, over.dimension)

    def _in_own_units(self, value: Any, order: int) -> Any:
        reading = self._reading
        if reading.over.in_si:
            return value
        return reading.fields.units.from_si(value, reading.of_order(order))


AnyLaw = PiecewiseLaw | FormulaLaw


def read_law(fields: Fields, path: Path, law: Law, dimension: Dimension, over: Over) -> AnyLaw:
    """The law at a path of the file, which gives a quantity of a dimension over a variable.

    Errors are noted in `fields`; a law at rest replaces a wrong one.
    """
    errors = fields.error_count
    reading = _Reading(fields, path, dimension, over)
    if isinstance(law, ExpressionLaw) and literal(law.value) is None:
        formula = _formula(reading, law)
        return (
            formula
            if formula is not None and fields.error_count == errors
            else PiecewiseLaw([rest(0.0)])
        )
    if isinstance(law, Sequence):
        pieces, period = _sequence(reading, law)
    else:
        pieces, period = _READ[law.law](reading, law), None
    return PiecewiseLaw([rest(0.0)] if fields.error_count > errors else pieces, period)


def note_bends(fields: Fields, path: Path, law: Law, dimension: Dimension, over: Over) -> None:
    """Notes what is odd, but no error, in a law without errors: a curve of a table that leaves its
    points, and jumps of rate and acceleration between the segments of a sequence."""
    reading = _Reading(fields, path, dimension, over)
    if isinstance(law, TableLaw) and not over.in_si:
        curve = _curve(reading, law)
        assert curve is not None
        note_overshoot(fields, (*path, "file"), curve, None)
    elif isinstance(law, Sequence):
        _note_jumps(reading, PiecewiseLaw(*_sequence(reading, law)))


_JUMPS: tuple[tuple[str, Literal["warning", "note"], str, str], ...] = (
    (
        "rate-jump",
        "warning",
        "rate",
        "forces are infinite there; a rise such as cycloidal begins and ends at rest",
    ),
    (
        "acceleration-jump",
        "note",
        "acceleration",
        "cycloidal, 3-4-5, modified-sine and modified-trapezoid begin and end without acceleration",
    ),
)


def _note_jumps(reading: _Reading, law: PiecewiseLaw) -> None:
    """Notes where the rate or else the acceleration jumps between two segments, of each the first
    of the largest jumps and how many there are. A response refuses rates that jump, of any law."""
    fields, over = reading.fields, reading.over
    met = over.met or (-inf, inf)
    found = [(at, jump) for at, jump in law.jumps() if met[0] < at < met[1]]
    for order, (code, severity, word, hint) in enumerate(_JUMPS, start=1):
        jumping = [(at, jump) for at, jump in found if jump[order] and not jump[1:order].any()]
        if not jumping or (order == 1 and reading.path[0] == "responses"):
            continue
        most = max(abs(jump[order]) for _, jump in jumping)
        at, jump = next(one for one in jumping if abs(one[1][order]) >= most * (1.0 - COURSE_JUMP))
        unit = fields.units.label
        where = f"{_written(reading, at, over.dimension):.6g} {unit(over.dimension)}"
        more = f", the largest of {len(jumping)} such jumps" if len(jumping) > 1 else ""
        size = _written(reading, abs(jump[order]), reading.of_order(order))
        fields.note(
            Diagnostic(
                code,
                severity,
                f"the {word} of this sequence jumps at {where}{more}",
                fields.document.place((*reading.path, "segments")),
                measured=f"{size:.6g} {unit(reading.of_order(order))}",
                hint=hint,
            )
        )


def _written(reading: _Reading, value: float, dimension: Dimension) -> float:
    """A number of the law in the file's units."""
    return float(reading.fields.units.from_si(value, dimension)) if reading.over.in_si else value


def _sequence(reading: _Reading, law: Sequence) -> tuple[list[Piece], float | None]:
    """The pieces of a sequence, and its period where it spans a turn of an angle."""
    fields, over = reading.fields, reading.over
    first = reading.number(("from",), law.first, reading.dimension)
    begin = over.first
    if law.start is not None:
        begin = reading.number(("start",), law.start, over.dimension)
    pieces, start, at = [rest(first)], begin, first
    for k, segment in enumerate(law.segments):
        key: Path = ("segments", k, "for")
        errors = fields.error_count
        length = reading.number(key, segment.extent, over.dimension)
        if not length > SMALLEST_DIVISOR:
            if fields.error_count == errors:
                measured = f"{length:g} {fields.units.label(over.dimension)}"
                text = "a segment has a positive extent"
                hint = "write for: how long it lasts"
                fields.error("no-duration", (*reading.path, *key), text, hint, measured=measured)
            continue
        if segment.last is None:
            pieces.append(rest(at, start))
        else:
            to = reading.number(("segments", k, "to"), segment.last, reading.dimension)
            scales = reading.scales(to - at, length)
            pieces += risen(segment.law, start, length, at, to, scales)
            at = to
        start = start + length
    period = _turn(reading, law, start - begin, at - first)
    if period is None:
        pieces.append(rest(at, start))
    return pieces, period


def _turn(reading: _Reading, law: Sequence, extent: float, rise: float) -> float | None:
    """The turn that a sequence spans; None where it spans less, or runs over no angle."""
    fields, over = reading.fields, reading.over
    if over.dimension != ANGLE:
        return None
    turn = TURN if over.in_si else fields.units.from_si(TURN, ANGLE)
    if extent < turn * (1.0 - COURSE_SAME):
        return None
    place = (*reading.path, "segments")
    if extent > turn * (1.0 + COURSE_SAME):
        text = "the segments span more than a turn"
        measured = f"{_written(reading, extent, ANGLE):.12g} {fields.units.label(ANGLE)}"
        fields.error("too-long", place, text, "shorten one of them", measured=measured)
    elif rise != 0.0:
        text = "after a turn the sequence does not end where it began"
        size = _written(reading, rise, reading.dimension)
        measured = f"{size:.12g} {fields.units.label(reading.dimension)}"
        hint = f"write to: {law.first} in the last segment that moves"
        fields.error("open-sequence", place, text, hint, measured=measured)
    return turn


def _formula(reading: _Reading, law: ExpressionLaw) -> FormulaLaw | None:
    """The law of an expression; None where an error was noted."""
    try:
        expression = parse(law.value).taking_whole({reading.over.name})
    except ExpressionError as error:
        reading.fields.expression_error((*reading.path, "value"), error)
        return None
    formula = FormulaLaw(reading, expression)
    formula.check()
    return formula


def _constant(reading: _Reading, law: ExpressionLaw) -> list[Piece]:
    return [rest(reading.number(("value",), law.value, reading.dimension))]


def _of_powers(
    reading: _Reading, law: ConstantRate | ConstantAcceleration | Polynomial
) -> list[Piece]:
    written: list[tuple[Path, str]]
    if isinstance(law, Polynomial):
        written = [(("coefficients", k), text) for k, text in enumerate(law.coefficients)]
        _check_units(reading, law)
    else:
        written = [(("at",), law.at), (("rate",), law.rate)]
    if isinstance(law, ConstantAcceleration):
        written.append((("acceleration",), law.acceleration))
    numbers = [
        reading.number(key, text, reading.of_order(k)) for k, (key, text) in enumerate(written)
    ]
    if isinstance(law, ConstantAcceleration):
        numbers[2] /= 2.0
    polynomials = [
        tuple(
            reading.between(k, order).apply(numbers[k] * float(prod(range(k - order + 1, k + 1))))
            for k in range(order, len(numbers))
        )
        for order in _ORDERS
    ]
    orders = tuple(coefficients or (0.0,) for coefficients in polynomials)
    return [Piece(-inf, 0.0, reading.over.first, polynomials=orders)]


def _check_units(reading: _Reading, law: Polynomial) -> None:
    """Refuses bare coefficients with two meanings: in a row of coefficients of an angle in deg, the
    next may be meant in deg/s or in the file's rad/s."""
    fields, variable = reading.fields, reading.over.dimension
    for k, text in enumerate(law.coefficients):
        if k == 0 or not literal(text):
            continue
        own = fields.units.unit(reading.of_order(k))
        alike = fields.units.unit(reading.dimension) * fields.units.unit(variable) ** -k
        if own.factor != alike.factor:
            fields.error(
                "bare-coefficient",
                (*reading.path, "coefficients", k),
                f"{text.strip()} may be meant in {alike} or in {own}",
                f"write the unit behind the number, such as {text.strip()} {alike}",
            )


def _sine(reading: _Reading, law: Sine) -> list[Piece]:
    over, fields = reading.over, reading.fields
    amplitude = reading.number(("amplitude",), law.amplitude, reading.dimension)
    middle = reading.number(("offset",), law.offset, reading.dimension)
    phase = fields.number((*reading.path, "phase"), law.phase, ANGLE) / HALF_TURN
    key, text, dimension = "period", law.period, over.dimension
    if text is None:
        key, text, dimension = "frequency", law.frequency, DIMENSIONLESS / over.dimension
    assert text is not None
    errors = fields.error_count
    number = reading.number((key,), text, dimension)
    if not number > 0.0:
        if fields.error_count == errors:
            measured = f"{number:g} {fields.units.label(dimension)}"
            hint = f"write a positive {key}; phase: 180 deg turns a sine over"
            place = (*reading.path, key)
            fields.error(
                "no-period", place, f"the {key} of a sine is positive", hint, measured=measured
            )
        return []
    length = number if key == "period" else 1.0 / number
    waves = waves_of(reading.scales(amplitude, length), Fraction(1), Fraction(2))
    wave = Piece(-inf, middle, over.first, length, waves=waves, turns=2.0, phase=phase)
    return [wave]


def _rise(reading: _Reading, law: Rise) -> list[Piece]:
    first = reading.number(("from",), law.first, reading.dimension)
    last = reading.number(("to",), law.last, reading.dimension)
    start, duration = _span(reading, law)
    scales = reading.scales(last - first, duration)
    rising = risen(law.law, start, duration, first, last, scales)
    return [rest(first), *rising, rest(last, start + duration)]


def _span(reading: _Reading, law: Rise) -> tuple[float, float]:
    """Start and duration of a rise; a duration of one replaces a wrong one."""
    fields, over = reading.fields, reading.over
    errors = fields.error_count
    start = over.first
    if law.start is not None:
        start = reading.number(("start",), law.start, over.dimension)
    key: Path = ("duration",)
    if law.duration is not None:
        duration = reading.number(key, law.duration, over.dimension)
    else:
        duration = 0.0 if over.last is None else over.last - start
        key = ("start",) if law.start is not None else ()
    if duration > SMALLEST_DIVISOR:
        return start, duration
    if fields.error_count == errors:
        hint = "give start and duration so that there is time for it"
        measured = f"{duration:g} {fields.units.label(over.dimension)}"
        text = "a rise takes a positive time"
        fields.error("no-duration", (*reading.path, *key), text, hint, measured=measured)
    return start, 1.0


def _table(reading: _Reading, law: TableLaw) -> list[Piece]:
    curve = _curve(reading, law)
    over = reading.over
    if curve is None:
        return [rest(0.0)]
    for at in over.met:
        if not (curve.first <= at and curve.last >= at):
            unit = reading.fields.units.label(over.dimension)
            reading.fields.error(
                "table-range",
                (*reading.path, "file"),
                f"{law.file} does not reach all moments of time",
                "add rows to the table, or change from and to of time",
                measured=f"{at:g} {unit}",
                limit=f"{curve.first:g} to {curve.last:g} {unit}",
            )
            break
    orders = [reading.between(0, order) for order in _ORDERS]
    pieces = []
    for k, x in enumerate(curve.x.tolist()):
        y, b, c, d = curve.coefficients[:, k]
        polynomials = [[y, b, c, d], [b, 2.0 * c, 3.0 * d], [2.0 * c, 6.0 * d], [6.0 * d]]
        written = [list(map(unit.apply, p)) for unit, p in zip(orders, polynomials, strict=True)]
        pieces.append(Piece(x if k else -inf, 0.0, x, polynomials=written))
    return pieces


def _curve(reading: _Reading, law: TableLaw) -> Curve | None:
    """The curve of a table in the units of the law; None where an error was noted."""
    place, dimensions = (*reading.path, "file"), (reading.over.dimension, reading.dimension)
    if reading.over.in_si:
        return read_curve(reading.fields, place, law.file, *dimensions, *joining_of(law))
    rows = read_rows(reading.fields, place, law.file, *dimensions)
    return None if rows is None else join(reading.fields, place, *rows, *joining_of(law))


_READ: dict[str, Callable[[_Reading, Any], list[Piece]]] = {
    **dict.fromkeys(SHAPES, _rise),
    "constant-rate": _of_powers,
    "constant-acceleration": _of_powers,
    "polynomial": _of_powers,
    "expression": _constant,
    "sine": _sine,
    "table": _table,
}
