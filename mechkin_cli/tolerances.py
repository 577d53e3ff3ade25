"""Every threshold of mechkin: name, unit, scale rule and reason.

Lengths are scaled by the mechanism's size (diagonal of the box of the joint points at the first
row) before they meet a limit, so the numbers below are pure or radians.

The kernel is given its limits from here. What it keeps itself belongs to one algorithm each and
stands beside it with its reason (`kernel/src/`):

* `condition.hpp`: the condition up to which the estimate stands, 1e6, and how far its factors may
  be off, 5e-4; beyond, the condition is computed to rounding;
* `linear.hpp`: cosines of Jacobi rotations, 1e-15 and 1e-8, and at most 30 sweeps;
* `judge.cpp`, `arc.cpp`, `passage.cpp`, `stretch.cpp`, `branch_point.cpp`, `tracker.cpp`: what a
  walk by arclength takes for a fold, a narrow place or a branch point, and what rounding leaves;
* `search.hpp`: damping of Levenberg-Marquardt steps;
* `position.hpp`: a Newton step beyond 1e100 is none;
* `row_curve.cpp`: rows from which a curve's derivatives are read, in parts of step and `PATH_KNOT`;
* `orbit.hpp`: states within 1e-12 of the start's are back, sought for 16 turns: rounding leaves
  1e-16 times the condition, and no linkage is known that takes more turns; `tracker.hpp`: 2e7
  steps of one path;
* `tracker.cpp`, `dimension_path.cpp`: a rest of 1e-6 of a step is taken along, steps grow fourfold
  at most;
* `legs.hpp`: `OPPOSITE_COSINE` again;
* `closing_equations.hpp`, `tree_joints.hpp`: 1e-150, just above the root of the least normal
  double; `arithmetic/`: where one formula takes over from another.
"""

from __future__ import annotations

from typing import Final

# --- closure: residual = largest closing equation, lengths / size, angles in rad -----------------

RESIDUAL_TIGHT: Final = 1e-16
"""A Newton iteration ends here at once: half a rounding of 1. Measured floor on RCSR: 1e-16 ...
3e-16."""

STEP_COARSE: Final = 1e-8
"""A Newton step shorter than this (rad, length units) is the last: it leaves an error of about half
its square times condition and curvature, below the rounding that the condition magnifies."""

RESIDUAL_ACCEPT: Final = 1e-14
"""Largest residual of a row that counts as assembled: about 50 roundings, what long chains need.
Lengths of a loop that reaches farther than the size count in parts of its reach."""

NEWTON_ITERATIONS: Final = 6
"""A prediction that passes the jump test is within a tenth of a step; squared four times that is
rounding, and a sixth step allows for a large constant. More would mean that the guess was wrong."""

PRECISE_RESIDUAL_TIGHT: Final = 2e-32
"""`RESIDUAL_TIGHT` of runs in double-double: a rounding and a half of 1."""

PRECISE_STEP_COARSE: Final = 1e-16
"""`STEP_COARSE` of runs in double-double."""

PRECISE_RESIDUAL_ACCEPT: Final = 1e-30
"""`RESIDUAL_ACCEPT` of runs in double-double: about 80 roundings."""

# --- search for assemblies -------------------------------------------------------------------

SEARCH_RESIDUAL: Final = 1e-10
"""Where the Levenberg-Marquardt search hands over to Newton; well inside its quadratic region."""

SEARCH_ITERATIONS: Final = 80
"""Steps of one start. Measured with 2048 starts on RCSR, RCSR-CSR, 7R, RCHCH, RCRCR, PHCHC and
R-Sg-C: of those that close within 160 steps at least 96 % do so within 30, 99.8 % within 80."""

SEARCH_STARTS: Final = 512
"""Random starts of one round: fewer do not fill the packs, more are not needed by most loops."""

SEARCH_LEAST_STARTS: Final = 32
"""Starts for each of the assemblies of the blocks before, where those are many; two packs a
thread."""

SEARCH_MOST_COLUMNS: Final = 65_536
"""Starts in one call of the kernel; bounds the memory."""

SEARCH_HOPELESS_STARTS: Final = 2048
"""A block of which not one of so many starts closed counts as not to be assembled there. Of the
general loops measured at least 1 % of the starts close, so that all miss with chance 1e-9."""

SEARCH_HOPELESS_WORK: Final = 1e9
"""Multiplications, in the steps of the starts, after which a block without one closing is given up,
though not before `SEARCH_LEAST_HOPELESS_STARTS` or after `SEARCH_HOPELESS_STARTS`; half a
second."""

