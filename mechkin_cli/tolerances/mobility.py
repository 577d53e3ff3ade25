"""Mobility by rank; lengths in parts of the size."""

from __future__ import annotations

from typing import Final

# --- ranks ---------------------------------------------------------------------------------------

RANK_GAP: Final = 1e3
"""Least ratio of neighbouring singular values at which a rank is accepted."""

RANK_ZERO: Final = 1e-8
"""Singular values below this part of the largest count as zero: what is redundant is 1e-15 in an
exact drawing, 1e-10 in one written with ten digits."""

RANK_ROUNDING: Final = 1e-14
"""Singular values below this part of the largest are rounding, and no measure of a gap."""

# --- closing -------------------------------------------------------------------------------------

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

MOBILITY_STUCK: Final = 8
"""Steps without a tenth of progress after which Newton gives up."""

MOBILITY_STARTS: Final = 40
"""Random poses tried where the drawing itself leads to no assembly."""

MOBILITY_LONG_ROW: Final = 16
"""Loops that share joints from which on steps eliminate them one after the other: all at once is
faster below."""

MOBILITY_LONGER_ROW: Final = 64
"""The same for ranks, which take some ten times the elimination of a step."""

MOBILITY_FRONT: Final = 12
"""Freedoms that are eliminated together: a step of so many takes twice the time of its calls."""

MOBILITY_FEW_MOTIONS: Final = 4
"""Motions are found by inverse iteration where all freedoms are at least so many times as many,
with those beside: of more a dense factorisation takes less."""

MOBILITY_VALUES_BESIDE: Final = 4
"""Singular values that are looked at beside those of the motions: the least of them is known better
than the others."""

MOBILITY_INVERSE_ITERATIONS: Final = 4
"""Each divides what is wrong in the motions by the square of a singular value in parts of
`MOBILITY_DAMPING`: two reach rounding where the rank is clear, and the next values, which are
nearer to one another, are known to a part of themselves after two more."""

MOBILITY_SURELY_REGULAR: Final = 2.0
"""Times the limit of a rank that the least singular value of independent equations must be as
inverse iteration finds it, from above: hundreds of values alike leave it off by a tenth. Nearer
ones are left to the dense factorisation."""

# --- motions -------------------------------------------------------------------------------------

MOBILITY_NO_TWIST: Final = 1e-9
"""Parts of a unit twist below which it does not turn, or does not advance: written numbers have
nine digits and more."""

MOBILITY_NO_WRENCH: Final = 1e-6
"""Parts of a unit stress or wrench that count as none: a null vector is known to rounding over the
gap of the singular values, at least 1e3 above 1e-10 for a drawing with ten digits."""

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

MOBILITY_FAMILY: Final = 0.5
"""Sine of the angle between the steps along two components above which they are several: those
along one turn by about the length of the move, measured 0.26 at most; components that meet are
square to each other in some direction as a rule."""

MOBILITY_ASIDE: Final = 0.2
"""Sine of the angle between a heading and the steps along all components found above which it may
lead to another: curvature turns it by 0.17 at most in what was measured."""

MOBILITY_CLOSED_SURELY: Final = 1e-13
"""Loops whose dimensions are exact close to 1e-15. Where they stay open by more, either dimensions
are rounded, or equations touch in high order: these seem to hold over short moves."""

MOBILITY_CHORD_OPEN: Final = 0.9
"""A chord of loops that stay open by more counts only with this singular value: those of equations
that touch in fourth order fall from 0.9995 to 0.88 where the move is three times as long."""

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

# --- cures ---------------------------------------------------------------------------------------

MOST_CHANGES: Final = 3
"""Joints changed by one cure of redundant constraints: nobody rebuilds more at once."""


# Idle freedoms, and the coordinates that hold them.

# --- idle links ----------------------------------------------------------------------------------

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

SAME_LEAD: Final = 2e-9
"""Parts of a lead up to which another is the same: nine written digits of both are off by half a
unit of their last each."""

COMMON_MOTION_ROUNDING: Final = 1e-12
"""What two joints of a link may miss a common motion by (rad, parts of the size) and only round:
some thousand roundings of frames, displacements and the elimination. What misses it by more is
told, since results are off by as much."""

SAME_COMMON_MOTION: Final = 1e-6
"""Difference of a common motion at two general places (rad, parts of the size) up to which a link
carries its line along: ten times what `COMMON_MOTION` lets pass; others differ by their own
size."""

MOST_IDLE_LINKS: Final = 3
"""Links of one idle group: a leg of S-P-S has two."""

IDLE_MOVE: Final = 0.1
"""Move (rad, parts of the size) between two general configurations at which idle motions are
compared: as long as those by which mobility is told."""

IDLE_DECIMALS: Final = 9
"""Decimals of a line (parts of the size) that an idle freedom is held about: what depends on it is
conventional, and as many are written; errors of the configurations found are far smaller."""

# --- the coordinates that hold them --------------------------------------------------------------

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

HELD_INDEPENDENT: Final = 1e-2
"""Least singular value of the rates of held coordinates, in orthonormal idle motions, above which
they are independent where a branch ends: at the end it is zero, and next to it of the order of the
root of what is left."""

HELD_PART: Final = 0.1
"""Part of a dependence between held coordinates, in parts of the largest, from which one is named
with it."""

REGULAR_WITHOUT_HOLDS: Final = 1e-4
"""Singular value, in parts of the largest, below which what is left without the coordinates that
hold idle freedoms is singular itself: dead centres are located to 1e-8, and their Jacobian has a
singular value of the order of its root there."""
