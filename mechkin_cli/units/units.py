"""Units: exact conversion, the closed table, compound units such as `lbm*in/s^2`, unit systems.

Grammar: `unit (("*" | "/") unit)*`, where `unit = symbol ["^" integer]` and the first one may be
`1` (`1/s`). `**` is read as `^`. A `/` takes only the next unit: `N*m/rad/s` is N m/(rad s).

Factors to SI are exact by definition: inch and pound from the international yard and pound
agreement of 1959, standard gravity 9.80665 m/s^2 from the third General Conference on Weights and
Measures (1901). Pi is a fraction of 60 decimals, so a factor of degrees is the true value rounded
once.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from mechkin_cli.diagnostics import MechkinError
from mechkin_cli.exact import PI, Exact
from mechkin_cli.record import NamedTuple, dataclass, field
from mechkin_cli.tolerances import LARGEST_CONVERSION, LARGEST_FACTOR
from mechkin_cli.units.dimension import (
    ACCELERATION,
    ANGLE,
    ANGULAR_RATE,
    DIMENSIONLESS,
    ENERGY,
    FORCE,
    FREQUENCY,
    LENGTH,
    MASS,
    POWER,
    TIME,
    Dimension,
    Exponent,
    format_product,
    plain,
)


class UnitError(MechkinError):
    """A unit that does not exist, is malformed, or does not measure what it is used for.

    `offset` counts characters from the start of the unit text; `key` is the entry of the file's
    `units:` mapping, where the text stands in one.
    """

    def __init__(
        self, message: str, offset: int = 0, hint: str | None = None, key: str | None = None
    ) -> None:
        self.message = message
        self.offset = offset
        self.hint = hint
        self.key = key
        super().__init__(message)

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message


Number = TypeVar("Number", float, NDArray[np.float64])


class Conversion(NamedTuple):
    """Values times `multiplier` over `divisor`, of which at least one is exactly 1.

    So there are as few roundings as double arithmetic allows: a factor that is a double (12 in a
    foot) multiplies, one whose inverse is (1000 mm in a metre) divides, and only other factors are
    rounded themselves, to an `Exact`.
    """

    multiplier: float
    divisor: float

    def apply(self, value: Number) -> Number:
        """The value in the target unit."""
        if self.divisor != 1.0:
            return value / self.divisor
        return value * self.multiplier if self.multiplier != 1.0 else value

    def reverse(self, value: Number) -> Number:
        """The value in the source unit."""
        if self.divisor != 1.0:
            return value * self.divisor
        return value / self.multiplier if self.multiplier != 1.0 else value


def conversion(factor: Fraction) -> Conversion:
    """The conversion by a positive factor.

    Raises:
        UnitError: the factor is outside the range of double numbers.
    """
    multiplier = _double(factor)
    if factor != multiplier:
        divisor = _double(1 / factor)
        if factor * Fraction(divisor) == 1:
            return Conversion(1.0, divisor)
        multiplier = Exact(multiplier, factor)
    return Conversion(multiplier, 1.0)


def _double(factor: Fraction) -> float:
    try:
        value = float(factor)
    except OverflowError:
        value = 0.0
    if not 1.0 / LARGEST_CONVERSION <= value <= LARGEST_CONVERSION:
        raise UnitError("the conversion factor of this unit is outside the range of numbers")
    return value


class Unit(NamedTuple):
    """A named unit: one of it is `factor` SI units (m, kg, s, rad) of its dimension."""

    symbol: str
    dimension: Dimension
    factor: Fraction


_INCH = Fraction(254, 10_000)
_POUND = Fraction(45_359_237, 100_000_000)
_GRAVITY = Fraction(980_665, 100_000)
_POUND_FORCE = _POUND * _GRAVITY
_PRESSURE = FORCE / LENGTH**2

_TABLE: dict[Dimension, dict[str, Fraction | int]] = {
    LENGTH: {
        "m": 1,
        "km": 1000,
        "cm": Fraction(1, 100),
        "mm": Fraction(1, 1000),
        "um": Fraction(1, 10**6),
        "in": _INCH,
        "ft": 12 * _INCH,
        "yd": 36 * _INCH,
        "mil": _INCH / 1000,
    },
    MASS: {
        "kg": 1,
        "g": Fraction(1, 1000),
        "t": 1000,
        "lbm": _POUND,
        "oz": _POUND / 16,
        "slug": _POUND_FORCE / (12 * _INCH),
    },
    TIME: {"s": 1, "ms": Fraction(1, 1000), "min": 60, "h": 3600},
    ANGLE: {
        "rad": 1,
        "mrad": Fraction(1, 1000),
        "deg": PI / 180,
        "arcmin": PI / 10_800,
        "arcsec": PI / 648_000,
        "turn": 2 * PI,
        "rev": 2 * PI,
    },
    FORCE: {
        "N": 1,
        "mN": Fraction(1, 1000),
        "kN": 1000,
        "MN": 10**6,
        "dyn": Fraction(1, 10**5),
        "kgf": _GRAVITY,
        "lbf": _POUND_FORCE,
        "ozf": _POUND_FORCE / 16,
        "pdl": _POUND * 12 * _INCH,
    },
    ENERGY: {"J": 1, "mJ": Fraction(1, 1000), "kJ": 1000},
    POWER: {"W": 1, "mW": Fraction(1, 1000), "kW": 1000},
    _PRESSURE: {
        "Pa": 1,
        "kPa": 1000,
        "MPa": 10**6,
        "GPa": 10**9,
        "bar": 10**5,
        "psi": _POUND_FORCE / _INCH**2,
    },
    ANGULAR_RATE: {"rpm": PI / 30},
    FREQUENCY: {"Hz": 1},
    ACCELERATION: {"g0": _GRAVITY},
}

UNITS: dict[str, Unit] = {
    symbol: Unit(symbol, dimension, Fraction(factor))
    for dimension, symbols in _TABLE.items()
    for symbol, factor in symbols.items()
}
"""Every unit by its symbol."""

MISTAKES = {
    "lb": "write lbm for a mass or lbf for a force",
    "lbs": "write lbm for a mass or lbf for a force",
    "pound": "write lbm for a mass or lbf for a force",
    "inch": "write in",
    "inches": "write in",
    "foot": "write ft",
    "feet": "write ft",
    "meter": "write m",
    "metre": "write m",
    "degree": "write deg",
    "degrees": "write deg",
    "radian": "write rad",
    "radians": "write rad",
    "sec": "write s",
    "second": "write s",
    "seconds": "write s",
    "rps": "write rev/s or rad/s",
    "hr": "write h",
    "mile": "write mi",
    "newton": "write N",
    "minute": "write min",
    "hour": "write h",
    "tonne": "write t",
    "watt": "write W",
    "joule": "write J",
    **{
        f"{prefix}{stem}": f"write {letter}{unit}"
        for stem, unit in (("meter", "m"), ("metre", "m"), ("gram", "g"), ("newton", "N"))
        for prefix, letter in (("kilo", "k"), ("centi", "c"), ("milli", "m"), ("micro", "u"))
        if f"{letter}{unit}" in UNITS
    },
}
"""What to write instead of words that look like a unit but are not."""


MAX_UNIT_LENGTH = 200
"""Characters of a unit text; real ones have about ten."""

MAX_QUOTED = 40
"""Characters of the user's text repeated in a message."""

