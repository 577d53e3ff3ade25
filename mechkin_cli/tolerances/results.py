"""What is told of a row: verdicts, reactions, derived quantities, balances, the dense system."""

from __future__ import annotations

from typing import Final

# --- condition -----------------------------------------------------------------------------------

CONDITION_NEAR_SINGULAR: Final = 1e7
"""1 / smallest singular value of the scaled block: above it a row keeps fewer than nine digits."""

CONDITION_DIGITS: Final = 0.01
"""Parts by which a row's condition may be wrong: it comes from a fixed number of inverse
iterations."""

CONDITION_RANK_UNCLEAR: Final = 1e12
"""Above it rates and reactions of a row have no digit that means anything; its position still
has."""

CONDITION_SIDE_UNCLEAR: Final = 5e6
"""Above it a row may lie across its fold, which is 1 / condition away: a row whose loops close to
`RESIDUAL_ACCEPT`, 1e-14, is known to the root of that, 1e-7."""

CONDITION_RATES_UNCLEAR: Final = 1e6
"""Above it a row's rates may be rounding: condition times distance from a dead centre may be as
little as 0.2, and rows that stand at one close up to 1e-7 beside it."""

DEAD_CENTRE_LOST: Final = 0.1
"""Part of a rate by which it is wrong, as double-double tells, from which on a row stands at a dead
centre as nearly as a double can say: no digit is left. At a dead centre itself the part is 1."""

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

DENSE_ROWS: Final = 10
"""Rows within one step of a response from which on they are interpolated instead of stepped to:
interpolation costs 18 to 50 times in energy, so it is for rows that are much denser than steps."""

SAME_MOMENT: Final = 1e-15
"""A stop so near to the last row, in parts of its moment, ends the response at that row: a few
roundings of the time, which would print as two rows of one moment."""

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

MANY_KINKS: Final = 0.2
"""Parts of all steps that end at one kink from which on a response is said to run out of steps by
it."""