SEARCH_LEAST_HOPELESS_STARTS: Final = 128
"""Enough to find out about any block of which some percent of the starts close."""

SEARCH_MOST_ROUND: Final = 8192
"""Most starts of a round; rounds grow with what has been tried."""

SEARCH_MOST_WORK: Final = 2e10
"""Multiplications, in the steps of the starts, after which a search for all modes gives up; some
seconds. At least `SEARCH_MOST_QUICK_STARTS` are made."""

SEARCH_MOST_STARTS: Final = 262_144
"""A search for all modes that could still miss many says so here instead of going on."""

SEARCH_MOST_QUICK_STARTS: Final = 16_384
"""The same for a search that is for one assembly."""

SEARCH_REACHED_BOUND: Final = 8
"""Proven bounds up to this are reached by everyday loops; 16 of a general one and 40 of a platform
only by dimensions that were looked for, so no short search is made to reach them."""

SEARCH_MOST_MODES: Final = 1024
"""More different end points than this are no list of modes but a motion that is left with the
inputs held; platforms have 40 modes."""

SEARCH_MOST_SINGULAR: Final = 8
"""More different near singular end points of a block (`CONDITION_NEAR_SINGULAR`) at one place are a
motion that dimensions only just stop. At a dead centre two assemblies merge, by symmetry some
pairs."""

SEARCH_MOST_PRODUCTS: Final = 16_384
"""Assemblies of the whole mechanism: blocks that are independent multiply theirs, fourteen loops of
two modes reach it."""

SEARCH_MOST_PLACES: Final = 2048
"""Assemblies of the blocks before at which a block is searched: two seconds."""

SEARCH_FEW_PLACES: Final = 64
"""Those that are gone on with where there are more, from there on."""

SEARCH_NEW_MODE_CHANCE: Final = 1e-3
"""Chance that one more start that closes finds a new mode, below which the search ends."""

SEARCH_NEW_MODE_CHANCE_OF_MANY: Final = 0.03
"""The same for a block that is searched at many places of the blocks before, at most; the chance
grows with their number so that the starts do not."""

SEARCH_DOUBT: Final = 0.01
"""Chance that the bound stated for that chance does not hold."""

ROOT_REGULAR: Final = 1e-3
"""A loop's equations are reduced to one polynomial by divisors above this; errors grow with the
square of its inverse."""

ROOT_STATE_ERROR: Final = 1e-9
"""Error of the states of blocks before, from the search, in a polynomial's coefficients: ten times
the residual at which the search hands over."""

ROOT_ROUNDING: Final = 1e-13
"""Error of a polynomial's coefficients from rounding."""

ROOT_LEAST_INTERVAL: Final = 1e-8
"""Half interval (rad) at which the count of roots is given up: a double root but for rounding."""

SAME_MODE: Final = 1e-7
"""Two assemblies whose poses differ less (lengths / size, direction cosines) are one. Newton
leaves 1e-12 even at condition 1e4; modes that merge at a dead centre are 1e-6 apart already 1e-12
from it."""

SEARCH_CONDITION: Final = 1e12
"""An end point of the search that is more singular is no isolated assembly."""

SEARCH_SLIDES: Final = 2.0
"""Bound of random slides in sizes of the home drawing: a chain of links reaches no farther."""

MODE_ORDER: Final = 1e-6
"""Coordinates (rad, parts of the size) that differ less are equal for the order of the modes'
letters, so that rounding cannot change it."""

SAME_FOLD: Final = 1e-3
"""Poses (parts of the size, direction cosines) that differ less stand on one fold: what is found
there is known to the root of a rounding, and steps from both sides end as near."""

NEAR_RUNNER_UP: Final = 1.2
"""Ratio of distances below which the nearest assembly is not clearly the one that was meant."""

NEAR_FAR: Final = 0.5
"""Distance (rad, parts of the size) of a named coordinate from the assembly taken above which the
name is said to be missed: half a radian is more than a reading of a drawing leaves open."""

NEAR_BALL: Final = 1.0
"""Radius (rad, parts of the size) of the ball about what `near` names up to which it is searched
alone: a larger one holds most of the space."""

HOME_ASSEMBLED: Final = 1e-9
"""Closing residual at which a drawing counts as assembled: written numbers with ten digits reach
it."""

# --- following a branch ------------------------------------------------------------------------

