"""Idle freedoms, and the coordinates that hold them."""

from __future__ import annotations

from typing import Final

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
