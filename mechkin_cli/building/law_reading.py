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
- sine: offset + amplitude sin(2 pi frequency t + phase)
- rises, from + (to - from) s(u), with rest before and after: `SHAPES`
- table: the curve through the rows of a CSV file.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import inf, prod
from typing import Any

from mechkin_cli.building.fields import Clock, Fields, Path
from mechkin_cli.building.law_shapes import (
    HALF_TURN,
    SHAPES,
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
from mechkin_cli.expressions import literal
from mechkin_cli.mechanism import Curve
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import (
    ConstantAcceleration,
    ConstantRate,
    Law,
    Polynomial,
    Rise,
    Sine,
    TableLaw,
)
from mechkin_cli.tape import as_recorded
from mechkin_cli.units import ANGLE, DIMENSIONLESS, TIME, Conversion, Dimension, conversion

_ORDERS = range(4)


class Over(NamedTuple):
    """The variable of a law.

    Attributes:
        dimension: what it measures.
        first: its first value, in the units of the law.
        last: its last value, at which a rise without a duration ends; None where there is none.
        met: the least and the largest of its values that are met, where they are known.
        in_si: whether the law is in SI, else in the file's units.
    """

    dimension: Dimension
    first: float
    last: float | None
    met: tuple[float, ...] = ()
    in_si: bool = False


def over_moments(clock: Clock) -> Over:
    """Over the moments of the rows."""
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


def read_law(
    fields: Fields, path: Path, law: Law, dimension: Dimension, over: Over
) -> PiecewiseLaw:
    """The law at a path of the file, which gives a quantity of a dimension over a variable.

    Errors are noted in `fields`; a law at rest replaces a wrong one.
    """
    errors = fields.error_count
    pieces = _READ[type(law)](_Reading(fields, path, dimension, over), law)
    if fields.error_count > errors:
        pieces = [rest(0.0)]
    return PiecewiseLaw(pieces)


def note_bends(fields: Fields, path: Path, law: Law, dimension: Dimension, over: Over) -> None:
    """Notes what is odd, but no error, in a law without errors."""
    if isinstance(law, TableLaw) and not over.in_si:
        curve = _curve(_Reading(fields, path, dimension, over), law)
        assert curve is not None
        note_overshoot(fields, (*path, "file"), curve, None)


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
    rising = risen(type(law), start, duration, first, last, scales)
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
    if duration > 0.0:
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
        if not as_recorded(curve.first) <= at <= as_recorded(curve.last):
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


_READ: dict[type, Callable[[_Reading, Any], list[Piece]]] = {
    ConstantRate: _of_powers,
    ConstantAcceleration: _of_powers,
    Polynomial: _of_powers,
    Sine: _sine,
    **dict.fromkeys(SHAPES, _rise),
    TableLaw: _table,
}
