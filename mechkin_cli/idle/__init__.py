"""Freedoms that no input drives and no result depends on: found, named, and locked.

A rod between two spheres spins about itself; such motions would make every loop singular. This room
finds them at a place, and locks them in a way that does not change what is asked for.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.idle.find import *
    from mechkin_cli.idle.hold import *
    from mechkin_cli.idle.idle import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "find": "LinkMotion PLACES RigidGroup",
        "hold": "exact_holds held_freedoms held_groups three_turns",
        "idle": "conventional_notes holding_notes idle_freedoms nearly_common_notes spin_errors "
        "without_spin",
    },
)
