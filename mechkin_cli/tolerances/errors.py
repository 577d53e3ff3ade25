"""True errors, and the bound of a row's errors."""

from __future__ import annotations

from typing import Final

# --- true errors ---------------------------------------------------------------------------------

ZERO_BUT_FOR_ROUNDING: Final = 1e-8
"""A column whose numbers in double-double are all below this part of the largest of its cells is
zero: what doubles leave there is 1e-16 of what cancelled, what double-doubles leave 1e-32."""

# --- the bound of a row (analysis.sweep.error_bound) ---------------------------------------------

APART_BY_CLOSURE: Final = 2.0
"""Of an overconstrained loop that does not close exactly, positions at which its equations are no
larger than b together are within condition times b of each other, to first order; b is 1e-15, so
that twice as much holds all orders, the 1 % of the condition, and that sizes are told by a power of
two."""

# --- a response repeated (analysis.errors.marching) ----------------------------------------------

REPEATED_STEP: Final = 1e-22
"""Last Legendre coefficients of a step of a response that is repeated in double-double, in parts of
the way and the rates so far. What such a step leaves is smaller by orders, as the coefficients
behind are (1e-30 of a pendulum), so that also errors that grow by 1e6 stay far below those of
doubles; how large they are is measured by repeating twice."""

ROUGHLY_REPEATED_STEP: Final = 1e-19
"""The same of the second repetition, from which the first one's own error is told: what both differ
by is the error of this one, which is larger."""

SWEPT: Final = 1e-2
"""What the last sweep of such a step may change, in parts of its tolerance: less than what is left
out after the last coefficient."""

MOST_SWEEPS: Final = 60
"""Sweeps of such a step: where a step bears its polynomial, a sweep takes away at least a digit."""

FIRST_REPEATED_STEP: Final = 1.0 / 64.0
"""Length of its first step in parts of the duration; it is cut until it is short enough."""

MOST_REPEATED_STEPS: Final = 2000
"""Steps that are tried, some 10 ms each: motions that need more are longer or stiffer than those
that a table is checked by."""

# --- what a repetition is known to (tables.cell_errors) ------------------------------------------

DOUBTFUL: Final = 0.01
"""What a repeated value may be off by in parts of the error that it tells: errors are read to one
or two digits."""

NO_DOUBT: Final = 1e-18
"""The same in parts of the column's largest: a hundredth of what the nearest double is off by."""

WIDE_ROUNDING: Final = float.fromhex("0x1p-98")
"""What an operation in double-double may be off by in parts of its value: sums, products and roots
2^-103, quotients 2^-102, elementary functions 2^-99."""

WIDE_UNDERFLOW: Final = float.fromhex("0x1p-1068")
"""What a product, quotient or function in double-double may be off by however small it is: a few of
the smallest numbers, 2^-1074, to which its parts are rounded."""


# Proofs of rows, and of the ways between them.

# --- inputs and enclosures -----------------------------------------------------------------------

INPUT_ROUNDING: Final = 2.0**-50
"""Inputs are at most this part of the rows' largest value off what the file says, in the kernel's
units: a multiple of a step, a unit and a whole number of turns taken off are less than eight
roundings."""

ENCLOSURE_ROUNDING: Final = 2.0**-50
"""Part of a quantity, its whole turns and its radius that is added to the radius, and of a
coordinate that is added to its error bound: all are converted to the file's units, by six roundings
at most."""

SAME_BOX: Final = 2.0**-44
"""Distance (rad, length units, parts of either) added to the radii of two boxes before they are
told apart: what is compared is rounded some twenty times."""

# --- ways between rows ---------------------------------------------------------------------------

STRAIGHT_WAY: Final = 1e-9
"""Change of the direction of the inputs' way (unit vectors of rad and lengths) at a row from which
on no tube goes through: what remains is rounding of the inputs, and added to the tubes' inputs."""

BRIDGE_NODES: Final = 120
"""Places between two rows at which a mechanism is closed to join them by tubes: towards a dead
centre four or five a decade are needed, and there are eight decades above rounding."""

BRIDGE_PART: Final = 0.5
"""How far an input goes (rad, length units) between places of a way that is proven, at first: about
what one tube holds, so that few are cut again."""

BRIDGE_PARTS: Final = 2000
"""Most such parts of a way between two rows: 160 turns, a second of work; who wants more proven can
ask for rows between."""

BRIDGE_STEP: Final = 1e-13
"""Distance of inputs (rad, length units) below which places are not told apart: they are rounded to
1e-16."""

# --- dead centres --------------------------------------------------------------------------------

DEAD_CENTRE_INTERVALS: Final = (4.0, 32.0, 256.0)
"""Half the interval of a joint coordinate in which one dead centre is to be proven, in parts of how
far from its middle the dead centre may lie: the first does unless the input bends over so small an
interval."""

DEAD_CENTRE_LEAST: Final = 1e-15
"""Step (rad, length units) of a joint coordinate that moves no dead centre: a few roundings."""

DEAD_CENTRE_MISS: Final = 1e-3
"""Longest step (rad, length units) from where following locates a dead centre: it does so to
rounding, so that a longer one leads to another place."""

DEAD_CENTRE_NEAR: Final = 1e-6
"""Distance of the input (rad, length units) before a dead centre at which the unknowns are near
enough to those at it for Newton's method: they are off by its root."""

DEAD_CENTRE_APPROACH: Final = (0.25, 0.06, 0.015, 0.004, 0.001)
"""Distances of a joint coordinate (rad, length units) from a dead centre at which it takes over
from the input as the parameter of tubes: as far as one holds, and nearer where that does not do."""


# Sensitivities to parameters: differences in double-double.

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
