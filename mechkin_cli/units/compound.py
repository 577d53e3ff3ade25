"""Compound units: products of powers of the units in the table, such as `lbm*in/s^2`.

Grammar: `unit (("*" | "/") unit)*`, where `unit = symbol ["^" integer]` and the first one may be
`1` (`1/s`). `**` is read as `^`. A `/` takes only the next unit: `N*m/rad/s` is N m/(rad s).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from mechkin_cli.units.conversion import conversion
from mechkin_cli.units.dimension import DIMENSIONLESS, Dimension, Exponent, format_product, plain
from mechkin_cli.units.errors import UnitError
from mechkin_cli.units.table import MISTAKES, UNITS, Unit

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
            raise UnitError(
                f"{text!r} is not a unit", position, "write units as lbm*in/s^2, N*m or rad/s"
            )
        if match[1] != "1":
            unit = named_unit(match[1], match.start(1))
            terms.append((unit.symbol, sign * bounded_exponent(match[2] or "1", match.start(2))))
        position = match.end()
        if position == len(text):
            return compound(terms)
        if text[position] not in "*/":
            raise UnitError(
                f"unexpected {text[position]!r} in the unit {text!r}",
                position,
                "join units with * and /",
            )
        sign = -1 if text[position] == "/" else 1
        position += 1


def named_unit(symbol: str, offset: int = 0) -> Unit:
    """The unit of a symbol.

    Raises:
        UnitError: the table has no such unit; the hint names what was probably meant.
    """
    unit = UNITS.get(symbol)
    if unit is None:
        raise UnitError(f"{symbol[:MAX_QUOTED]!r} is not a unit", offset, _suggestion(symbol))
    return unit


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


def _suggestion(symbol: str) -> str | None:
    if symbol in MISTAKES:
        return MISTAKES[symbol]
    from difflib import get_close_matches

    same_letters = [name for name in UNITS if name.lower() == symbol.lower()]
    nearest = same_letters or get_close_matches(symbol, UNITS, 3, 0.6)
    return f"did you mean {' or '.join(nearest)}?" if nearest else None
