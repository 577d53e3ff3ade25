"""What can move: freedoms, configurations, idle motions, redundant constraints.

Finite, not only to first order. Answers are whole numbers and words; NumPy's linear algebra serves.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.mobility.configurations import *
    from mechkin_cli.mobility.families import *
    from mechkin_cli.mobility.idle import *
    from mechkin_cli.mobility.mobility import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "configurations": "hold_ends lost_holds",
        "families": "held_to_family",
        "idle": "held_along",
        "mobility": "Mobility drawn_faults find_mobility meeting undriven_notes",
    },
)