TURN_LIMIT_COSINE: Final = 0.9659258262890683
"""Cosine of 15 degrees: largest turn of the tangent in one step."""

TURN_WANTED: Final = 0.2
"""Turn of the tangent that a step aims at, rad; leaves room below the limit."""

BEND_WANTED: Final = 0.35
"""Quadratic against linear part of a step, times two. Near a dead centre at distance d the ratio
of the derivatives is 2 d, so steps shrink to 0.7 d and never cross it."""

JUMP_LIMIT: Final = 0.1
"""Largest Newton correction after a predicted step, in parts of the step's length: the other
branch is farther than twice the distance to the fold, a tenth of a step cannot reach it."""

INFILL_LIMIT: Final = 0.02
"""Largest correction of a row filled in between two nodes, in parts of the nodes' distance; an
eighth of their least singular value (a lower bound of it) limits it, too."""

LONGEST_STEP: Final = 0.5
"""Longest step along the path (rad, length units): 13 nodes a turn at least, so that no pair of
folds hides in one."""

LONGEST_DIMENSION_STEP: Final = 1.0
"""Longest step from the base variant (0) to another (1): variants are near each other as a rule,
and the tests of a step shorten it where they are not."""

LEAST_DIMENSION_STEP: Final = 1e-6
"""Step on the way from the base variant to another (0 to 1) below which a branch that goes no
farther is lost: a fold is met to this part of the way."""

LEAST_STEP: Final = 1e-15
"""Step (in parts of max(1, |path|)) below which a branch cannot be followed in double precision."""

NODE_PIVOT: Final = 1e-8
"""Least pivot and singular value of the equations at a node of a path: the root of a rounding,
which is as near as numbers of double precision come to a singular place on a branch. Measured: two
narrow places within one block, each with a pivot of 2e-6 and 1e-11 together, shake the states by
1e-5; steps of that length went over a fold."""

ARC_PIVOT: Final = 1e-7
"""The same of the bordered matrix that follows a branch by arclength: its derivatives are wrong by
a rounding over its square, a hundredth. Two branches at a gap of 1e-12 leave 1e-6; where one narrow
place follows another the pivot is their product, and what a rounding does to the matrix is
measured."""

SPECTRAL_RADIUS: Final = 0.5
"""Largest spectral radius of J_a^+ J_b - I for the Jacobians of a step from a to b, and to its
middle: below 1 no matrix of the straight segment between them is singular. Half of it leaves room
for what the segment does not see of the path. Measured: no jump in 1650 mechanisms near change
points, where signs of determinants jumped in 878 of 999, at the same number of steps on others."""

NARROW_STEP: Final = 0.02
"""A step (rad, length units of the inputs) that is refused and would come below this is looked into
by arclength: sweeps far from dead centres and branch points take steps of a tenth and more."""

ARC_STEPS: Final = 4000
"""Steps of one look by arclength. A gap of 1e-12 between two branches takes some two hundred."""

SAME_LINE: Final = 1e-12
"""Distance from a straight line, in parts of the inputs, up to which rows count as one run of the
path: written numbers round at 1e-16 of their size."""

PATH_KNOT: Final = 0.01
"""Distance (rad, length units) of the rows from which a curved path's derivatives are read:
rounding of written numbers over its square stays below 1e-8, and a third derivative of 1 shifts
them by 1e-5. A straight run of more than two rows counts as one from this length on."""

PATH_CORNER_COSINE: Final = 0.9887710779360422
"""Cosine of 8.6 degrees: a path that turns more from row to row has a corner there, or its rows are
too far apart to tell its curve."""

COURSE_SAMPLES: Final = 513
"""Least number of places at which a course of inputs is looked at for kinks and turning points: a
dozen for each period of a law that swings forty times."""

MOST_COURSE_SAMPLES: Final = 20001
"""Most of them, where there are many rows: 20 ms of work."""

MOST_COURSE_CELLS: Final = 10_000
"""Kinks of a course that are told apart."""

COURSE_SAME: Final = 1e-12
"""Parts of a course's range within which two places are one: bisection ends at roundings."""

COURSE_JUMP: Final = 1e-9
"""Change of an input (rad or m, with its size) at a place above which it jumps there: what is
continuous differs by roundings."""

MOST_COURSE_ORDER: Final = 8
"""Order in which inputs leave a rest: the change over a hundredth of a cell and half of it tells
orders up to it from rounding."""

