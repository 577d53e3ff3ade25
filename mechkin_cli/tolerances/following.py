"""Following a branch to its ends: steps, the path of the inputs, dead centres, circuits."""

from __future__ import annotations

from typing import Final

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

PLAN_STEP: Final = 1e-3
"""Part of a path of changing dimensions over which its derivatives are read, unless its steps are
short: differences are wrong by its square, 1e-6, and rounding leaves 1e-10 in the second ones; both
matter to predictions only."""

MOST_STEPS: Final = 20000
"""Attempts that may take a path a longest step further; it may be as long as it likes. Measured:
R-Sg-C takes 32 steps for 315 degrees, and halvings down to `LEAST_STEP` are 50."""

# --- the path of the inputs ----------------------------------------------------------------------

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

PATH_STRAY: Final = 1e-3
"""Distance of a row's inputs from the curve between two nodes in parts of the step: a twentieth of
what a row filled in may be off."""

FREE_INPUT_STEP: Final = 3e-4
"""Step of an input (rad, length units) after which the loops must still close where it is free: a
prediction of second order misses by its cube, 3e-11, times third derivatives."""

FREE_INPUT_MISS: Final = 3e-9
"""Closing equation after that step above which an input may be locked, and the mobility is asked: a
locked one misses by a part of the step or of its square, 9e-8."""

# --- whole turns ---------------------------------------------------------------------------------

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

# --- dead centres --------------------------------------------------------------------------------

DEAD_CENTRE_STEP: Final = 1e-12
"""Newton on d(input)/d(coordinate) = 0 ends when the coordinate moves less (rad or parts of the
size)."""

DEAD_CENTRE_ITERATIONS: Final = 40
"""Far more than quadratic convergence needs; a search that uses them all has found none."""

SAME_DEAD_CENTRE: Final = 1e-5
"""Two dead centres whose poses differ less are one: the states there are known to about 1e-8, the
root of a rounding."""

# --- circuits and ends ---------------------------------------------------------------------------

SAME_TURN: Final = 1e-12
"""Turns by which two rows' inputs may differ from a whole number of them and still stand for the
same place: written numbers round at 1e-16 of their size."""

MOST_BRANCHES: Final = 64
"""Branches of one circuit that are walked through."""

MOST_TURNS: Final = 16
"""Whole turns of an input after which an assembly that never came again counts as far."""

PASSED: Final = 1e-6
"""Way of the inputs (rad, length units) up to which a branch that ends has not left its start."""

FAR_INPUT: Final = 20.0
"""How far a slide (length units) or a thread (rad) is driven in search of a dead centre."""

RUNAWAY_SLIDE: Final = 20.0
"""Length of a slide (length units, about sizes) from which a lost branch is said to go out of
bounds; a search takes starts up to two sizes. Measured on RCCC: lost at 206."""

RANGE_SAMPLES: Final = 720
"""Places of a range at which the sign of an output's rate is read: half a degree of a full turn."""
