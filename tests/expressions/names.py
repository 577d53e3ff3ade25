"""Names that the expression tests use, with values chosen by hand."""

from __future__ import annotations

import numpy as np

from mechkin_cli.expressions.quantity import Quantity, Vector, lookup
from mechkin_cli.units.dimension import (
    ANGLE,
    ANGULAR_RATE,
    DIMENSIONLESS,
    FORCE,
    LENGTH,
    MASS,
    MOMENT,
    VELOCITY,
)
from mechkin_cli.units.units import UnitSystem

INCH_POUND = UnitSystem.from_mapping(
    {"length": "in", "angle": "deg", "mass": "lbm", "force": "lbm*in/s^2"}
)

QUANTITIES = {
    "P1": Quantity(0.5, LENGTH),
    "P2": Quantity(2.0, LENGTH),
    "m": Quantity(3.0, MASS),
    "n": Quantity(4.0, DIMENSIONLESS),
    "alpha": Quantity(0.25, ANGLE),
    "A": Quantity(Vector(1.0, 2.0, 3.0), DIMENSIONLESS),
    "B": Quantity(Vector(-1.0, 0.5, 2.0), DIMENSIONLESS),
    "C": Quantity(Vector(4.0, 0.0, -2.0), DIMENSIONLESS),
    "p.position": Quantity(Vector(3.0, 4.0, 12.0), LENGTH),
    "p.velocity": Quantity(Vector(np.array([1.0, 2.0]), 0.0, np.array([2.0, 4.0])), VELOCITY),
    "O1.theta": Quantity(np.array([0.5, -4.0]), ANGLE),
    "O1.theta_dot": Quantity(np.array([8.0, 2.0]), ANGULAR_RATE),
    "O1.effort": Quantity(np.array([1.5, -1.0]), MOMENT),
    "O3.force": Quantity(Vector(np.array([6.0, 0.0]), 1.0, 0.0), FORCE),
    "E1.x": Quantity(7.0, LENGTH),
    "slide.s": Quantity(np.array([1.0, 0.0]), LENGTH),
}

resolve = lookup(QUANTITIES)
