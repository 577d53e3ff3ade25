"""What can move: freedoms, configurations, idle motions, redundant constraints.

Finite, not only to first order. Answers are whole numbers and words; NumPy's linear algebra serves.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.mobility.configurations import lost_holds as lost_holds
    from mechkin_cli.mobility.families import held_to_family as held_to_family
    from mechkin_cli.mobility.idle import held_along as held_along
    from mechkin_cli.mobility.mobility import (
        Mobility as Mobility,
        drawn_faults as drawn_faults,
        find_mobility as find_mobility,
        meeting as meeting,
        undriven_notes as undriven_notes,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "configurations": "lost_holds",
        "families": "held_to_family",
        "idle": "held_along",
        "mobility": "Mobility drawn_faults find_mobility meeting undriven_notes",
    },
)
