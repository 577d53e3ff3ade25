"""Laws of motion between the rows: pieces of elementary functions, for any moment.

Each law is one formula of the moment whose constants change from piece to piece, so that a tape of
it holds for all of them; the formulas are those of `building.laws`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import pi
from typing import Any, NamedTuple

import numpy as np

from mechkin_cli.building.coordinates import dimension_of
from mechkin_cli.building.curves import joining_of, read_rows
from mechkin_cli.building.fields import Fields, Path
from mechkin_cli.building.law_numbers import Clock, PowerLaw, coefficients, over_time, span
from mechkin_cli.mechanism.joined_curve import joined_curve
from mechkin_cli.schema.laws import Cycloidal, Harmonic, Law, TableLaw
from mechkin_cli.tape.scalars import cos, sin
from mechkin_cli.units import TIME


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
        return _rise(fields, path, law, coordinate, clock)
    if isinstance(law, TableLaw):
        return _table(fields, path, law, coordinate)
    return _power_series(fields, path, law, coordinate, clock)


def _power_series(
    fields: Fields, path: Path, law: PowerLaw, coordinate: str, clock: Clock
) -> LawPieces:
    written = coefficients(fields, path, law, coordinate)
    terms = [
        over_time(fields.units, coordinate, k, 0).apply(number) for k, number in enumerate(written)
    ]

    def value(moment: Any, _: Sequence[Any]) -> Any:
        t = moment - clock.first
        total: Any = terms[-1]
        for term in terms[-2::-1]:
            total = total * t + term
        return total

    return LawPieces([], lambda _: [], value)


def _rise(
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


def _table(fields: Fields, path: Path, law: TableLaw, coordinate: str) -> LawPieces:
    rows = read_rows(fields, (*path, "file"), law.file, TIME, dimension_of(coordinate))
    assert rows is not None  # it was read before
    curve = joined_curve(rows.x, rows.y, joining_of(law))
    last = curve.x.size - 1

    def constants(moment: float) -> list[float]:
        piece = int(np.clip(np.searchsorted(curve.x, moment, side="right") - 1, 0, last))
        return [float(curve.x[piece]), *curve.coefficients[:, piece].tolist()]

    def value(moment: Any, constants: Sequence[Any]) -> Any:
        x, y, b, c, d = constants
        u = moment - x
        return y + u * (b + u * (c + u * d))

    return LawPieces(curve.x.tolist(), constants, value)
