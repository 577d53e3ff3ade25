"""The closed table of units.

Factors to SI are exact by definition: inch and pound from the international yard and pound
agreement of 1959, standard gravity 9.80665 m/s^2 from the third General Conference on Weights and
Measures (1901). Pi is carried as a fraction of 60 decimals, so a factor of degrees is the true
value rounded once.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from mechkin_cli.exact import PI as PI
from mechkin_cli.units.dimension import (
    ACCELERATION,
    ANGLE,
    ANGULAR_RATE,
    ENERGY,
    FORCE,
    FREQUENCY,
    LENGTH,
    MASS,
    POWER,
    TIME,
    Dimension,
)


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
    "Nm": "write N*m",
    "Nmm": "write N*mm",
}
"""What to write instead of words that are no unit but look like one."""
