"""Columns of a table in double-double numbers: what their cells should be.

A column is evaluated as its cells are, with every number of its text taken exactly, and converted
by the exact factor of its unit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.expressions import Quantity, Vector, exact_literal
from mechkin_cli.tape import DoubleDoubles, bounded, exactly
from mechkin_cli.tolerances import NO_DOUBT

if TYPE_CHECKING:
    from mechkin_cli.expressions import Expression, NumberNode
    from mechkin_cli.tables import FloatArray
    from mechkin_cli.units import Dimension, UnitSystem


class TrueSource(Protocol):
    """The rows of a run in double-double (`analysis.errors.Repeated`)."""

    @property
    def rows(self) -> int:
        """Number of rows."""
        ...

    @property
    def units(self) -> UnitSystem:
        """Units of the mechanism file."""
        ...

    @property
    def written(self) -> Mapping[str, DoubleDoubles]:
        """What the rows were given, in the file's units."""
        ...

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by its dotted name, in SI."""
        ...


def true_values(expression: Expression, source: TrueSource) -> list[DoubleDoubles]:
    """The true values of an expression in file units, (rows,) each: one, of a vector three."""
    given = source.written.get(expression.text.strip())
    if given is not None:
        return [given]
    return _evaluated(expression, source, exact_literal)


def doubts(
    expression: Expression, source: TrueSource, true: Sequence[DoubleDoubles]
) -> list[FloatArray]:
    """How far true values may be off (rows,): by their own rounding, which is nearly all of them
    where a sum swallows what counts or a product is too small for a number; and by that of what
    they are computed of, which is what they change by where every number is `OFF` in parts of the
    largest of its rows. Where the text divides by zero that is as much as the value itself."""
    symbols = {getattr(node, "symbol", "") for node in expression.nodes} - {""}
    if not symbols:
        return [np.zeros(source.rows) for _ in true]
    found = [_unless_zero(*pair) for pair in zip(true, *_bounds(expression, source), strict=True)]
    if symbols & _WITH_POLES:
        off = _evaluated(expression, _Off(source), _off_literal)
        with np.errstate(invalid="ignore"):
            apart = [np.abs((one - other).high) for one, other in zip(true, off, strict=True)]
        found = [np.fmax(one, other) for one, other in zip(found, apart, strict=True)]
    return found


def _bounds(expression: Expression, source: TrueSource) -> tuple[list[FloatArray], list[float]]:
    """Of the rounding of the operations, in the file's units, infinite where nothing is known; and
    the largest of what rows have in them, for each."""
    rows = _Bounding(source)
    found = expression.evaluate(rows.quantity, source.units, _bounded_literal)
    factor = float(source.units.unit(found.dimension).factor)
    bounds = [np.broadcast_to(bounded(part).bound, (source.rows,)) for part in _parts(found)]
    known = [np.where(np.isnan(bound), np.inf, bound) / factor for bound in bounds]
    return known, [rows.largest / factor] * len(known)


def _unless_zero(true: DoubleDoubles, bound: FloatArray, largest: float) -> FloatArray:
    """The bound; none where a column is zero beside what it is computed of, and so is the bound."""
    nothing = NO_DOUBT * largest
    is_zero = np.abs(true.high[np.isfinite(true.high)]).max(initial=0.0) <= nothing
    return np.where(is_zero & (bound <= nothing), 0.0, bound)


def _evaluated(
    expression: Expression, source: TrueSource, literal: Callable[[NumberNode], Quantity]
) -> list[DoubleDoubles]:
    found = expression.evaluate(source.quantity, source.units, literal)
    return [_in_file_units(part, found.dimension, source) for part in _parts(found)]


_WITH_POLES = {"/", "^", "pow", "tan", "log", "mod", "atanh", "unit_vector", "angle_between"}
"""Operations that may make any number of a rounding."""

OFF = float.fromhex("0x1p-98")
"""What numbers are changed by to tell how far a column is off: above the rounding of double-double,
2^-105, times a condition of a hundred, and far below that of doubles."""


class _Off:
    """The rows with every number off, each by another part."""

    def __init__(self, source: TrueSource) -> None:
        self.source = source
        self.rows, self.units, self.written = source.rows, source.units, source.written

    def quantity(self, name: str) -> Quantity:
        """As `TrueSource.quantity`."""
        found = self.source.quantity(name)
        part = OFF * (1.0 + sum(name.encode()) % 7 / 7.0)
        return _each(found, lambda value: _moved(value, part))


class _Bounding:
    """The rows with numbers that know how far operations on them are off."""

    def __init__(self, source: TrueSource) -> None:
        self.source = source
        self.largest = 0.0

    def quantity(self, name: str) -> Quantity:
        """As `TrueSource.quantity`."""
        found = self.source.quantity(name)
        for part in _parts(found):
            sizes = np.abs(exactly(part).high)
            self.largest = max(self.largest, float(sizes[np.isfinite(sizes)].max(initial=0.0)))
        return _each(found, bounded)


def _bounded_literal(number: NumberNode) -> Quantity:
    return _each(exact_literal(number), bounded)


def _parts(found: Quantity) -> list[Any]:
    """The value of a quantity, of a vector its components."""
    value: Any = found.value
    return list(value.components) if hasattr(value, "components") else [value]


def _each(found: Quantity, change: Callable[[Any], Any]) -> Quantity:
    """The quantity with each of its numbers changed."""
    parts = [change(part) for part in _parts(found)]
    value: Any = Vector(*parts) if hasattr(found.value, "components") else parts[0]
    rest = None if found.rest is None else change(found.rest)
    return Quantity(value, found.dimension, rest)


def _moved(value: Any, part: float) -> Any:
    number = exactly(value)
    sizes = np.abs(number.high)
    return number + part * float(sizes[np.isfinite(sizes)].max(initial=0.0))


def _off_literal(number: NumberNode) -> Quantity:
    found = exact_literal(number)
    if number.unit is None and number.value == int(number.value):
        return found  # whole numbers are what they are: exponents, counts
    value: Any = exactly(found.value)
    return Quantity(value + OFF * value, found.dimension)


def _in_file_units(value: Any, dimension: Dimension, source: TrueSource) -> DoubleDoubles:
    factor = source.units.unit(dimension).factor
    rows = exactly(value) + np.zeros(source.rows)
    return rows if factor == 1 else rows / DoubleDoubles.of_fraction(factor)
