"""The search for assemblies, and which of them is meant."""

from __future__ import annotations

from typing import Final

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
