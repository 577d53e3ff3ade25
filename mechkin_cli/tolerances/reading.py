"""What a file may say: numbers, rows, tables, drawings."""

from __future__ import annotations

from typing import Final

# --- numbers -------------------------------------------------------------------------------------

LARGEST_NUMBER: Final = 1e100
"""SI value of a field above which it is a slip of the pen: products of three such values are the
last that stay doubles (1.8e308); beyond, cells would be empty without a reason."""

SMALLEST_SIZE: Final = 1e-100
"""Size of a drawing in m below which it is a slip of the pen: the inverse of its square is the last
that stays a double with what it is multiplied by; atoms are drawn with 1e-10."""

GRAVITY_ON_EARTH: Final = 0.025
"""Parts of standard gravity by which a number may differ and still be meant as gravity: on Earth it
varies by 0.004, and 10 m/s^2 is its round number."""

LARGEST_FACTOR: Final = 1e30
"""Size in SI beyond which (or below whose inverse) a unit of a file is taken for a mistake."""

LARGEST_CONVERSION: Final = 1e290
"""Conversion factor beyond which (or below whose inverse) products with numbers of a file are no
doubles any more."""

# --- rows and tables -----------------------------------------------------------------------------

OVERSHOOT: Final = 0.01
"""Parts of the range of a table's values by which the curve through them may leave it before a note
says so: less is not seen in a figure, and smooth data sampled coarsely do as much."""

LAST_ROW: Final = 1e-9
"""Steps by which the last row may lie beyond the end of a sweep, part of format 1: the quotient of
written numbers is wrong by 1e-16 times the number of rows, of which there are at most 1e7."""

EQUAL_STEPS: Final = 1e-9
"""Parts of a step by which rows of a cycle may be unequal, and of a turn by which it may be open:
rows by from and step differ by rounding, 1e-15 of their values."""

TABLE_END: Final = 1e-9
"""Parts of a table's range by which a row may lie beyond its ends and still take the end's value:
coordinates at an end are computed to 1e-12, and written numbers have nine digits and more."""

# --- drawing -------------------------------------------------------------------------------------

AXES_SQUARE: Final = 1e-9
"""Inertia axes must be square to this (cosine): typed numbers have nine digits and more."""

UNPHYSICAL_INERTIA: Final = 1e-9
"""Parts of the largest eigenvalue by which a tensor may miss the triangle inequality of a real
body."""

PARALLEL: Final = 1e-9
"""Sine of the angle below which a reference direction is parallel to the axis it should stand
square to."""

LARGEST_FLANK: Final = 1.4
"""Angle (rad) of a thread's flank against the plane square to the axis, some 80 degrees: no thread
is nearly a cylinder, and the normal load goes with 1 / cos."""
