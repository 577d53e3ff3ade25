"""Quantities with dimension: the closed table of units, compound units, and a file's unit system.

Hides how a unit is parsed and converted; nothing else in the package multiplies by a unit's factor.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.units.dimension import (
        ACCELERATION as ACCELERATION,
        ANGLE as ANGLE,
        ANGULAR_ACCELERATION as ANGULAR_ACCELERATION,
        ANGULAR_JERK as ANGULAR_JERK,
        ANGULAR_RATE as ANGULAR_RATE,
        DAMPING as DAMPING,
        DIMENSIONLESS as DIMENSIONLESS,
        ENERGY as ENERGY,
        FORCE as FORCE,
        INERTIA as INERTIA,
        JERK as JERK,
        LENGTH as LENGTH,
        MASS as MASS,
        MOMENT as MOMENT,
        POWER as POWER,
        STIFFNESS as STIFFNESS,
        TIME as TIME,
        TORSIONAL_DAMPING as TORSIONAL_DAMPING,
        TORSIONAL_STIFFNESS as TORSIONAL_STIFFNESS,
        VELOCITY as VELOCITY,
        Dimension as Dimension,
    )
    from mechkin_cli.units.units import (
        FIELDS as FIELDS,
        UNITS as UNITS,
        CompoundUnit as CompoundUnit,
        Conversion as Conversion,
        UnitError as UnitError,
        UnitSystem as UnitSystem,
        bounded_exponent as bounded_exponent,
        compound as compound,
        conversion as conversion,
        named_unit as named_unit,
        parse_unit as parse_unit,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "dimension": "ACCELERATION ANGLE ANGULAR_ACCELERATION ANGULAR_JERK ANGULAR_RATE DAMPING "
        "DIMENSIONLESS Dimension ENERGY FORCE INERTIA JERK LENGTH MASS MOMENT POWER STIFFNESS TIME "
        "TORSIONAL_DAMPING TORSIONAL_STIFFNESS VELOCITY",
        "units": "CompoundUnit Conversion FIELDS UNITS UnitError UnitSystem bounded_exponent "
        "compound conversion named_unit parse_unit",
    },
)
