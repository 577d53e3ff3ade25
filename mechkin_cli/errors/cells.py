"""Columns of a table in double-double numbers: what their cells should be, and how far these true
values may be off themselves.

A column is evaluated as its cells are, with every number of its text taken exactly, and converted
by the exact factor of its unit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mechkin_cli.expressions import Expression, NumberNode, Quantity, Vector, exact_literal
from mechkin_cli.tape import DoubleDoubles, bounded, exactly
from mechkin_cli.tolerances import NO_DOUBT

if TYPE_CHECKING:
    from mechkin_cli.tables import FloatArray
    from mechkin_cli.units import UnitSystem


class TrueSource(Protocol):
    """The rows of a run in double-double (`rows.Repeated`)."""

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
        """Time and inputs of the rows, in the file's units."""
        ...

    def quantity(self, name: str) -> Quantity:
        """A parameter, direction or result by its dotted name, in SI."""
        ...


def true_values(expression: Expression, source: TrueSource) -> list[DoubleDoubles]:
    """The true values of an expression in file units, (rows,) each: one, of a vector three."""
    written = source.written.get(expression.text.strip())
    if written is not None:
        return [written]
    return _evaluated(expression, source, exact_literal)


def doubts(
    expression: Expression, source: TrueSource, true: Sequence[DoubleDoubles]
) -> list[FloatArray]:
    """How far true values may be off (rows,): by their own rounding, which is nearly all of them
    where terms cancel or a product underflows; and by that of what they are computed of, which is
    what they change by where every number is `OFF` in parts of the largest of its rows. Where the
    text divides by zero that is as much as the value itself."""
    symbols = {getattr(node, "symbol", "") for node in expression.nodes} - {""}
    if not symbols:
        return [np.zeros(source.rows) for _ in true]
    bounds, largest = _bounds(expression, source)
    nothing = NO_DOUBT * largest
    for k, (number, bound) in enumerate(zip(true, bounds, strict=True)):
        # none where a column is zero beside what it is computed of, and so is the bound
        is_zero = np.abs(number.high[np.isfinite(number.high)]).max(initial=0.0) <= nothing
        bounds[k] = np.where(is_zero & (bound <= nothing), 0.0, bound)
    if symbols & _WITH_POLES:
        off = _evaluated(expression, _Off(source), _off_literal)
        with np.errstate(invalid="ignore"):
            apart = [np.abs((one - other).high) for one, other in zip(true, off, strict=True)]
        bounds = [np.fmax(one, other) for one, other in zip(bounds, apart, strict=True)]
    return bounds


def _bounds(expression: Expression, source: TrueSource) -> tuple[list[FloatArray], float]:
    """Of the rounding of the operations, in the file's units, infinite where nothing is known; and
    the largest number that rows have in them."""
    rows = _Bounding(source)
    value = expression.evaluate(
        rows.quantity, source.units, lambda number: _each(exact_literal(number), bounded)
    )
    factor = float(source.units.unit(value.dimension).factor)
    bounds = [np.broadcast_to(bounded(part).bound, (source.rows,)) for part in _parts(value)]
    known = [np.where(np.isnan(bound), np.inf, bound) / factor for bound in bounds]
    return known, rows.largest / factor


def _evaluated(
    expression: Expression, source: TrueSource, literal: Callable[[NumberNode], Quantity]
) -> list[DoubleDoubles]:
    value = expression.evaluate(source.quantity, source.units, literal)
    factor, rows = source.units.unit(value.dimension).factor, np.zeros(source.rows)
    parts = [exactly(part) + rows for part in _parts(value)]
    return parts if factor == 1 else [part / DoubleDoubles.of_fraction(factor) for part in parts]


_WITH_POLES = {"/", "^", "pow", "tan", "log", "mod", "atanh", "unit_vector", "angle_between"}
"""Operations that may make any number of a rounding."""

OFF = float.fromhex("0x1p-98")
"""What numbers are changed by to estimate how far a column is off: above the rounding of
double-double, 2^-105, times a condition of a hundred, and far below that of doubles."""


class _Off:
    """The rows with every number off, each by another part."""

    def __init__(self, source: TrueSource) -> None:
        self.source = source
        self.rows, self.units, self.written = source.rows, source.units, source.written

    def quantity(self, name: str) -> Quantity:
        """As `TrueSource.quantity`."""
        part = OFF * (1.0 + sum(name.encode()) % 7 / 7.0)

        def moved(value: Any) -> Any:
            number = exactly(value)
            sizes = np.abs(number.high)
            return number + part * float(sizes[np.isfinite(sizes)].max(initial=0.0))

        return _each(self.source.quantity(name), moved)


class _Bounding:
    """The rows with numbers that know how far operations on them are off."""

    def __init__(self, source: TrueSource) -> None:
        self.source = source
        self.largest = 0.0

    def quantity(self, name: str) -> Quantity:
        """As `TrueSource.quantity`."""
        quantity = self.source.quantity(name)
        for part in _parts(quantity):
            sizes = np.abs(exactly(part).high)
            self.largest = max(self.largest, float(sizes[np.isfinite(sizes)].max(initial=0.0)))
        return _each(quantity, bounded)


def _parts(quantity: Quantity) -> list[Any]:
    """The value of a quantity, of a vector its components."""
    value: Any = quantity.value
    return list(value.components) if hasattr(value, "components") else [value]


def _each(quantity: Quantity, change: Callable[[Any], Any]) -> Quantity:
    """The quantity with each of its numbers changed."""
    parts = [change(part) for part in _parts(quantity)]
    value: Any = Vector(*parts) if hasattr(quantity.value, "components") else parts[0]
    rest = None if quantity.rest is None else change(quantity.rest)
    return Quantity(value, quantity.dimension, rest)


def _off_literal(number: NumberNode) -> Quantity:
    quantity = exact_literal(number)
    if number.unit is None and number.value == int(number.value):
        return quantity  # whole numbers are what they are: exponents, counts
    value: Any = exactly(quantity.value)
    return Quantity(value + OFF * value, quantity.dimension)
