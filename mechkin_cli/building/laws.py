"""Laws of motion to values, rates, accelerations and jerks at the moments of the rows.

All is computed in the file's units, so that numbers come out as they were written. With t from the
first moment of `time` and u = (moment - start)/duration:

- constant rate, constant acceleration, polynomial: x = c0 + c1 t + c2 t^2 + ...; bare
  coefficients must be in the file's angle (length) and time throughout
- harmonic: x = from + (to - from) (1 - cos(pi u))/2
- cycloidal: x = from + (to - from) (u - sin(2 pi u)/(2 pi)); both rest before and after, and the
  first and the last moment of the rise belong to it
- table: the curve through the rows of a CSV file.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi, prod

import numpy as np

from mechkin_cli.arrays import Floats
from mechkin_cli.building.coordinates import dimension_of
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.law_numbers import Clock, PowerLaw, coefficients, over_time, span
from mechkin_cli.expressions import literal
from mechkin_cli.schema.laws import Cycloidal, Harmonic, Law, Polynomial, TableLaw
from mechkin_cli.units import TIME, UnitSystem


def law_values(fields: Fields, path: Path, law: Law, coordinate: str, clock: Clock) -> Floats:
    """Value, rate, acceleration and jerk (4, rows) in the file's units.

    Errors are noted in `fields`; zeros stand in.
    """
    return _LAWS[law.law](fields, path, law, coordinate, clock)


def _of_powers(fields: Fields, path: Path, law: PowerLaw, coordinate: str, clock: Clock) -> Floats:
    found = coefficients(fields, path, law, coordinate)
    if isinstance(law, Polynomial):
        _check_units(fields, (*path, "coefficients"), law, coordinate)
    return _power_series(fields.units, coordinate, found, clock)


def _check_units(fields: Fields, path: Path, law: Polynomial, coordinate: str) -> None:
    """Refuses bare coefficients that two readings make different numbers of: in a row of
    coefficients of an angle in deg, the next may be meant in deg/s or in the file's rad/s."""
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


def _power_series(
    units: UnitSystem, coordinate: str, coefficients: Sequence[float], clock: Clock
) -> Floats:
    """c0 + c1 t + c2 t^2 + ... and its derivatives; c_k in the file's unit of order k."""
    t = clock.moments - clock.first
    orders = np.zeros((4, t.size))
    for order in range(4):
        for k in range(len(coefficients) - 1, order - 1, -1):
            factor = float(prod(range(k - order + 1, k + 1)))
            term = over_time(units, coordinate, k, order).apply(coefficients[k] * factor)
            orders[order] = orders[order] * t + term
    return orders


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
    from mechkin_cli.kernel.functions import sin

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
    from mechkin_cli.building.curves import join, joining_of, note_overshoot, read_rows

    orders = np.zeros((4, clock.moments.size))
    place = (*path, "file")
    rows = read_rows(fields, place, law.file, TIME, dimension_of(coordinate))
    joining = joining_of(law)
    curve = None if rows is None else join(fields, place, rows.x, rows.y, joining)
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
    found = curve.evaluate(clock.moments)
    for order in range(4):
        orders[order] = over_time(fields.units, coordinate, 0, order).apply(found[order])
    return orders


_LAWS: dict[str, Callable[..., Floats]] = {
    "constant-rate": _of_powers,
    "constant-acceleration": _of_powers,
    "polynomial": _of_powers,
    "harmonic": _harmonic,
    "cycloidal": _cycloidal,
    "table": _table,
}
