"""Small motions about a place: matrices in named coordinates, natural frequencies, state space.

Knows how a row of a run is left to move, and what its motion is to first order; hides charts,
differences and eigenproblems.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.vibration.place import *
    from mechkin_cli.vibration.playing import *
    from mechkin_cli.vibration.tables import *
    from mechkin_cli.vibration.vibration import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "place": "Freed freed",
        "playing": "PlayedMode played swung",
        "tables": "vibration_tables",
        "vibration": "FrequencyResponse StateSpace Vibration",
    },
)
