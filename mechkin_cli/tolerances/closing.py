"""Positions: closing loops in blocks, the search for assemblies, and following branches to their
ends.

A residual is the largest closing equation: lengths in parts of the size, angles in rad.
"""

from __future__ import annotations

from typing import Final

# --- closing --------------------------------------------------------------------------------------

RESIDUAL_TIGHT: Final = 1e-16
"""A Newton iteration ends here at once: half a rounding of 1. Measured floor on RCSR: 1e-16 ...
3e-16."""

STEP_COARSE: Final = 1e-8
"""A Newton step shorter than this (rad, length units) is the last: it leaves an error of about half
its square times condition and curvature, below the rounding that the condition magnifies."""

RESIDUAL_ACCEPT: Final = 1e-14
"""Largest residual of a row that counts as assembled: about 50 roundings, what long chains need.
Lengths of a loop that reaches farther than the size count in parts of its reach."""

CORRECTION_ROUNDING: Final = 1e-15
"""Times the condition, a correction that may be rounding alone: nine roundings; three were
measured."""

NEWTON_ITERATIONS: Final = 6
"""A prediction that passes the jump test is within a tenth of a step; squared four times that is
rounding, and a sixth step allows for a large constant. More would mean that the guess was wrong."""

FOLD_ITERATIONS: Final = 60
"""On a fold a step halves the distance: 30 steps from a tenth to the root of rounding, 1e-8, beyond
which nothing changes, and as many again."""

FOLD_CORRECTION: Final = 10.0
"""By how much more than elsewhere a guess may be off on a fold: what goes as a root is guessed
worse, and both branches end there, so neither is taken for the other. A guess is off by a tenth of
its step elsewhere, so here by all of it."""

# --- in double-double ----------------------------------------------------------------------------

PRECISE_RESIDUAL_TIGHT: Final = 2e-32
"""`RESIDUAL_TIGHT` of runs in double-double: a rounding and a half of 1."""

PRECISE_STEP_COARSE: Final = 1e-16
"""`STEP_COARSE` of runs in double-double."""

PRECISE_RESIDUAL_ACCEPT: Final = 1e-30
"""`RESIDUAL_ACCEPT` of runs in double-double: about 80 roundings."""

# --- blocks --------------------------------------------------------------------------------------

MOST_EQUATIONS: Final = 120
"""Closing equations of one block whose matrix is full. A Stewart platform has 6, with universal
joints 15. The work of a row grows with their cube; blocks and loops may be any number."""

MOST_BAND_EQUATIONS: Final = 2000
"""Closing equations of one block whose matrix is a band (loop_order.py), where the work of a row
grows with their number: scissors of a thousand storeys load and run in 14 s. What asks for singular
vectors of the whole matrix, next to branch points and for mobility, still grows with the cube."""

FULL_EQUATIONS: Final = 24
"""Closing equations up to which full matrices are as fast as bands, so that loops are split evenly
instead of short (kernel/core/plan/plan_blocks.cpp)."""

MOST_EXCHANGED_LOOPS: Final = 200
"""Loops of one block whose cut joints are exchanged to make them shorter: each round of exchanges
grows with their cube, and takes a second of so many."""

EXCHANGE_ROUNDS: Final = 8
"""Rounds of such exchanges: each may halve the loops."""

LOOP_RANK: Final = 1e-6
"""Pivot of a loop's screws (moments in sizes) below which they are dependent as drawn: written
numbers leave 1e-9, and loops that close only by their dimensions are drawn more exactly still."""

RANK_WORK: Final = 200_000_000
"""Products spent on the ranks of one overconstrained component, half a second: what is not told
apart by then is solved together."""

MOST_SPLIT_LINKS: Final = 40
"""Links of one overconstrained set that is looked through for smaller ones: each costs a rank."""

MOST_COMPARED_TREES: Final = 400
"""Choices of closing joints of equal size that are compared for evenness; of more, single
exchanges."""

MOST_LOOP_JOINTS: Final = 64
"""Joints of the tree that a loop may pass before it is closed where it is shortest: three platforms
on each other, or scissors of thirty storeys. Longer ones are as long as the machine if they lead to
ground, and the work goes with the square of its loops."""

REFINEMENT_ROUNDS: Final = 12
"""Rounds of telling links apart by their neighbours: each doubles what is seen of the structure."""

PLACE_MOVES: Final = (0.05, -0.07)
"""Moves of all inputs (rad, parts of the size) off a drawing that is a special position: far enough
that pivots there are well above LOOP_RANK."""

# --- frames and origin ---------------------------------------------------------------------------

OPPOSITE_COSINE: Final = -1.0 + 1e-15
"""Cosine up to which two unit vectors are opposite, so that the shortest turn between them has no
axis of its own: nine roundings from -1. The kernel has the same number in `hung_bodies.hpp`."""

UNIT_SQUARE: Final = 4e-16
"""Distance of a vector's square from 1 up to which it counts as a unit vector and keeps its bits:
its three products and two sums round to no more."""

FAR_DRAWING: Final = 4.0
"""Distance of the drawing from the ground origin, in sizes, beyond which the kernel works about its
own origin: nearer, the origin costs three bits at most."""

# --- the search for assemblies --------------------------------------------------------------------

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

SEARCH_MOST_QUICK_BLOCKS: Final = 32
"""Blocks of a mechanism whose modes a short search may list: assemblies double with each, and a
search of more blocks takes seconds and lists the nearest alone."""

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

