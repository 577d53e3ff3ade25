"""Proofs of rows, and of the ways between them."""

from __future__ import annotations

from typing import Final

# --- inputs and enclosures -----------------------------------------------------------------------

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

# --- ways between rows ---------------------------------------------------------------------------

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

# --- dead centres --------------------------------------------------------------------------------

DEAD_CENTRE_INTERVALS: Final = (4.0, 32.0, 256.0)
"""Half the interval of a joint coordinate in which one dead centre is to be proven, in parts of how
far from its middle the dead centre may lie: the first does unless the input bends over so small an
interval."""

DEAD_CENTRE_LEAST: Final = 1e-15
"""Step (rad, length units) of a joint coordinate that moves no dead centre: a few roundings."""

DEAD_CENTRE_MISS: Final = 1e-3
"""Longest step (rad, length units) from where following locates a dead centre: it does so to
rounding, so that a longer one leads to another place."""

DEAD_CENTRE_NEAR: Final = 1e-6
"""Distance of the input (rad, length units) before a dead centre at which the unknowns are near
enough to those at it for Newton's method: they are off by its root."""

DEAD_CENTRE_APPROACH: Final = (0.25, 0.06, 0.015, 0.004, 0.001)
"""Distances of a joint coordinate (rad, length units) from a dead centre at which it takes over
from the input as the parameter of tubes: as far as one holds, and nearer where that does not do."""
