"""Sensitivities to parameters: differences in double-double."""

from __future__ import annotations

from typing import Final

SHIFT: Final = float.fromhex("0x1p-40")
"""Shift of a parameter, 9e-13 of its scale: of a length the size of the mechanism, of an angle one
radian, of anything else its own value, and one of the file's units where that is zero. So a
parameter that is zero has a step, too. The central difference leaves out (shift / distance)^2 / 6
of the slope, 1e-13 even at 1e-6 of the scale before a dead centre; rounding of double-double, 1e-31
times the condition, becomes 1e-19 of it in the slope, and 1e-7 in the curvature, of which two
digits count."""

SHIFT_OF_RESPONSE: Final = float.fromhex("0x1p-27")
"""The same of a response, 7e-9: its repetition is known to about 1e-22, which becomes 1e-14; left
out is 1e-17."""

BENT: Final = 1e-6
"""Slopes to both sides of a row that differ by more than this part of the largest of the column
belong to a kink, to a jump, or to a dead centre within 1e-6 of the parameter's scale: the slope
would be off by the square of it or more."""

BENT_ROUNDING: Final = 1e-22
"""What second differences have of the largest number of their column by rounding, at conditions up
to 1e4 and their squares."""

ZERO_ROUNDING: Final = 1e-14
"""The same of a column that is zero but for rounding, in parts of what doubles leave there: the
ratio of both roundings is 1e-16."""

LEAP: Final = 1e-4
"""A change by more than this part of the column's largest within a shift may be a jump, and is
looked at with a shift that is a quarter of it."""

LEAP_AGREES: Final = 1e-6
"""Slopes of both shifts agree to this part of the largest where nothing jumps."""

CLOSURE_LOST: Final = 1e-6
"""A residual that grows by more than this part of the shift: with another parameter the loop, whose
constraints are redundant, does not close. Where it does, the residual stays at the rounding of
double-double, 1e-31, and grows by nothing."""

SHORT_REACH: Final = 0.005
"""Of a parameter's scale: where a slope that is not small holds for less than this, a listing says
so: at rows that lie up to a fortieth of it before a dead centre. No tolerance of a mechanism is as
large as a two-hundredth of its size."""

LINEAR: Final = 0.1
"""A second-order term beyond this part of the first-order one makes a slope misleading."""
