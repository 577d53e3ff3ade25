"""Dimensions: products of powers of length, mass, time and angle.

Angle is a dimension of its own, so that `cos(12)` and `theta + 1` can be refused. It becomes a
plain number only in an arc (angle times length) and in work (moment times angle, whose length
exponent is positive too). The rule: *where a length with a positive exponent is present, a positive
angle exponent does not count* (`Dimension.reduced`). It is applied where dimensions are compared,
not where they are multiplied, so `(theta*r)/r` is an angle again.
"""

from __future__ import annotations

import operator
from fractions import Fraction
from functools import lru_cache

from mechkin_cli.record import NamedTuple

Exponent = int | Fraction


class Dimension(NamedTuple):
    """Exponents of the base dimensions; fractions only come from square roots. A tuple, as such are
    keys of whatever is remembered, and hashed more often than anything else."""

    length: Exponent = 0
    mass: Exponent = 0
    time: Exponent = 0
    angle: Exponent = 0

    @property
    def exponents(self) -> tuple[Exponent, Exponent, Exponent, Exponent]:
        """Exponents of length, mass, time, angle."""
        return (self.length, self.mass, self.time, self.angle)

    @property
    def dimensionless(self) -> bool:
        """Whether all exponents are zero; an angle is not dimensionless."""
        return not (self.length or self.mass or self.time or self.angle)

    def __mul__(self, other: Dimension) -> Dimension:  # type: ignore[override]
        return _product(self, other)

    def __truediv__(self, other: Dimension) -> Dimension:
        return _quotient(self, other)

    def __pow__(self, exponent: Exponent) -> Dimension:
        return Dimension(*(plain(power * exponent) for power in self.exponents))

    def reduced(self) -> Dimension:
        """The dimension with the angle of an arc or of work taken as a plain number."""
        if self.length > 0 and self.angle > 0:
            return Dimension(self.length, self.mass, self.time)
        return self

    def compatible(self, other: Dimension) -> bool:
        """Whether values of the two can be added, compared, or stand for each other."""
        return self == other or self.reduced() == other.reduced()

    @property
    def phrase(self) -> str:
        """The dimension in words with an article: `a length`, `an angular rate`."""
        reduced = self.reduced()
        return _PHRASES.get(reduced) or f"a quantity of dimension {reduced}"

    def __str__(self) -> str:
        """The dimension as a product: `length^2/time`."""
        names = ("mass", "length", "angle", "time")
        return format_product([(name, getattr(self, name)) for name in names])


# Of the few dimensions that there are each mechanism asks for the same products hundreds of times.


@lru_cache(maxsize=4096)
def _product(one: Dimension, other: Dimension) -> Dimension:
    return Dimension(*map(plain, map(operator.add, one.exponents, other.exponents)))


@lru_cache(maxsize=4096)
def _quotient(one: Dimension, other: Dimension) -> Dimension:
    return Dimension(*map(plain, map(operator.sub, one.exponents, other.exponents)))


def format_product(factors: list[tuple[str, Exponent]]) -> str:
    """A product of powers as text: `lbm*in^2/s^2`, `1/s`; empty without factors."""
    above = [_power(name, exponent) for name, exponent in factors if exponent > 0]
    below = ["/" + _power(name, -exponent) for name, exponent in factors if exponent < 0]
    return ("*".join(above) or ("1" if below else "")) + "".join(below)


def _power(name: str, exponent: Exponent) -> str:
    if exponent == 1:
        return name
    return f"{name}^{exponent}" if isinstance(exponent, int) else f"{name}^({exponent})"


def plain(exponent: Exponent) -> Exponent:
    """Whole exponents as int, so that they print and compare simply."""
    return exponent.numerator if exponent.denominator == 1 else exponent


DIMENSIONLESS = Dimension()
LENGTH = Dimension(length=1)
AREA = Dimension(length=2)
VOLUME = Dimension(length=3)
MASS = Dimension(mass=1)
TIME = Dimension(time=1)
FREQUENCY = Dimension(time=-1)
ANGLE = Dimension(angle=1)
ANGULAR_RATE = Dimension(angle=1, time=-1)
ANGULAR_ACCELERATION = Dimension(angle=1, time=-2)
ANGULAR_JERK = Dimension(angle=1, time=-3)
VELOCITY = Dimension(length=1, time=-1)
ACCELERATION = Dimension(length=1, time=-2)
JERK = Dimension(length=1, time=-3)
FORCE = Dimension(mass=1, length=1, time=-2)
MOMENT = Dimension(mass=1, length=2, time=-2)
ENERGY = MOMENT
POWER = Dimension(mass=1, length=2, time=-3)
INERTIA = Dimension(mass=1, length=2)
STIFFNESS = FORCE / LENGTH
DAMPING = FORCE / VELOCITY
VISCOSITY = DAMPING / LENGTH
TORSIONAL_STIFFNESS = MOMENT / ANGLE
TORSIONAL_DAMPING = MOMENT / ANGULAR_RATE

_PHRASES = {
    DIMENSIONLESS: "a dimensionless number",
    LENGTH: "a length",
    AREA: "an area",
    VOLUME: "a volume",
    MASS: "a mass",
    TIME: "a time",
    FREQUENCY: "a frequency",
    ANGLE: "an angle",
    ANGULAR_RATE: "an angular rate",
    ANGULAR_ACCELERATION: "an angular acceleration",
    ANGULAR_JERK: "an angular jerk",
    VELOCITY: "a velocity",
    ACCELERATION: "an acceleration",
    JERK: "a jerk",
    FORCE: "a force",
    MOMENT: "a moment or energy",
    POWER: "a power",
    INERTIA: "a moment of inertia",
    STIFFNESS: "a stiffness",
    DAMPING: "a damping",
    VISCOSITY: "a dynamic viscosity",
    TORSIONAL_STIFFNESS: "a torsional stiffness",
    TORSIONAL_DAMPING: "a torsional damping",
}
