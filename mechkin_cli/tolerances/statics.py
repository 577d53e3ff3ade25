"""Limits of forces about a place, their derivatives and where they balance: steps of a search, when
it has found an equilibrium, and what is marginal.

Coordinates are in rad and in parts of the mechanism's length unit, forces in N*m by these.
"""

from __future__ import annotations

from typing import Final

FORCE_STEPS: Final = (2.0**-8, 2.0**-13, 2.0**-18)
"""Steps by which forces are differentiated (rad, parts of the length unit): of a smooth force the
first leaves 1e-18 by its ninth derivative and 4e-14 by rounding; what bends sharply beside the
place, as a spring that is nearly slack, needs the next ones."""

FORCE_DIFFERENCE: Final = 1e-9
"""Difference of orders six and eight, in parts of the largest derivative, above which a shorter
step is tried: that of order eight is then 1e-12 right."""

NEWTON_DIFFERENCE: Final = 1e-4
"""Step of the differences of second order for the slopes of Newton's steps: right to eight digits,
so that each step gains eight."""

EQUILIBRIUM_STEP: Final = 1e-11
"""A Newton step below this, rad or length units, ends the search: the next would be below the
rounding of a place."""

EQUILIBRIUM_ROUNDING: Final = 1e-14
"""Forces below this part of the largest about the place are zero to rounding: no step is left at a
marginal place, to which Newton's steps shrink too slowly."""

LINGERING_STEP: Final = 0.25
"""Newton steps above this part of the one before go to a marginal place: they are a half at a fold,
and two thirds at a fork."""

EQUILIBRIUM_REACH: Final = 0.5
"""Longest step of the search, rad or length units: most forces do not change sign twice in it."""

WILD_STEP: Final = 30.0
"""A Newton step beyond this, rad or length units, says nothing: slopes are near zero. The search
goes down along the forces instead."""

EQUILIBRIUM_BALANCE: Final = 1e-12
"""Forces below this part of the largest of one load balance where no step makes them smaller: loads
are that right at a place that closes to rounding."""

MOST_EQUILIBRIUM_STEPS: Final = 100
"""Steps of one search: ten to thirty take it around a full turn, six end it; at marginal places
each leaves two thirds of the way, and sixty leave rounding."""

FAR_EQUILIBRIUM: Final = 1e3
"""A search this far from its start, in length units, runs away: loads push without bound."""

MARGINAL_STIFFNESS: Final = 1e-9
"""A stiffness below this part of the largest force and stiffness about it is zero to what forces at
a place that is found to `EQUILIBRIUM_STEP` tell."""

UNSYMMETRIC_STIFFNESS: Final = 1e-8
"""A stiffness that is unsymmetric by more than this part of its largest entry is of loads without a
potential: rounding and differences leave less."""

MASSLESS: Final = 1e-12
"""An eigenvalue of the inertia below this part of its largest entry is of a motion without mass."""

FLUTTER: Final = 1e-6
"""Real parts of eigenvalues above this part of the fastest are of motions that grow: two that meet,
as at the load of flutter, are off by the root of the rounding of forces and of their slopes."""

INDIFFERENT_REACH: Final = 0.1
"""How far along a motion without stiffness the loads are looked at, rad or length units: where they
still balance there, the equilibrium is indifferent."""

NO_STIFFNESS: Final = 1e-7
"""A direction with less stiffness than this part of the largest force and stiffness may be that of
a motion along which loads balance: differences over `NEWTON_DIFFERENCE` are right to eight
digits."""

MOTION_STEP: Final = 0.05
"""Step along a motion on which loads balance, rad or length units. An equilibrium without stiffness
whose pose is that near to one on the motion lies on it."""

MOST_MOTION_STEPS: Final = 1000
"""Steps along such a motion to one side: eight turns."""

MOST_SURFACE_STEPS: Final = 40
"""Steps of `EQUILIBRIUM_REACH` from an equilibrium to a known one of a motion of several freedoms:
three turns."""

MOST_TOLD: Final = 4
"""Motions, parts of a window or intervals of rest that a note names one by one."""