COURSE_SLOW: Final = 0.5
"""The same between two samples, above which no zero lies between them: samples are dense against
the swing of a law."""

COURSE_REST: Final = 1e-6
"""Rate, in parts of each input's fastest, up to which all of them rest: a zero of the rates is
found to the root of a rounding where they only touch it."""

FREE_INPUT_STEP: Final = 3e-4
"""Step of an input (rad, length units) after which the loops must still close where it is free: a
prediction of second order misses by its cube, 3e-11, times third derivatives."""

FREE_INPUT_MISS: Final = 3e-9
"""Closing equation after that step above which an input may be locked, and the mobility is asked: a
locked one misses by a part of the step or of its square, 9e-8."""

PATH_STRAY: Final = 1e-3
"""Distance of a row's inputs from the curve between two nodes in parts of the step: a twentieth of
what a row filled in may be off."""

HALF_TURN_SIDE: Final = 1e-9
"""Angles (rad) of the first row that are so near to half a turn are +180 degrees: on which side
they lie is rounding of the drawing, of nine digits and more."""

CLOSING_ANGLE_STEP: Final = 1e-6
"""A step (rad, length units) that is longer is halved where the angle of a closing joint is not
where its rate, integrated, takes it. Shorter ones are taken: an angle may jump by half a turn where
the two axes of a joint come into line, though the branch is regular there."""

CLOSING_ANGLE_MISS: Final = 0.25
"""Difference (rad) of a closing joint's angle from the integral of its rate over a step above which
its whole turns are not sure: a turn is 25 times as much."""

CLOSING_ANGLE_BEND: Final = 0.5
"""Part (rad) that the rate's derivatives have in its integral over a step up to which the integral
is taken as it is, and the difference up to which both halves of the step agree with it: the
integral's error is a small part of either."""

PLAN_STEP: Final = 1e-3
"""Part of a path of changing dimensions over which its derivatives are read: differences are wrong
by its square, 1e-6, and rounding leaves 1e-10 in the second ones; both matter to predictions
only."""

MOST_STEPS: Final = 20000
"""Attempts that may take a path a longest step further; it may be as long as it likes. Measured:
R-Sg-C takes 32 steps for 315 degrees, and halvings down to `LEAST_STEP` are 50."""

# --- dead centres ------------------------------------------------------------------------------

DEAD_CENTRE_STEP: Final = 1e-12
"""Newton on d(input)/d(coordinate) = 0 ends when the coordinate moves less (rad or parts of the
size)."""

DEAD_CENTRE_ITERATIONS: Final = 40
"""Far more than quadratic convergence needs; a search that uses them all has found none."""

SAME_DEAD_CENTRE: Final = 1e-5
"""Two dead centres whose poses differ less are one: the states there are known to about 1e-8, the
root of a rounding."""

# --- circuits ----------------------------------------------------------------------------------

SAME_TURN: Final = 1e-12
"""Turns by which two rows' inputs may differ from a whole number of them and still stand for the
same place: written numbers round at 1e-16 of their size."""

MOST_BRANCHES: Final = 64
"""Branches of one circuit that are walked through."""

MOST_TURNS: Final = 16
"""Whole turns of an input after which an assembly that never came again counts as far."""

PASSED: Final = 1e-6
"""Distance (rad, length units, turns) beyond which a place still lies ahead on the way."""

FAR_INPUT: Final = 20.0
"""How far a slide (length units) or a thread (rad) is driven in search of a dead centre."""

RUNAWAY_SLIDE: Final = 20.0
"""Length of a slide (length units, about sizes) from which a lost branch is said to go out of
bounds; a search takes starts up to two sizes. Measured on RCCC: lost at 206."""

# --- verdicts -------------------------------------------------------------------------------

CONDITION_NEAR_SINGULAR: Final = 1e7
"""1 / smallest singular value of the scaled block: above it a row keeps fewer than nine digits."""

CONDITION_DIGITS: Final = 0.01
"""Parts by which a row's condition may be wrong: it comes from a fixed number of inverse
iterations."""

CONDITION_RANK_UNCLEAR: Final = 1e12
"""Above it rates and reactions of a row have no digit that means anything; its position still
has."""

POSE_LOCKED: Final = 1e-6
"""Cosine of the middle turn of a pose below which the other two go about one axis."""

