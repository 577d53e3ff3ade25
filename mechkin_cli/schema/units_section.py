"""`units:` - the units of bare numbers in the file and of the tables."""

from typing import Annotated

from mechkin_cli.schema.base import Section
from mechkin_cli.schema.rules import Before, Named, Shown
from mechkin_cli.schema.scalars import plain_text

UnitText = Annotated[
    str,
    Before(plain_text),
    Shown(("string",), "a unit, or units joined by * / ^", ("in", "deg", "lbm*in/s^2")),
    Named("UnitText"),
]


class UnitsSection(Section):
    """The units of bare numbers and of the tables; what is left out is in m, deg, kg, N, s.

    The unit of moments is force times length. Rates of lengths are per `time`; angular rates are in
    rad/s unless `angular_rate` says otherwise. Torsional stiffness is per rad, torsional damping
    per rad/s, whatever `angle` and `angular_rate` are.
    """

    length: UnitText = "m"
    """Unit of lengths, for example m, mm, in."""
    angle: UnitText = "deg"
    """Unit of angles: deg or rad."""
    mass: UnitText = "kg"
    """Unit of masses, for example kg, lbm."""
    force: UnitText = "N"
    """Unit of forces, for example N, lbf, lbm*in/s^2; left out, N whatever the other units are."""
    time: UnitText = "s"
    """Unit of time, for example s, min."""
    angular_rate: UnitText = "rad/s"
    """Unit of angular rates, for example rad/s, rpm."""


METRIC = UnitsSection()
"""The units where a file names none."""
