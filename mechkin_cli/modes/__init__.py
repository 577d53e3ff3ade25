"""What else could be assembled from the same parts, circuits, and how far an input can go."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.modes.circuits import *
    from mechkin_cli.modes.modes import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "circuits": "Walker",
        "modes": "Modes Ranges UNNAMED find_modes find_ranges",
    },
)
