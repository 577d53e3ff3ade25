"""The unit system of a file: in which units its bare numbers are written and its tables printed.

The unit of a dimension is composed by these rules:

- mass and time together make force: `mass^m` becomes `force^m`, so moments and energies are
  force*length, power is force*length/time, damping force*time/length; without time it stays mass;
- an angle with time is an angular rate, always per second: `rad/s`, `rad/s^2`;
- an angle beside mass or length is in rad, its time in s: torsional stiffness is moment per rad,
  torsional damping moment per rad/s, whatever the file's unit of angular rates;
- what is per angle is per rad;
- an angle alone is in the file's unit; what is left is in the file's units of length and time.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from mechkin_cli.tolerances import LARGEST_FACTOR
from mechkin_cli.units.compound import CompoundUnit, parse_unit
from mechkin_cli.units.conversion import Conversion, Number, conversion
from mechkin_cli.units.dimension import (
    ANGLE,
    ANGULAR_RATE,
    FORCE,
    LENGTH,
    MASS,
    TIME,
    Dimension,
    Exponent,
)
from mechkin_cli.units.errors import UnitError
from mechkin_cli.units.table import UNITS

FIELDS = {
    "length": LENGTH,
    "angle": ANGLE,
    "mass": MASS,
    "force": FORCE,
    "time": TIME,
    "angular_rate": ANGULAR_RATE,
}
"""Entries of the `units:` mapping and what they measure."""

_METRE = parse_unit("m")
_DEGREE = parse_unit("deg")
_KILOGRAM = parse_unit("kg")
_NEWTON = parse_unit("N")
_SECOND = parse_unit("s")
_RADIAN = parse_unit("rad")
_RADIAN_PER_SECOND = parse_unit("rad/s")


@dataclass(frozen=True, slots=True)
class UnitSystem:
    """Units of bare numbers and of tables."""

    length: CompoundUnit = _METRE
    angle: CompoundUnit = _DEGREE
    mass: CompoundUnit = _KILOGRAM
    force: CompoundUnit = _NEWTON
    time: CompoundUnit = _SECOND
    angular_rate: CompoundUnit = _RADIAN_PER_SECOND
    _conversions: dict[Dimension, Conversion] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @classmethod
    def from_mapping(cls, texts: Mapping[str, str | None]) -> UnitSystem:
        """The system of a file's `units:` mapping; what is left out or None keeps its default.

        Raises:
            UnitError: an entry that does not exist or is not a unit of its kind; `key` names it.
        """
        given = {key: text for key, text in texts.items() if text is not None}
        return cls(**{key: field_unit(key, text) for key, text in given.items()})

    def unit(self, dimension: Dimension) -> CompoundUnit:
        """The unit of a dimension, composed by the rules above."""
        reduced = dimension.reduced()
        time, length = reduced.time, reduced.length
        product = CompoundUnit()
        if reduced.mass and time:
            length, time = length - reduced.mass, time + 2 * reduced.mass
            product = self.force**reduced.mass
        elif reduced.mass:
            product = self.mass**reduced.mass
        bare = not (reduced.mass or reduced.length)
        return product * self.length**length * self._time_and_angle(time, reduced.angle, bare)

    def _time_and_angle(self, time: Exponent, angle: Exponent, bare: bool) -> CompoundUnit:
        """`bare`: there is neither mass nor length."""
        if angle and time:
            rate = self.angular_rate if bare else _RADIAN_PER_SECOND
            return rate**angle * _SECOND ** (time + angle)
        angle_unit = self.angle if bare and angle > 0 else _RADIAN
        return self.time**time * angle_unit**angle

    def label(self, dimension: Dimension) -> str:
        """The unit of a dimension as text: `in`, `rad/s`, `lbm*in^2/s^2`; empty for a number."""
        return str(self.unit(dimension))

    def factor(self, dimension: Dimension) -> float:
        """The SI value of one file unit of this dimension."""
        return self.conversion(dimension).apply(1.0)

    def to_si(self, value: Number, dimension: Dimension) -> Number:
        """A value in file units as SI; the same object when they are the same unit."""
        return self.conversion(dimension).apply(value)

    def from_si(self, value: Number, dimension: Dimension) -> Number:
        """An SI value in file units; the same object when they are the same unit."""
        return self.conversion(dimension).reverse(value)

    def conversion(self, dimension: Dimension) -> Conversion:
        """The conversion from file units to SI.

        Raises:
            UnitError: the factor is outside the range of numbers (exponents far from any use).
        """
        known = self._conversions.get(dimension)
        if known is None:
            known = self._conversions[dimension] = conversion(self.unit(dimension).factor)
        return known


def field_unit(key: str, text: str) -> CompoundUnit:
    """One entry of the `units:` mapping.

    Raises:
        UnitError: no such entry, no such unit, or a unit that measures something else.
    """
    dimension = FIELDS.get(key)
    if dimension is None:
        raise UnitError(f"units has no entry {key!r}", 0, f"entries are {', '.join(FIELDS)}", key)
    try:
        unit = parse_unit(text)
        size = conversion(unit.factor).apply(1.0)
    except UnitError as error:
        symbols = [name for name, unit in UNITS.items() if unit.dimension == dimension]
        hint = error.hint or f"units of {dimension.phrase} are {', '.join(symbols)}"
        raise UnitError(error.message, error.offset, hint, key) from None
    if unit.dimension != dimension:
        raise UnitError(
            f"the unit of {key} is {text.strip()!r}, which measures {unit.dimension.phrase}",
            0,
            f"give a unit of {dimension.phrase}, such as {getattr(UnitSystem(), key)}",
            key,
        )
    if not 1 / LARGEST_FACTOR <= size <= LARGEST_FACTOR:
        raise UnitError(
            f"one unit of {key} is {size:.0e} in SI (limit {LARGEST_FACTOR:.0e} or its inverse)",
            0,
            f"give a unit such as {getattr(UnitSystem(), key)}",
            key,
        )
    return unit