ACTUATORS_AT_REST: Final = 1e-10
"""Rate of the actuators, all together, in parts of the motion (rad, sizes), below which some motion
leaves them at rest: rounding leaves 1e-16 by the condition of the loops, a position written with
ten digits 1e-10. The kernel has the same (actuation.hpp)."""

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

REACTION_ROUNDING: Final = 1e-12
"""Rounding of reactions in parts of the largest in the mechanism, in whatever joint it is met: a
cell that moves no more than with this keeps its value. Measured: 1e-15 to 1e-13; what depends on
the null space moves by about the largest reaction itself."""

UNIQUE_CELL: Final = 1e-9
"""Change of a cell, in parts of its column's largest value, when a part of the null space is added
to the reactions: above it the cell is not unique. Rounding leaves 1e-13, a cell that moves moves by
about its own size."""

AXES_SQUARE: Final = 1e-9
"""Inertia axes must be square to this (cosine): typed numbers have nine digits and more."""

ON_LINE: Final = 2e-8
"""Parts of a leg's length (of the largest entry of a tensor) up to which a mass centre lies on the
line of its spheres (a tensor is symmetric about it): nine written digits are half a unit of the
last off, 5e-9, and up to four such numbers tell a place and the line."""

LEG_SLIDE: Final = 1e-7
"""Sine of the angle between a leg's slide and the line of its spheres up to which it is a leg: the
distance of the spheres then is off by its square, 1e-14, and nine written digits stay below."""

COMMON_MOTION: Final = 1e-7
"""Pivot (rad, parts of the size) up to which two joints of a link have a motion in common: a line
that is off by this, as numbers of nine digits may leave it, is off the motion held in its place by
no more than was written."""

SAME_COMMON_MOTION: Final = 1e-6
"""Difference of a common motion at two general places (rad, parts of the size) up to which a link
carries its line along: ten times what `COMMON_MOTION` lets pass; others differ by their own
size."""

HELD_RATE: Final = 1e-3
"""Least rate of a coordinate in an idle motion, in parts of its fastest, to be held in its place:
one that hardly moves would not hold it."""

HELD_WELL: Final = 0.1
"""The same, for a turn of a ball some turns of which are held already: three turns of one ball are
never singular together, and turns of two balls may be."""

HELD_ACROSS: Final = 0.5
"""Cosine of the angle between the line of a held turn and the first axis of its ball up to which
the axis is taken: the three turns are singular where line and axis meet, so they start 60 deg or
more away."""

LOOP_RANK: Final = 1e-6
"""Pivot of a loop's screws (moments in sizes) below which they are dependent as drawn: written
numbers leave 1e-9, and loops that close only by their dimensions are drawn more exactly still."""

LARGEST_FLANK: Final = 1.4
"""Angle (rad) of a thread's flank against the plane square to the axis, some 80 degrees: no thread
is nearly a cylinder, and the normal load goes with 1 / cos."""

PARALLEL: Final = 1e-9
"""Sine of the angle below which a reference direction is parallel to the axis it should stand
square to."""

UNPHYSICAL_INERTIA: Final = 1e-9
"""Parts of the largest eigenvalue by which a tensor may miss the triangle inequality of a real
body."""

TABLE_END: Final = 1e-9
"""Parts of a table's range by which a row may lie beyond its ends and still take the end's value:
coordinates at an end are computed to 1e-12, and written numbers have nine digits and more."""

# --- derived quantities ------------------------------------------------------------------------

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

# --- numbers of the file ------------------------------------------------------------------------

EQUAL_STEPS: Final = 1e-9
"""Parts of a step by which rows of a cycle may be unequal, and of a turn by which it may be open:
rows by from and step differ by rounding, 1e-15 of their values."""

REPEATS: Final = 1e-9
"""Parts of its largest value by which what repeats may differ between the first row of a cycle and
the last: rounding leaves 1e-12, what is open is open by far more."""

LAST_ROW: Final = 1e-9
"""Steps by which the last row may lie beyond the end of a sweep, part of format 1: the quotient of
written numbers is wrong by 1e-16 times the number of rows, of which there are at most 1e7."""

INPUT_ROUNDING: Final = 2.0**-50
"""Inputs are at most this part of the rows' largest value off what the file says, in the kernel's
units: a multiple of a step, a unit and a whole number of turns taken off are less than eight
roundings."""

ENCLOSURE_ROUNDING: Final = 2.0**-50
"""Part of a quantity, its whole turns and its radius that is added to the radius: all are converted
to the file's units, by six roundings at most."""

