"""What rows say, and how exactly: conditions, reactions, quantities derived from rows, responses;
true errors, enclosures and shifts.
"""

from __future__ import annotations

from typing import Final

# --- condition -----------------------------------------------------------------------------------

CONDITION_NEAR_SINGULAR: Final = 1e7
"""1 / smallest singular value of the scaled block: above it a row keeps fewer than nine digits."""

CONDITION_DIGITS: Final = 0.01
"""Parts by which a row's condition may be wrong: it comes from powers of a
matrix."""

CONDITION_RANK_UNCLEAR: Final = 1e12
"""Above it rates and reactions of a row have no digit that means anything; its position still
has."""

CONDITION_SIDE_UNCLEAR: Final = 5e6
"""Above it a row may lie across its fold, which is 1 / condition away: a row whose loops close to
`RESIDUAL_ACCEPT`, 1e-14, is known to the root of that, 1e-7."""

CONDITION_RATES_UNCLEAR: Final = 1e6
"""Above it a row's rates may be rounding: condition times distance from a dead centre may be as
little as 0.2, and rows that stand at one close up to 1e-7 beside it."""

CONDITION_FEW_DIGITS: Final = 1e5
"""Above it a row's rates, accelerations or forces may keep fewer than `FEW_DIGITS`: rounding goes
with its square, and a difference of two accelerations may lose more. How many they have is then
measured in double-double."""

FEW_DIGITS: Final = 6
"""Digits of rates, accelerations and forces, in parts of the largest of their kind in the row,
below which a message tells them."""

DIGITS_OF_PLACES: Final = 9
"""The same of positions, in rad and parts of the size."""

DEAD_CENTRE_LOST: Final = 0.1
"""Part of a rate by which it is wrong, as double-double tells, from which on a row stands at a dead
centre as nearly as a double can say: no digit is left. At a dead centre itself the part is 1."""

PART_ROWS: Final = 1 << 15
"""Rows of a part of a long run: its states, inputs and a few columns take thirty megabytes, of
which two parts are held while one is written, and what is done once for each part is small beside
its rows."""

FREED_MEGABYTES: Final = 16
"""Freed memory that a process keeps for the next part: more than the arrays of one, so that no page
is asked for again. Of peaks of 10^7 rows pages took a tenth of the time."""

WHOLE_PARTS: Final = 2
"""Parts of which a run is long: rows of a shorter one have the same bits turn after turn, which
those of different parts need not have."""

PART_NUMBERS: Final = 1 << 21
"""Numbers of states and turns of all rows of a part: 16 MB."""

LEAST_PART_ROWS: Final = 64
"""Rows of a part of the largest mechanisms: of fewer the steps between them would be cut short."""

BORDER_CONDITION: Final = 10.0
"""Condition of the row at which a part ends, in parts of the least of its second half: within it
lies what conditions vary over a motion, and next to a dead centre they grow without bound."""

BEFORE_DEAD_CENTRE: Final = (1e-4, 1e-6)
"""Distances of two places before a dead centre (rad, sizes): what grows as the root of the inverse
does so tenfold between them, and both are far above rounding."""

TURNED_BACK: Final = 1e-12
"""Distance beyond a dead centre (rad, sizes; parts of inputs larger than 1) that is rounding: rows
as far beyond it turn back at it."""

BESIDE_CORRECTION: Final = 1e-7
"""Correction of a row next to a dead centre: the root of a rounding, by which its place is off."""

OFF_FOLD: Final = 0.5
"""Part of the distance from a fold by which its parabola may miss a branch: it misses by the square
of the distance, a hundredth, in parts of the size."""

ON_FOLD: Final = 1e-4
"""Part of the distance of two branches at `BEFORE_DEAD_CENTRE`, some 1e-2, up to which a row is on
neither of them clearly: rounding leaves 1e-8 to 1e-7 there."""

GROWS_WITHOUT_BOUND: Final = 5.0
"""Growth between these two places from which on a quantity has no bound: half of the root's. What
has a bound changes by a hundredth of itself."""

