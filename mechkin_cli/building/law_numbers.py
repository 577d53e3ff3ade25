"""The numbers of a law of motion as its text says them, in the file's units."""

from __future__ import annotations

from typing import NamedTuple

from mechkin_cli.arrays import Floats
from mechkin_cli.building.coordinates import dimension_of
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.schema.laws import (
    ConstantAcceleration,
    ConstantRate,
    Cycloidal,
    Harmonic,
    Polynomial,
)
from mechkin_cli.units import TIME, Conversion, UnitSystem, conversion

PowerLaw = ConstantRate | ConstantAcceleration | Polynomial
"""x = c0 + c1 t + c2 t^2 + ..., with t from the first moment of `time`."""


class Clock(NamedTuple):
    """The moments of the rows, and `from` and `to` of `time`, in the file's units."""

    moments: Floats
    first: float
    last: float


def coefficients(fields: Fields, path: Path, law: PowerLaw, coordinate: str) -> list[float]:
    """c0, c1, ..., where c_k is in the file's unit of the coordinate's derivative of order k.

    Errors are noted in `fields`; zeros stand in.
    """
    written: list[tuple[Path, str]]
    if isinstance(law, Polynomial):
        written = [(("coefficients", k), text) for k, text in enumerate(law.coefficients)]
    else:
        written = [(("at",), law.at), (("rate",), law.rate)]
    if isinstance(law, ConstantAcceleration):
        written.append((("acceleration",), law.acceleration))
    found = [
        fields.written((*path, *key), text, dimension_of(coordinate, k))
        for k, (key, text) in enumerate(written)
    ]
    if isinstance(law, ConstantAcceleration):
        found[2] /= 2.0
    return found


def span(
    fields: Fields, path: Path, law: Harmonic | Cycloidal, clock: Clock
) -> tuple[float, float]:
    """Start and duration of a rise in the file's unit of time.

    Errors are noted in `fields`; a duration of one stands in.
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
        fields.error(
            "no-duration",
            place,
            "a rise takes a positive time",
            "give start and duration so that there is time for it",
            measured=f"{duration:g} {fields.units.label(TIME)}",
        )
    return start, 1.0


def over_time(units: UnitSystem, coordinate: str, have: int, want: int) -> Conversion:
    """From the unit of order `have` times the unit of time to have - want, to that of order
    `want`."""
    before = units.unit(dimension_of(coordinate, have)) * units.unit(TIME ** (have - want))
    return conversion(before.factor / units.unit(dimension_of(coordinate, want)).factor)