SAME_BOX: Final = 2.0**-44
"""Distance (rad, length units, parts of either) added to the radii of two boxes before they are
told apart: what is compared is rounded some twenty times."""

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

FAR_DRAWING: Final = 4.0
"""Distance of the drawing from the ground origin, in sizes, beyond which the kernel works about its
own origin: nearer, the origin costs three bits at most."""

OPPOSITE_COSINE: Final = -1.0 + 1e-15
"""Cosine up to which two unit vectors are opposite, so that the shortest turn between them has no
axis of its own: nine roundings from -1. The kernel has the same number in `legs.hpp`."""

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

UNIT_SQUARE: Final = 4e-16
"""Distance of a vector's square from 1 up to which it counts as a unit vector and keeps its bits:
its three products and two sums round to no more."""

# --- mobility by rank (lengths in parts of the size) ------------------------------------------

RANK_GAP: Final = 1e3
"""Least ratio of neighbouring singular values at which a rank is accepted."""

RANK_ZERO: Final = 1e-8
"""Singular values below this part of the largest count as zero: what is redundant is 1e-15 in an
exact drawing, 1e-10 in one written with ten digits."""

RANK_ROUNDING: Final = 1e-14
"""Singular values below this part of the largest are rounding, and no measure of a gap."""

MOBILITY_CLOSED: Final = 1e-9
"""Largest equation of a configuration that counts as assembled: written numbers with ten digits
reach it."""

MOBILITY_TIGHT: Final = 1e-14
"""Newton ends here: some roundings of the equations."""

MOBILITY_NEAR: Final = 1e-12
"""Loops open by less are closed but for rounding: they are left where a step gains no tenth."""

MOBILITY_ITERATIONS: Final = 80
"""Newton halves the distance to a configuration that is singular; 80 halvings leave nothing."""

MOBILITY_DAMPING: Final = 1e-7
"""Least damping of a step, in parts of a unit rate: far below singular values that count, far above
those of redundant constraints in a drawing with ten digits. Measured at 1e-10: steps along these
led astray by a tenth of a move."""

MOBILITY_RANK: Final = 1e-11
"""Singular values below this part of the largest are left out of a Newton step: above rounding, far
below those of a regular configuration, so that the step stays bounded next to a singular one."""

MOBILITY_STRIDE: Final = 0.3
"""Longest Newton step (largest turn in rad or length in parts of the size), so that a poor start
does not leave the neighbourhood in which linear terms tell the way."""

MOBILITY_NO_TWIST: Final = 1e-9
"""Parts of a unit twist below which it does not turn, or does not advance: written numbers have
nine digits and more."""

MOBILITY_NO_WRENCH: Final = 1e-6
"""Parts of a unit stress or wrench that count as none: a null vector is known to rounding over the
gap of the singular values, at least 1e3 above 1e-10 for a drawing with ten digits."""

MOBILITY_STUCK: Final = 8
"""Steps without a tenth of progress after which Newton gives up."""

MOBILITY_STARTS: Final = 40
"""Random poses tried where the drawing itself leads to no assembly."""

MOBILITY_MOVES: Final = ((0.1, 1e-9), (0.025, 4e-12))
"""Moves from the first configuration by their largest step (rad, parts of the size), and how far
loops may be open after them: what touches in fourth order leaves 1e-4 and 4e-7 times its curvature,
which must not pass for a motion. The second is tried where the first is too long to tell."""

MOBILITY_FAR_MOVE: Final = (0.3, 1e-9)
"""The move that is tried where the first leaves loops all but closed: what touches in fourth order
is open by a hundred times more."""

MOBILITY_CHORDS: Final = (0.3, 0.1)
"""Chords that tell the dimension, in parts of the move that led there: 0.03 and 0.01 (rad, parts of
the size) leave curvature small and touching of high order visible."""

MOBILITY_CHORD_RANK: Final = (0.3, 0.7)
"""Singular values of chords along an orthonormal frame are 1 along the component and 0 across, but
for its curvature; between these two they tell nothing."""

MOBILITY_CHORD_DOUBT: Final = 1e-4
"""Rates read from chords below which a coordinate stands still: closing where equations are squared
is sure to the root of a rounding, 1e-7, over a chord of 0.01."""

MOBILITY_STRAYED: Final = 0.4
"""How far a move may be closed from where it was meant to end, in parts of its length: by its
curvature, a tenth, and not by half a right angle as from one component to another."""

