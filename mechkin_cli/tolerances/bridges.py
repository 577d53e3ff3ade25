"""What goes out to other programs and comes in from them."""

from __future__ import annotations

from typing import Final

# --- what comes in -------------------------------------------------------------------------------

LARGEST_IMPORTED: Final = 1e9
"""Number of a table or a robot file (in its own units) beyond which no mechanism is meant; squares
and products of it stay far from the end of doubles."""

NO_DIRECTION: Final = 1e-10
"""Length (in the file's units) up to which a vector has no direction, and a quaternion no turn:
files are written with fewer decimals, so that such a vector is meant as zero."""

SAME_PLACE: Final = 1e-9
"""m or rad up to which places, axes and sums of coordinates of another program are the same: its
numbers are rounded to nine digits or more."""

WELD_GAP: Final = 1e-6
"""m or rad by which two bodies may be apart in the drawing at the frames that a weld keeps
together: what six printed digits leave; the weld takes up the rest."""

DRAWN_APART: Final = 1e-13
"""m or rad from which a joint is drawn on either of its links: products of a dozen frames round to
less."""

IMPORT_ROUNDING: Final = 1e-15
"""Parts of the largest entry below which an entry of a vector or tensor is what rounding left of
zero."""

FIFTEEN_DIGITS: Final = 2.5e-16
"""Parts of a number by which its fifteen digits may miss it and still be written in its place."""

PARALLEL_AXIS: Final = 1e-12
"""Sine of the angle to z below which an axis is z: the turn between them has no axis of its own."""

# --- what goes out -------------------------------------------------------------------------------

CHAIN_GAP: Final = 1e-9
"""Parts of the mechanism's size, and rad, by which a chain of displacements may miss its link: far
above rounding, and far below what the coordinates of another assembly would miss it by."""

MUJOCO_STEP: Final = 2e-5
"""Time step of an exported model in s. MuJoCo's constraints give way by the load they bear times
the square of the step: at this one by less than 2e-7 m in the mechanisms kept here; at the usual
1e-3 by up to 4e-4 m."""

MUJOCO_LEAST_SHARE: Final = 1e-3
"""Parts of the heaviest link's mass, and of the largest moment of inertia, that a link without is
given: with 1e-6 MuJoCo's constraints are so uneven that loops drift by centimetres."""

MUJOCO_LEAST_MOMENT: Final = 0.01
"""Parts of a link's largest principal moment that its others are at least given."""

MUJOCO_TRIANGLE: Final = 1e-12
"""Parts of the largest principal moment by which the sum of the others stays above it: MuJoCo
refuses a thin rod whose moments round the other way."""

CHANGED_INERTIA: Final = 1e-9
"""Parts of the largest entry by which a tensor may be changed for MuJoCo without being told."""

SHORT_BAR: Final = 1e-6
"""Parts of the mechanism's size below which a bar between two joints is not drawn."""

LOADS_BALANCED: Final = 1e-6
"""Of the largest force on a link, or of the moment that it has over the mechanism's size: a sum
above this is no rounding of reactions, whose own condition may cost some digits."""

NO_LOAD: Final = 1e-12
"""Of the terms of a difference: what is left below this part of them is rounding, and no load."""