SAME_EQUILIBRIUM: Final = 1e-6
"""Two equilibria whose places differ by less, in parts of the size, are one: marginal ones are
found to the cube root of rounding, 1e-5 of their curvature's reach."""

WINDOW_PLACES: Final = 48
"""Parts of a window, or of each turn that it has, at whose ends all assemblies are looked for."""

CIRCUIT_STARTS: Final = 128
"""Random starts with the coordinate free, taken at once: 106 that end within the window at known
circuits bring the chance of another down to `CIRCUIT_CHANCE`."""

MOST_CIRCUIT_STARTS: Final = 2048
"""Such starts at most, where few of them end within the window."""

WINDOW_SHIFT: Final = 0.0431
"""By how much of such a part its ends stand off even values, and those of the window off its ends:
dead centres are seldom there."""

MOST_WINDOW_TURNS: Final = 100
"""Turns of a window: each takes some hundredths of a second."""

WINDOW_SAMPLES: Final = 16
"""Places of a branch between two values of the window, at which forces are taken: two equilibria
nearer to each other than that are seen where the force comes near to zero between them."""

WINDOW_STARTS: Final = 512
"""Starts of a search in a window of several freedoms, at least."""

HOPELESS_STARTS: Final = 256
"""Starts after which a search in a window ends if none of them came to an equilibrium."""

WINDOW_BATCH: Final = 128
"""Searches that go side by side: more share no more of a call's cost."""

SETTLED_START: Final = 8
"""Every so many starts one first goes down: of chains and loops of two and three freedoms those
that go straight find all stable places, too, and alone the saddles."""

WINDOW_CHANCE: Final = 0.02
"""The chance that one more search finds another equilibrium, at which a search in a window ends:
saddles of loops are met by one start in fifty and less."""

CIRCUIT_CHANCE: Final = 0.05
"""The same of random starts for circuits, which take most of the time of a window."""

MOST_WINDOW_STARTS: Final = 4096
"""Starts of a search in a window of several freedoms, at most."""

MOST_SETTLING_STEPS: Final = 30
"""Steps down to a stable place before Newton's: half a turn takes six."""

SETTLING_STIFFNESS: Final = 1e-3
"""Least stiffness, in parts of the largest, by which steps down are taken."""

SETTLED_STEP: Final = 1e-3
"""Steps down end below this, rad or length units: Newton's are faster from there."""

TOUCHING: Final = 0.2
"""A force that comes down to this part of a sample's, by a parabola through three, may touch zero
between them: a search tells."""

MOST_HALVINGS: Final = 50
"""Halvings of a stretch on which the force changes its sign: to rounding."""

SMOOTH_STEP: Final = 0.5
"""From one part of a step to the next, states may change their pace by this part of it: steps of
half a radian bend by less, and a jump to another branch is a change by its whole length."""

DEAD_COORDINATE: Final = 1e6
"""Where a named coordinate moves by less than one part in this of the mechanism's motion, it stands
at a dead centre, and there is no stiffness by it."""

# Sweeps at rest.

MOST_REST_ROWS: Final = 1024
"""Rows of a sweep at rest that are corrected at once."""

REST_POINTS: Final = 8
"""Known rows through which the next ones are extrapolated, at most: of more, rounding is seen where
the next rows go four times as far."""

REST_GROWTH: Final = 8
"""How many times as many rows as before are corrected next, at most, and what part of them where
they were too many."""

REST_TERM: Final = 0.1
"""Rows are predicted as far as the last term of their polynomial is below this, rad or length
units: Newton's method needs three steps then."""

REST_REACH: Final = 0.2
"""Rows are predicted by the rate of the branch alone up to this far from the first one, rad or
length units."""

REST_NODES: Final = 16
"""Rows of a stretch that are corrected with a stiffness of their own, at most; those between follow
by interpolation."""

MOST_REST_SPANS: Final = 8
"""Predictions of a stretch, one from the other, before its rows between the nodes follow: where one
of these is not on the branch, those behind it were in vain."""

REST_CHORD: Final = 1e-9
"""A correction below this, rad or length units, with a stiffness interpolated to a hundredth leaves
less than `EQUILIBRIUM_STEP`."""

