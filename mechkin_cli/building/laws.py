"""Laws of motion to values, rates, accelerations and jerks at the moments of the rows.

Numbers are computed in the file's units, so that they come out as they were written. With t from
the first moment of `time` and u = (moment - start)/duration:

- constant rate, constant acceleration, polynomial: x = c0 + c1 t + c2 t^2 + ...; bare
  coefficients must be in the file's angle (length) and time throughout
- harmonic: x = from + (to - from) (1 - cos(pi u))/2
- cycloidal: x = from + (to - from) (u - sin(2 pi u)/(2 pi)); both rest before and after, and the
  first and the last moment of the rise belong to it
- table: the curve through the rows of a CSV file.

`law_pieces` gives a law between the rows, for any moment: one formula of the moment whose constants
change from piece to piece, so that a tape of it holds for all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi, prod
from typing import Any

import numpy as np

from mechkin_cli.building.exact_motion import PowerLaw, coefficients, over_time, span
from mechkin_cli.building.fields import Clock, Fields, Path, dimension_of
from mechkin_cli.building.load_laws import join, joining_of, note_overshoot, read_rows
from mechkin_cli.expressions import literal
from mechkin_cli.mechanism import joined_curve
from mechkin_cli.record import NamedTuple
from mechkin_cli.schema import Cycloidal, Harmonic, Law, Polynomial, TableLaw
from mechkin_cli.show import Floats
from mechkin_cli.tape import cos, sin
from mechkin_cli.units import TIME


def law_values(fields: Fields, path: Path, law: Law, coordinate: str, clock: Clock) -> Floats:
    """Value, rate, acceleration and jerk (4, rows) in the file's units.

    Errors are noted in `fields`; zeros stand in.
    """
    return _LAWS[law.law](fields, path, law, coordinate, clock)


def _of_powers(fields: Fields, path: Path, law: PowerLaw, coordinate: str, clock: Clock) -> Floats:
    numbers = coefficients(fields, path, law, coordinate)
    if isinstance(law, Polynomial):
        _check_units(fields, (*path, "coefficients"), law, coordinate)
    t = clock.moments - clock.first
    orders = np.zeros((4, t.size))
    for order in range(4):
        for k in range(len(numbers) - 1, order - 1, -1):
            factor = float(prod(range(k - order + 1, k + 1)))
            term = over_time(fields.units, coordinate, k, order).apply(numbers[k] * factor)
            orders[order] = orders[order] * t + term
    return orders


def _check_units(fields: Fields, path: Path, law: Polynomial, coordinate: str) -> None:
    """Refuses bare coefficients with two meanings: in a row of coefficients of an angle in deg, the
    next may be meant in deg/s or in the file's rad/s."""
    for k, text in enumerate(law.coefficients):
        if k == 0 or not literal(text):
            continue
        units, dimension = fields.units, dimension_of(coordinate, k)
        own, alike = units.unit(dimension), units.unit(dimension_of(coordinate))
        alike *= units.unit(TIME) ** -k
        if own.factor != alike.factor:
            fields.error(
                "bare-coefficient",
                (*path, k),
                f"{text.strip()} may be meant in {alike} or in {own}",
                f"write the unit behind the number, such as {text.strip()} {alike}",
            )


def _harmonic(fields: Fields, path: Path, law: Harmonic, coordinate: str, clock: Clock) -> Floats:
    def shape(u: Floats) -> list[Floats]:
        sine, cosine = _half_turn(u)
        value = (1.0 - cosine) / 2.0
        return [value, pi / 2.0 * sine, pi * pi / 2.0 * cosine, -(pi * pi * pi) / 2.0 * sine]

    return _rise(fields, path, law, coordinate, clock, shape)


def _cycloidal(fields: Fields, path: Path, law: Cycloidal, coordinate: str, clock: Clock) -> Floats:
    def shape(u: Floats) -> list[Floats]:
        sine, cosine = _half_turn(u)
        value = u - sine * cosine / pi
        rate, acceleration = 2.0 * (sine * sine), 4.0 * pi * (sine * cosine)
        return [value, rate, acceleration, 4.0 * pi * pi * (1.0 - 2.0 * (sine * sine))]

    return _rise(fields, path, law, coordinate, clock, shape)


def _half_turn(u: Floats) -> tuple[Floats, Floats]:
    """Sine and cosine of pi*u for u in [0, 1]; exact at 0, 1/2 and 1."""
    from_end = np.minimum(u, 1.0 - u)
    cosine = sin(pi * (0.5 - from_end))
    return sin(pi * from_end), np.where(u > 0.5, -cosine, cosine)