KNOWN_AT_DEAD_CENTRE: Final = 1e-6
"""Up to this part of its largest, or of one, a position may be zero in a row at a dead centre,
where it is known to the root of rounding, 1e-8 to 1e-7."""

RESTS: Final = 1e-9
"""Part of an input's largest rate over the rows up to which it rests in a row: laws come to rest by
sums and sines of doubles, to 1e-15 of it."""

# --- reactions and actuators ---------------------------------------------------------------------

REACTION_ROUNDING: Final = 1e-12
"""Rounding of reactions in parts of the largest in the mechanism, in whatever joint it is met: a
cell that moves no more than with this keeps its value. Measured: 1e-15 to 1e-13; what depends on
the null space moves by about the largest reaction itself."""

UNIQUE_CELL: Final = 1e-9
"""Change of a cell, in parts of its column's largest value, when a part of the null space is added
to the reactions: above it the cell is not unique. Rounding leaves 1e-13, a cell that moves moves by
about its own size."""

ACTUATORS_AT_REST: Final = 1e-10
"""Rate of the actuators, all together, in parts of the motion (rad, sizes), below which some motion
leaves them at rest: rounding leaves 1e-16 by the condition of the loops, a position written with
ten digits 1e-10. The kernel has the same (actuation.hpp)."""

# --- derived quantities --------------------------------------------------------------------------

POSE_LOCKED: Final = 1e-6
"""Cosine of the middle turn of a pose below which the other two go about one axis."""

HALF_TURN: Final = 1e-14
"""Scalar part of a unit quaternion up to which a turn counts as half a turn, where either sense of
its axis is right and one must be chosen: forty roundings, an angle of 2e-14 rad."""

NO_TURN: Final = 1e-12
"""Vector part of a unit quaternion up to which a link counts as not turned, and distance (length
units) up to which it counts as not moved: rounding leaves 1e-16 times the condition of the row."""

STANDS_STILL: Final = 1e-12
"""Rate (rad and length units) in parts of the inputs' rates up to which something counts as
standing still: rounding leaves 1e-16 times the condition of the row. Measured on a coupler that
only shifts: 5e-17."""

# --- powers and balances -------------------------------------------------------------------------

POWER_INTEGRAL: Final = 1e-13
"""Error of the integral of a power between two rows, in parts of the largest power by their
distance: a few hundred roundings of a power, the difference of efforts with friction and without.
"""

MOST_PIECES: Final = 16
"""Pieces of an interval, of all of them on average, that may still be open: at a jump one of each
two halves is, so that sixteen are eight jumps. Where a power has no digits, as beside a branch
point, no piece ever gets as good as is allowed, and twice as many are open with each halving."""

LEAST_PIECES: Final = 256
"""Pieces that may be open however few intervals there are: of one interval a hundred jumps."""

NEXT_TO_END: Final = 1.0 - 1e-4
"""Where the ends of a piece of an integral are sampled, in parts of its half: off the end, since a
zero that parts pieces, and what is next to it, is known to rounding only."""

NEXT_TO_ZERO: Final = 1e-13
"""Distance of a zero from the end of a piece, in parts of all pieces, below which it is the end."""

TURNS_NOT: Final = 1e-12
"""Size of a rate in parts of its largest below which its sign is rounding."""

REPEATS: Final = 1e-9
"""Parts of its largest value by which what repeats may differ between the first row of a cycle and
the last: rounding leaves 1e-12, what is open is open by far more."""

# --- the dense system ----------------------------------------------------------------------------

ZERO_CELL: Final = 2.0**-46
"""A number that is rounding of zero, in parts of the largest of its unit in the table, the size of
the mechanism or 1 rad: tables for people show 0, where decimals are not declared. Measured on the
kept files: 1e-17 to 4e-15; this is 64 roundings."""

DENSE_ROUNDING: Final = 1e-13
"""Size of an unknown of the dense system, in parts of the largest of its kind, up to which it is
rounding of the elimination and told as zero: fifty equations leave 1e-15 to 1e-14."""

DENSE_PIVOT: Final = 1e-12
"""Pivot of the dense system (equations scaled to a largest coefficient of 1) below which reactions
are not told apart: rounding of fifty equations leaves 1e-14, mechanisms that stand apart 1e-3."""