MOST_CHORDS: Final = 12
"""Corrections of predicted equilibria: three or four are enough."""

CHORD_GAIN: Final = 0.5
"""Each correction has to be smaller than the one before by this, or it was predicted too far."""

REST_ROUNDING: Final = 1e-9
"""Corrections that stay below this, rad or length units, are rounding of weak forces."""

REST_MISS: Final = 0.3
"""How far from the row before the next one may be, rad or length units, before any rate of the
branch is known."""

REST_SMALL: Final = 1e-3
"""Corrections below this, rad or length units, are no jump to another branch."""

LEAST_REST_WAY: Final = 1e-3
"""A way of the inputs from row to row is counted as at least this long beside the coordinates at
rest, as where time alone goes on."""

SHORT_REST: Final = 0.05
"""Steps of coordinates at rest from row to row below this, rad or length units, need no rates of
the branch where they change slowly."""

SLOW_REST: Final = 0.1
"""Steps that differ from those before by less than this part of them change slowly. On the way into
a fold, as the root of what is left, they grow by a tenth five rows before it."""

LONG_REST: Final = 0.2
"""From one row to the next the branch may bend more than once beyond this, rad or length units: it
is followed by its arclength."""

JOINED_REST: Final = 0.05
"""A step differs from the mean of the rates at its ends by the third power of its length; another
branch beside it has other rates or lies elsewhere."""

MOST_ARCS: Final = 400
"""Steps by arclength from one row to the next: a bend takes a dozen."""

CROSSING_STEP: Final = 1e-3
"""A step by arclength this short, rad or length units, may go straight across another branch."""

CROSSING_BEND: Final = 1e-4
"""A branch that bends by less in such a step crosses the other: of two that miss each other by e it
is (2 e / step)^2, so that those nearer than 5e-6 count as crossing."""

LEAST_ARC: Final = 1e-9
"""Shortest step by arclength: below, branches that meet are not told apart."""

NEAR_DEAD_CENTRE: Final = 0.05
"""Coordinates that tell places worse than others by this part stand near a dead centre: slopes by
them are differences over `NEWTON_DIFFERENCE`, which have no values closer to one than that, where
rates are its square root."""

MOST_REST_EXCHANGES: Final = 4
"""How often another coordinate takes the place of one at rest that comes to a dead centre."""

FOLD_STEP: Final = 1e-5
"""Arclength within which a fold is located; its inputs are then right to the cube of that."""

ARC_COSINE: Final = 0.9
"""Least cosine between the directions of a branch a step apart."""

TURNED_BALANCE: Final = 1e-9
"""Force left at an equilibrium whose angles were turned by whole turns, in parts of the largest of
one load, up to which it is one still: turns add rounding alone, a spring that counts them 2 pi."""

# Rest by friction.

ABOUT_TO_MOVE: Final = 1e-30
"""Acceleration that tells the way in which a mechanism at rest would begin to move: its square is
still a number, and what it does to inertia is far below the rounding of loads."""

REST_INTERVAL_STEP: Final = 2.0**-7
"""Step, rad or length units, by which the places of an interval of rest are looked at: where the
mechanism slips within less, and rests again, is missed."""

REST_INTERVAL_PLACES: Final = 32
"""Places that are looked at in one call."""

REST_DEAD_CENTRE_PLACES: Final = 24
"""Places towards a dead centre that ends an interval, each half as far from it as the last one."""

REST_EDGE_PART: Final = 2.0**-10
"""Parts of a bracket beside the root of a line through its ends at which it is cut: it is a
thousand times shorter where the line is that good."""

SAME_REST_SHARE: Final = 1e-6
"""Shares of friction at one pose that differ by more are of other loads, as of springs that count
turns."""

# Balance in double-double.

BALANCE_CORRECTIONS: Final = 10
"""Corrections of a place: each leaves 1e-8 of the one before, or what the place leaves squared."""

REPEATED_BALANCE: Final = 1e-30
"""Corrections below this, rad or length units, are rounding of double-doubles."""

BALANCED_PLACE: Final = 1e-24
"""Corrections that stay above this, rad or length units, are of a place that a stiffness near zero
hardly tells: true errors of doubles would not be seen beside them."""
