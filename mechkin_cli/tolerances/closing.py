"""Closing loops in blocks.

A residual is the largest closing equation: lengths in parts of the size, angles in rad.
"""

from __future__ import annotations

from typing import Final

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
"""Closing equations of one block. A Stewart platform has 6, with universal joints 15. The work of a
row grows with their cube (a ladder of four-bars driven at its far end, with a search of its
assemblies: 50 equations 9 s, 120 equations 28 s); blocks and loops may be any number."""

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