MAX_TOTAL_EXPONENT = 24
"""Sum of the exponents' sizes in a unit; keeps every factor far inside the range of numbers."""

_FACTOR = re.compile(r"\s*([A-Za-z_][A-Za-z0-9_]*|1(?![0-9.]))\s*(?:(?:\^|\*\*)\s*(-?[0-9]+))?\s*")


@dataclass(frozen=True, slots=True)
class CompoundUnit:
    """A product of powers of units: pairs of symbol and exponent, each symbol once."""

    terms: tuple[tuple[str, Exponent], ...] = ()

    @property
    def dimension(self) -> Dimension:
        """The product of the dimensions."""
        product = DIMENSIONLESS
        for symbol, exponent in self.terms:
            product = product * UNITS[symbol].dimension ** exponent
        return product

    @property
    def factor(self) -> Fraction:
        """The factor to SI, exact for whole exponents; the others are multiples of one half.

        Raises:
            UnitError: the factor of a unit with half exponents is outside the range of numbers.
        """
        if all(isinstance(exponent, int) for _, exponent in self.terms):
            return _product(self.terms)
        square = conversion(_product(tuple((symbol, 2 * power) for symbol, power in self.terms)))
        return Fraction(math.sqrt(square.apply(1.0)))

    def __mul__(self, other: CompoundUnit) -> CompoundUnit:
        return CompoundUnit(_merged((*self.terms, *other.terms)))

    def __pow__(self, exponent: Exponent) -> CompoundUnit:
        return CompoundUnit(_merged((symbol, power * exponent) for symbol, power in self.terms))

    def __str__(self) -> str:
        return format_product(list(self.terms))