def _rise(
    fields: Fields,
    path: Path,
    law: Harmonic | Cycloidal,
    coordinate: str,
    clock: Clock,
    shape: Callable[[Floats], list[Floats]],
) -> Floats:
    """A rise of the given shape over u from 0 to 1, at rest before and after."""
    first = fields.written((*path, "from"), law.first, dimension_of(coordinate))
    last = fields.written((*path, "to"), law.last, dimension_of(coordinate))
    start, duration = span(fields, path, law, clock)
    u = (clock.moments - start) / duration
    rising = (u >= 0.0) & (u <= 1.0)
    rise = last - first
    orders = np.stack(shape(np.clip(u, 0.0, 1.0)))
    orders[0] = np.where(u >= 1.0, last, first + rise * orders[0])
    for order in (1, 2, 3):
        rise = rise / duration
        scaled = over_time(fields.units, coordinate, 0, order).apply(rise * orders[order])
        orders[order] = np.where(rising, scaled, 0.0)
    return orders


def _table(fields: Fields, path: Path, law: TableLaw, coordinate: str, clock: Clock) -> Floats:
    orders = np.zeros((4, clock.moments.size))
    place = (*path, "file")
    rows = read_rows(fields, place, law.file, TIME, dimension_of(coordinate))
    curve = None if rows is None else join(fields, place, *rows, joining_of(law))
    if curve is None:
        return orders
    note_overshoot(fields, place, curve, None)
    unit = fields.units.label(TIME)
    for moment in (float(clock.moments[0]), float(clock.moments[-1])):
        if not curve.first <= moment <= curve.last:
            fields.error(
                "table-range",
                place,
                f"{law.file} does not reach all moments of time",
                "add rows to the table, or change from and to of time",
                measured=f"{moment:g} {unit}",
                limit=f"{curve.first:g} to {curve.last:g} {unit}",
            )
            return orders
    values = curve.evaluate(clock.moments)
    for order in range(4):
        orders[order] = over_time(fields.units, coordinate, 0, order).apply(values[order])
    return orders


_LAWS: dict[str, Callable[..., Floats]] = {
    "constant-rate": _of_powers,
    "constant-acceleration": _of_powers,
    "polynomial": _of_powers,
    "harmonic": _harmonic,
    "cycloidal": _cycloidal,
    "table": _table,
}


class LawPieces(NamedTuple):
    """A law over the moment in the file's units.

    Attributes:
        edges: moments at which the formula's constants change.
        constants: of the piece in which a moment lies.
        value: of a moment and such constants, floats or recorded numbers, in the file's units.
    """

    edges: list[float]
    constants: Callable[[float], list[float]]
    value: Callable[[Any, Sequence[Any]], Any]


def law_pieces(fields: Fields, path: Path, law: Law, coordinate: str, clock: Clock) -> LawPieces:
    """The pieces of a law whose fields are known to be right."""
    if isinstance(law, Harmonic | Cycloidal):
        return _pieces_of_rise(fields, path, law, coordinate, clock)
    if isinstance(law, TableLaw):
        return _pieces_of_table(fields, path, law, coordinate)
    numbers = enumerate(coefficients(fields, path, law, coordinate))
    terms = [over_time(fields.units, coordinate, k, 0).apply(number) for k, number in numbers]

    def value(moment: Any, _: Sequence[Any]) -> Any:
        t = moment - clock.first
        total: Any = terms[-1]
        for term in terms[-2::-1]:
            total = total * t + term
        return total

    return LawPieces([], lambda _: [], value)


def _pieces_of_rise(
    fields: Fields, path: Path, law: Harmonic | Cycloidal, coordinate: str, clock: Clock
) -> LawPieces:
    """u = a t + b, where a = 0 before and after the rise."""
    first = fields.written((*path, "from"), law.first, dimension_of(coordinate))
    last = fields.written((*path, "to"), law.last, dimension_of(coordinate))
    start, duration = span(fields, path, law, clock)
    end = start + duration

    def constants(moment: float) -> list[float]:
        if moment < start:
            return [0.0, 0.0]
        return [0.0, 1.0] if moment > end else [1.0 / duration, -start / duration]

    def value(moment: Any, constants: Sequence[Any]) -> Any:
        u = constants[0] * moment + constants[1]
        if isinstance(law, Harmonic):
            return first + (last - first) * ((1.0 - cos(u * pi)) / 2.0)
        return first + (last - first) * (u - sin(u * (2.0 * pi)) / (2.0 * pi))

    return LawPieces([start, end], constants, value)


def _pieces_of_table(fields: Fields, path: Path, law: TableLaw, coordinate: str) -> LawPieces:
    rows = read_rows(fields, (*path, "file"), law.file, TIME, dimension_of(coordinate))
    assert rows is not None  # it was read before
    curve = joined_curve(*rows, joining_of(law))
    last = curve.x.size - 1

    def constants(moment: float) -> list[float]:
        piece = int(np.clip(np.searchsorted(curve.x, moment, side="right") - 1, 0, last))
        return [float(curve.x[piece]), *curve.coefficients[:, piece].tolist()]

    def value(moment: Any, constants: Sequence[Any]) -> Any:
        x, y, b, c, d = constants
        u = moment - x
        return y + u * (b + u * (c + u * d))

    return LawPieces(curve.x.tolist(), constants, value)