SEARCH_MOST_FOLDS: Final = 4
"""Unless they stand on so few folds (`FOLD_CONDITION`): a dead centre has one, by symmetry two or
four."""

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

SEARCH_CONDITION: Final = 1e12
"""An end point of the search that is more singular is no isolated assembly."""

SEARCH_SLIDES: Final = 2.0
"""Bound of random slides in sizes of the home drawing: a chain of links reaches no farther."""

# --- roots of a loop's polynomial ----------------------------------------------------------------

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

# --- which assemblies are one, and their order ---------------------------------------------------

SAME_MODE: Final = 1e-7
"""Two assemblies whose poses differ less (lengths / size, direction cosines) are one. Newton
leaves 1e-12 even at condition 1e4; modes that merge at a dead centre are 1e-6 apart already 1e-12
from it."""

SAME_FOLD: Final = 1e-3
"""Poses (parts of the size, direction cosines) that differ less stand on one fold: what is found
there is known to the root of a rounding, and steps from both sides end as near."""

FOLD_CONDITION: Final = 100.0
"""Largest condition times distance from a fold (rad, sizes): 0.2 to 66 on loops of links that
differ by ten. Where bodies may spin but for rounding it is 1e3 and more."""

MODE_ORDER: Final = 1e-6
"""Coordinates (rad, parts of the size) that differ less are equal for the order of the modes'
letters, so that rounding cannot change it."""

# --- the assembly that is meant ------------------------------------------------------------------

NEAR_RUNNER_UP: Final = 1.2
"""Ratio of distances below which the nearest assembly is not clearly the one that was meant."""

NEAR_SIDE: Final = 0.5
"""Part of the distance of two branches next to a dead centre by which what is named must be nearer
to one of them: all of it where it lies on their line, none where it lies at the dead centre."""

NEAR_FAR: Final = 0.5
"""Distance (rad, parts of the size) of a named coordinate from the assembly taken above which the
name is said to be missed: half a radian is more than a reading of a drawing leaves open."""

NEAR_BALL: Final = 1.0
"""Radius (rad, parts of the size) of the ball about what `near` names up to which it is searched
alone: a larger one holds most of the space."""

HOME_ASSEMBLED: Final = 1e-9
"""Closing residual at which a drawing counts as assembled: written numbers with ten digits reach
it."""

# --- following a branch: steps --------------------------------------------------------------------

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

TRIED_DIMENSION: Final = 1e-4
"""Change of a dimension, in parts of it or of the largest, by which it is tried whether the file
stays computed in the same way: far above every test of what is parallel or coincides, and far below
what a slider moves."""

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

ARC_WORK: Final = 1e9
"""Attempts of steps of one look by arclength times the cube of the equations that are walked
together, each some sixty products of matrices: half a minute. Up to 60 equations all steps that a
look may have; a branch point takes some 50, of 240 equations yet."""

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

SLOPE_JUMP: Final = 1e-6
"""Change of a function's slope, in parts of its largest, that is a jump: halved sixty times, a
stretch on which it is smooth changes it by roundings."""

SLOPE_RANGE: Final = 0.01
"""Beside the way of a motion (rad, m) jumps of slopes are sought so far: it may have come near to
one between two rows."""

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

STOPPED_MISS: Final = 1e-6
"""Closing equation after that step above which the loops stop the input to first order: below, to
second order at most, 9e-8 times curvatures."""

# --- a drawing where motions meet ---------------------------------------------------------------

HOME_STEP: Final = 0.05
"""Step of the inputs (rad, length units) from a drawing that is singular as driven to the place
where an assembly next to it is looked for: regular there, and known to many digits."""

HOME_BOX: Final = 0.25
"""How far (rad, parts of the size) from the drawing what moves there with the inputs held is near
it: five times that step."""

HOME_PARTS: Final = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
"""Parts of that step at which an assembly is looked at on the way back to the drawing: the crossed
motion of a parallelogram whose bars differ by 1e-5 of their length moves 1e5 times as fast as its
crank."""

HOME_NEAR: Final = 0.5
"""How far (rad, length units) an assembly that comes from the drawing is at most from it where the
inputs are nearly there, twice over; one that does not stays where it is."""

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

BESIDE_DEAD_CENTRE: Final = 1e-6
"""How far (rad, parts of the length) from an assembly that stands exactly at a dead centre a branch
is looked for: its places are off by about the root, 1e-3, which double arithmetic resolves well."""

BESIDE_DEAD_CENTRE_GUESSES: Final = (1.0, 1.0, 3.0, 3.0, 3.0, 10.0, 10.0, 10.0)
"""Sizes of the random moves from it, in roots of that way, from which the branch is looked for: its
places are off by about one, or by several where links are long."""

MOST_BESIDE_DEAD_CENTRE: Final = 0.03
"""How far (parts of the size, direction cosines) its pose is off at most: thirty such roots, so far
less than where another assembly stands."""

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

MOST_COUPLED_TURNS: Final = 256
"""The same where couplings count turns: wheels come again after as many turns as the other has
teeth."""

PASSED: Final = 1e-6
"""Way of the inputs (rad, length units) up to which a branch that ends has not left its start."""

FAR_INPUT: Final = 20.0
"""How far a slide (length units) or a thread (rad) is driven in search of a dead centre."""

RUNAWAY_SLIDE: Final = 20.0
"""Length of a slide (length units, about sizes) from which a lost branch is said to go out of
bounds; a search takes starts up to two sizes. Measured on RCCC: lost at 206."""

RANGE_SAMPLES: Final = 720
"""Places of a range at which the sign of an output's rate is read: half a degree of a full turn."""