def parse_unit(text: str) -> CompoundUnit:
    """A unit text as a compound unit.

    Raises:
        UnitError: unknown symbol, malformed text, or exponents that are too large.
    """
    if len(text) > MAX_UNIT_LENGTH:
        raise UnitError(f"a unit of {len(text)} characters; at most {MAX_UNIT_LENGTH} are read")
    terms: list[tuple[str, int]] = []
    position, sign = 0, 1
    while True:
        match = _FACTOR.match(text, position)
        if match is None or (match[1] == "1" and terms):
            hint = "write units as lbm*in/s^2, N*m or rad/s"
            raise UnitError(f"{text!r} is not a unit", position, hint)
        if match[1] != "1":
            unit = named_unit(match[1], match.start(1))
            terms.append((unit.symbol, sign * bounded_exponent(match[2] or "1", match.start(2))))
        position = match.end()
        if position == len(text):
            return compound(terms)
        if text[position] not in "*/":
            message = f"unexpected {text[position]!r} in the unit {text!r}"
            raise UnitError(message, position, "join units with * and /")
        sign = -1 if text[position] == "/" else 1
        position += 1


def named_unit(symbol: str, offset: int = 0) -> Unit:
    """The unit of a symbol.

    Raises:
        UnitError: the table has no such unit; the hint names the nearest ones.
    """
    if symbol in UNITS:
        return UNITS[symbol]
    word = symbol.casefold()
    hint = MISTAKES.get(symbol) or MISTAKES.get(word) or MISTAKES.get(word.removesuffix("s"))
    if hint is None:
        from difflib import get_close_matches

        same_letters = [name for name in UNITS if name.lower() == word]
        product = None if same_letters else _joined(symbol)
        nearest = same_letters or get_close_matches(symbol, UNITS, 3, 0.6)
        if product:
            hint = f"write {product}"
        elif nearest:
            hint = f"did you mean {' or '.join(nearest)}?"
    raise UnitError(f"{symbol[:MAX_QUOTED]!r} is not a unit", offset, hint)


_FORCE_OR_MASS = re.compile(r"(k?N|kg|lbf|lbm)([A-Za-z]+)([2-4]?)")


def _joined(symbol: str) -> str | None:
    """The product that units written without signs mean.

    >>> _joined("Nmm"), _joined("kgm2"), _joined("Nx")
    ('N*mm', 'kg*m^2', None)
    """
    found = _FORCE_OR_MASS.fullmatch(symbol[:MAX_QUOTED])
    if found is None or found[2] not in UNITS:
        return None
    return f"{found[1]}*{found[2]}^{found[3]}" if found[3] else f"{found[1]}*{found[2]}"


def bounded_exponent(digits: str, offset: int = 0) -> int:
    """The exponent of a unit, from its digits.

    Raises:
        UnitError: it is larger than `MAX_TOTAL_EXPONENT`.
    """
    exponent = int(digits) if len(digits) <= 4 else MAX_TOTAL_EXPONENT + 1
    if abs(exponent) > MAX_TOTAL_EXPONENT:
        raise UnitError(
            f"the exponent {digits[:8]} of a unit is too large (limit {MAX_TOTAL_EXPONENT})",
            max(offset, 0),
        )
    return exponent


def compound(terms: Iterable[tuple[str, int]]) -> CompoundUnit:
    """The product of powers of units; symbols may repeat.

    Raises:
        UnitError: the exponents' sizes add up to more than `MAX_TOTAL_EXPONENT`.
    """
    terms = tuple(terms)
    total = sum(abs(exponent) for _, exponent in terms)
    if total > MAX_TOTAL_EXPONENT:
        raise UnitError(f"the exponents of a unit add up to {total} (limit {MAX_TOTAL_EXPONENT})")
    return CompoundUnit(_merged(terms))


def _merged(terms: Iterable[tuple[str, Exponent]]) -> tuple[tuple[str, Exponent], ...]:
    """The terms with every symbol once, in order of first appearance, without zero exponents."""
    exponents: dict[str, Exponent] = {}
    for symbol, exponent in terms:
        exponents[symbol] = plain(exponents.get(symbol, 0) + exponent)
    return tuple((symbol, exponent) for symbol, exponent in exponents.items() if exponent)