MOBILITY_RANK_REACHED: Final = 1e-5
"""Singular values below this part of the largest count as zero at a configuration that was reached:
where equations are squared its place is sure to 1e-7 only, and a regular one 0.1 from a singular
one has 1e-3 at least."""

MOBILITY_OPEN: Final = 1e-7
"""Loops that a move leaves open by less, but do not close, are no clear answer: a motion of fourth
order leaves 1e-4 times its curvature, written dimensions of eight digits 1e-8."""

MOBILITY_GROWTH: Final = 16.0
"""Growth of what loops are open by from the first move to the far one, three times as long, below
which written dimensions may be the cause: what touches in third order grows 27 times, dimensions
that are off by a little less than 9 times."""

MOBILITY_SPHERE: Final = 1e-3
"""How far (rad, parts of the size) from its sphere a move may end."""

MOBILITY_DIFFERENCE: Final = 1e-4
"""Step of the central differences of Jacobians: errors 1e-8 by its square, 1e-12 by rounding."""

MOBILITY_FORM: Final = 1e-6
"""Bifurcation equations with smaller coefficients say nothing: a hundred errors of the
differences."""

MOBILITY_DIRECTIONS: Final = 64
"""Random starts for the directions that solve the bifurcation equations; eight lines, what three
forms in four unknowns have, are all met but for one case in a thousand."""

MOBILITY_HEADINGS: Final = 16
"""Directions, far from each other, that are followed either way."""

MOBILITY_FREE_HEADINGS: Final = 32
"""Headings of which the bifurcation equations say nothing that are followed either way. Measured on
platforms whose screw motion meets their translations in third order: one in ten to one in three
leads to it, so that all miss it in one case of 800."""

MOBILITY_LONE_HEADINGS: Final = 4
"""Headings in which single links move, too: spins as a rule, which change nothing."""

MOBILITY_PLACES: Final = (4, 16)
"""Least and largest number of places reached, far from each other, whose dimension is told."""

MOBILITY_OTHERS: Final = 8
"""Configurations at which what seems idle at one must be idle, too."""

MOBILITY_WORK: Final = 200
"""Motions of first order at all these places together: between least and largest, they are fewer
where there are many motions to try at each."""

MOBILITY_SAME_DIRECTION: Final = 5e-3
"""Two unit vectors whose cosine is nearer to 1 are one direction (6 degrees)."""

MOBILITY_TRIES: Final = 6
"""Places of falling rank that are tried one after the other for a general one."""

THREAD_ROWS: Final = 512
"""Rows that make a thread worth waking: at 0.3 us a row or more, ten times the 15 us that it takes
to wake and to wait for it."""
# --- the Python interface -----------------------------------------------------------------------

MOST_NAMES: Final = 100_000
"""Names in one list that a caller gives: more come from an iterable without an end."""

# --- text of tables ---------------------------------------------------------------------------

CELLS_PER_THREAD: Final = 50_000
"""Cells of a table that are worth a thread of their own: 2 ms of work against 0.05 ms to start
one."""

MOST_TEXT_THREADS: Final = 64
"""Threads that write one table: beyond, the memory takes longer than the digits."""

# --- what a run keeps --------------------------------------------------------------------------

MOST_NUMBERS: Final = 40_000_000
"""Numbers of a run: per row the cells of all tables, the columns of rows.csv and the freedoms of
all joints. Measured per number: 40 bytes with CSV, 80 with Markdown, 110 with JSON; 4.4 GB in
all."""

MOST_KEPT: Final = 400_000_000
"""Numbers that the results of variants may have together; 3.2 GB, the machine's memory before
anything is computed with them."""

# --- numbers of places, choices and threads ----------------------------------------------------

RANGE_SAMPLES: Final = 720
"""Places of a range at which the sign of an output's rate is read: half a degree of a full turn."""

MOST_EQUATIONS: Final = 120
"""Closing equations of one block. A Stewart platform has 6, with universal joints 15. The work of a
row grows with their cube (a ladder of four-bars driven at its far end, with a search of its
assemblies: 50 equations 9 s, 120 equations 28 s); blocks and loops may be any number."""

MOST_COMPARED_TREES: Final = 400
"""Choices of closing joints of equal size that are compared for evenness; of more, single
exchanges."""

PLACE_MOVES: Final = (0.05, -0.07)
"""Moves of all inputs (rad, parts of the size) off a drawing that is a special position: far enough
that pivots there are well above LOOP_RANK."""