# Responses: their steps, moments and ends.

RESPONSE_TOLERANCE: Final = 1e-10
"""Relative error of a step of a response where its file says none: seconds of motion then keep nine
digits, at twice the work of 1e-7."""

RESPONSE_TOLERANCES: Final = (1e-14, 1e-2)
"""Least and largest tolerance of a response: below, rounding of the accelerations decides; above,
error estimates mean nothing."""

MOST_RESPONSE_STEPS: Final = 1_000_000
"""Attempted steps of one response: minutes of work for one mechanism, and far more than any of the
kept ones needs (8 to 600)."""

FIRST_PART: Final = 1e-6
"""Part of a motion behind which its first row is handed on, where that alone is wanted: a row is
when the next one is reached."""

MOST_IMPACTS: Final = 10_000
"""Impacts of one response: a ball that keeps 0.99 of its speed rests after 1100."""

DENSE_ROWS: Final = 10
"""Rows within one step of a response from which on they are interpolated instead of stepped to:
interpolation costs 18 to 50 times in energy, so it is for rows that are much denser than steps."""

SAME_MOMENT: Final = 1e-15
"""A stop so near to the last row, in parts of its moment, ends the response at that row: a few
roundings of the time, which would print as two rows of one moment."""

IMPACT_PLACE: Final = 1e-12
"""rad, or parts of the size, that coordinates move by from an impact to a row which counts as at
its moment: where an impact is found is uncertain by 5e-14, and no step resolves less."""

ENERGY_ROUNDING: Final = 2.0**-48
"""Parts of the largest potential energy below which nothing is missing of a response's energies: 16
roundings, as heights are sums of some. A pendulum that swings by 1e-6 deg moves 1e-16 of it."""

# --- why one ends early --------------------------------------------------------------------------

RUNAWAY: Final = 1e6
"""Accelerations in parts of the rates over the duration from which on rates run away: steps that
the tolerance refuses end at 1e8 to 1e12 of them."""

LOST_INERTIA: Final = 1e-3
"""Parts of the least inertia at the start below which rates that run away do so for want of it; it
is 1e-8 to 1e-10 where such steps end."""

KINK_ROUNDING: Final = 1e-12
"""What a load takes the sign of, in SI, is rounding if it never was above: loops are closed to
1e-14 of the size."""

ONE_FREEDOM: Final = 1e-9
"""What others leave of how a limit's push moves its coordinate, in parts of it, up to which it ends
a freedom that they end: inertias and rates are right to about 1e-13 of the largest."""

MANY_KINKS: Final = 0.2
"""Parts of all steps that end at one kink from which on a response is said to run out of steps by
it."""

# --- true errors ---------------------------------------------------------------------------------

ZERO_BUT_FOR_ROUNDING: Final = 1e-8
"""A column whose numbers in double-double are all below this part of the largest of its cells is
zero: what doubles leave there is 1e-16 of what cancelled, what double-doubles leave 1e-32."""

ZERO_WHERE_DOUBLES_ARE: Final = 1e-24
"""A column whose doubles are exactly zero in all rows is zero where its numbers in double-double
(SI) are all below this: what cancelled was below 1e8, of which double-doubles leave 1e-32."""

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

LEAST_INPUT_ROUNDING: Final = 2.0**-190
"""The same of an input that is zero in all rows, rad or the kernel's length: enclosures of products
hold 2^-200 for what underflows."""

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
"""A second-order term beyond this part of the first-order one makes an estimate by slopes alone
inaccurate."""

TOLD_APART: Final = 1e-5
"""Angles of assemblies (rad), slides and places of joints (parts of the mechanism's size) that are
nearer than this look alike in a list of six digits."""

CAM_CLOSED: Final = 1e-9
"""Both ends of a cam's profile that are nearer than this part of its size are one point: rounding
leaves 1e-15, a follower that does not come back a thousandth."""

CAM_SAME: Final = 1e-12
"""Extremes of a cam that differ by less than this part are one value that is taken several times,
as on a rise and its return; the first is told."""