def _product(terms: Iterable[tuple[str, Exponent]]) -> Fraction:
    product = Fraction(1)
    for symbol, exponent in terms:
        product *= UNITS[symbol].factor ** int(exponent)
    return product


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
    """Units of the bare numbers and of the tables of a file.

    The unit of a dimension is composed by these rules:

    - mass and time together make force: `mass^m` becomes `force^m`, so moments and energies are
      force*length, power is force*length/time, damping force*time/length; without time it stays
      mass;
    - an angle with time is an angular rate, always per second: `rad/s`, `rad/s^2`;
    - an angle beside mass or length is in rad, its time in s: torsional stiffness is moment per
      rad, torsional damping moment per rad/s, whatever the file's unit of angular rates;
    - a quantity per angle is per rad;
    - an angle alone is in the file's unit; the rest is in the file's units of length and time.
    """

    length: CompoundUnit = _METRE
    angle: CompoundUnit = _DEGREE
    mass: CompoundUnit = _KILOGRAM
    force: CompoundUnit = _NEWTON
    time: CompoundUnit = _SECOND
    angular_rate: CompoundUnit = _RADIAN_PER_SECOND
    _conversions: dict[Dimension, Conversion] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    _units: dict[Dimension, CompoundUnit] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    _labels: dict[Dimension, str] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @classmethod
    def from_mapping(cls, texts: Mapping[str, str | None]) -> UnitSystem:
        """The system of a file's `units:` mapping; entries that are missing or None have defaults.

        Raises:
            UnitError: an entry that does not exist or is not a unit of its kind; `key` names it.
        """
        return _system(tuple((key, text) for key, text in texts.items() if text is not None))

    def unit(self, dimension: Dimension) -> CompoundUnit:
        """The unit of a dimension, composed by the rules above."""
        known = self._units.get(dimension)
        if known is None:
            known = self._units[dimension] = self._composed(dimension)
        return known

    def _composed(self, dimension: Dimension) -> CompoundUnit:
        reduced = dimension.reduced()
        time, length = reduced.time, reduced.length
        product = CompoundUnit()
        if reduced.mass and time:
            length, time = length - reduced.mass, time + 2 * reduced.mass
            product = self.force**reduced.mass
        elif reduced.mass:
            product = self.mass**reduced.mass
        product, angle = product * self.length**length, reduced.angle
        alone = not (reduced.mass or reduced.length)
        if angle and time:
            rate = self.angular_rate if alone else _RADIAN_PER_SECOND
            return product * (rate**angle * _SECOND ** (time + angle))
        angle_unit = self.angle if alone and angle > 0 else _RADIAN
        return product * (self.time**time * angle_unit**angle)

    def label(self, dimension: Dimension) -> str:
        """The unit of a dimension as text: `in`, `rad/s`, `lbm*in^2/s^2`; empty for a number."""
        known = self._labels.get(dimension)
        if known is None:
            known = self._labels[dimension] = str(self.unit(dimension))
        return known

    def factor(self, dimension: Dimension) -> float:
        """The SI value of one file unit of this dimension."""
        return self.conversion(dimension).apply(1.0)

    def to_si(self, value: Number, dimension: Dimension) -> Number:
        """A value in file units as SI; the same object when they are the same unit."""
        return self.conversion(dimension).apply(value)

    def from_si(self, value: Number, dimension: Dimension) -> Number:
        """An SI value in file units; the same object when they are the same unit."""
        return self.conversion(dimension).reverse(value)

    def text(self, value: float, dimension: Dimension) -> str:
        """An SI value in file units as messages have it: `12.5 mm`."""
        return f"{float(self.from_si(value, dimension)):.12g} {self.label(dimension)}".rstrip()

    def conversion(self, dimension: Dimension) -> Conversion:
        """The conversion from file units to SI.

        Raises:
            UnitError: the factor is outside the range of numbers (exponents far from any use).
        """
        known = self._conversions.get(dimension)
        if known is None:
            known = self._conversions[dimension] = conversion(self.unit(dimension).factor)
        return known


@lru_cache(maxsize=64)
def _system(texts: tuple[tuple[str, str], ...]) -> UnitSystem:
    """The system of some entries: variants of a file have the same, with all that it remembers."""
    return UnitSystem(**{key: field_unit(key, text) for key, text in texts})


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
    default = getattr(UnitSystem(), key)
    if unit.dimension != dimension:
        message = f"the unit of {key} is {text.strip()!r}, which measures {unit.dimension.phrase}"
        raise UnitError(message, 0, f"give a unit of {dimension.phrase}, such as {default}", key)
    if not 1 / LARGEST_FACTOR <= size <= LARGEST_FACTOR:
        limit = f"(limit {LARGEST_FACTOR:.0e} or its inverse)"
        message = f"one unit of {key} is {size:.0e} in SI {limit}"
        raise UnitError(message, 0, f"give a unit such as {default}", key)
    return unit
