"""Quantities with dimension: the closed table of units, compound units, and a file's unit system.

Hides how a unit is parsed and converted; nothing else in the package multiplies by a unit's factor.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.units.dimension import *
    from mechkin_cli.units.units import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "dimension": "ACCELERATION ANGLE ANGULAR_ACCELERATION ANGULAR_JERK ANGULAR_RATE DAMPING "
        "DIMENSIONLESS Dimension ENERGY FORCE INERTIA JERK LENGTH MASS MOMENT POWER STIFFNESS TIME "
        "TORSIONAL_DAMPING TORSIONAL_STIFFNESS VELOCITY "
        "VISCOSITY",
        "units": "CompoundUnit Conversion FIELDS UNITS UnitError UnitSystem bounded_exponent "
        "compound conversion named_unit parse_unit",
    },
)
