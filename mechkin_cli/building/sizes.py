"""A limit on what a well-formed file may ask for: loops to choose closings of.

A file within all limits of the reader can still ask for more than a machine has: the choice of
closing joints grows exponentially with the number of loops.
"""

from __future__ import annotations

from typing import Final

from mechkin_cli.building.fields import Fields
from mechkin_cli.diagnostics import Number
from mechkin_cli.mechanism.model import GROUND_NAME, Mechanism

MOST_LOOPS: Final = 12
"""Independent loops. A Stewart platform has 5. Measured on the slowest graphs found (six links,
each joined to each other): 0.7 s for 10 loops, 4 s for 12, 90 s for 15."""


def check_loops(fields: Fields, mechanism: Mechanism) -> bool:
    """Whether the mechanism has few enough loops; if not, that is noted."""
    joints = tuple(mechanism.joints)
    loops = len(joints) - sum(name != GROUND_NAME for name in mechanism.links)
    if loops <= MOST_LOOPS:
        return True
    fields.error(
        "too-many-loops",
        ("joints",),
        f"the {len(joints)} joints close too many independent loops",
        "write parts that do not act on each other in files of their own",
        measured=f"{loops} loops",
        limit=f"{MOST_LOOPS} loops",
        numbers=(Number("loops", loops, limit=MOST_LOOPS),),
    )
    return False