MOST_SPLIT_LINKS: Final = 40
"""Links of one overconstrained set that is looked through for smaller ones: each costs a rank."""

RANK_WORK: Final = 200_000_000
"""Products spent on the ranks of one overconstrained component, half a second: what is not told
apart by then is solved together."""

REFINEMENT_ROUNDS: Final = 12
"""Rounds of telling links apart by their neighbours: each doubles what is seen of the structure."""

MOST_CHANGES: Final = 3
"""Joints changed by one cure of redundant constraints: nobody rebuilds more at once."""

MOST_IDLE_LINKS: Final = 3
"""Links of one idle group: a leg of S-P-S has two."""

REGULAR_WITHOUT_HOLDS: Final = 1e-4
"""Singular value, in parts of the largest, below which what is left without the coordinates that
hold idle freedoms is singular itself: dead centres are located to 1e-8, and their Jacobian has a
singular value of the order of its root there."""

HELD_INDEPENDENT: Final = 1e-2
"""Least singular value of the rates of held coordinates, in orthonormal idle motions, above which
they are independent where a branch ends: at the end it is zero, and next to it of the order of the
root of what is left."""

HELD_PART: Final = 0.1
"""Part of a dependence between held coordinates, in parts of the largest, from which one is named
with it."""

IDLE_MOVE: Final = 0.1
"""Move (rad, parts of the size) between two general configurations at which idle motions are
compared: as long as those by which mobility is told."""

IDLE_DECIMALS: Final = 9
"""Decimals of a line (parts of the size) that an idle freedom is held about: what depends on it is
conventional, and as many are written; errors of the configurations found are far smaller."""

RESPONSE_TOLERANCE: Final = 1e-10
"""Relative error of a step of a response where its file says none: seconds of motion then keep nine
digits, at twice the work of 1e-7."""

RESPONSE_TOLERANCES: Final = (1e-14, 1e-2)
"""Least and largest tolerance of a response: below, rounding of the accelerations decides; above,
error estimates mean nothing."""

DENSE_ROUNDING: Final = 1e-13
"""Size of an unknown of the dense system, in parts of the largest of its kind, up to which it is
rounding of the elimination and told as zero: fifty equations leave 1e-15 to 1e-14."""

DENSE_PIVOT: Final = 1e-12
"""Pivot of the dense system (equations scaled to a largest coefficient of 1) below which reactions
are not told apart: rounding of fifty equations leaves 1e-14, mechanisms that stand apart 1e-3."""

MOST_THREADS: Final = 1024
"""As many threads as may be asked for."""

MOST_RESPONSE_STEPS: Final = 1_000_000
"""Attempted steps of one response: minutes of work for one mechanism, and far more than any of the
kept ones needs (8 to 600)."""

DENSE_ROWS: Final = 10
"""Rows within one step of a response from which on they are interpolated instead of stepped to:
interpolation costs 18 to 50 times in energy, so it is for rows that are much denser than steps."""

ENERGY_ROUNDING: Final = 2.0**-48
"""Parts of the largest potential energy below which nothing is missing of a response's energies: 16
roundings, as heights are sums of some. A pendulum that swings by 1e-6 deg moves 1e-16 of it."""

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

SAME_MOMENT: Final = 1e-15
"""A stop so near to the last row, in parts of its moment, ends the response at that row: a few
roundings of the time, which would print as two rows of one moment."""

# --- true errors -----------------------------------------------------------------------------

ZERO_BUT_FOR_ROUNDING: Final = 1e-8
"""A column whose numbers in double-double are all below this part of the largest of its cells is
zero: what doubles leave there is 1e-16 of what cancelled, what double-doubles leave 1e-32."""

# --- bound of the errors of a row (analysis.sweep.error_bound) ----------------------------------

ERROR_PROBE: Final = 1e-13
"""Relative size of the changes with which a row's sensitivity is measured: a thousand roundings, so
that rounding is a thousandth of what is seen, and small enough that up to a condition of 1e6 a row
moves by less than a tenth of its distance to a dead centre."""

ERROR_PROBES: Final = 3
"""Samples of the sensitivity: the largest of three is a tenth of the true one once in a thousand
times, of two once in a hundred."""

ERROR_FACTOR: Final = 16.0
"""Roundings of a row's constants that count for all the roundings of closing it."""

ERROR_MOVE: Final = 1e-3
"""A row that such changes move farther (rad, length units) has no bound: it is nearer to a dead
centre than the sensitivity at its place tells."""
