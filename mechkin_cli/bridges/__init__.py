"""Files of other programs: what comes in becomes a mechanism file, what goes out is written for the
other side's reader. Everything that could not be carried over is named."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.bridges.formats import *
    from mechkin_cli.bridges.hard_points import *
    from mechkin_cli.bridges.parts import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "formats": "EXPORTS ExportOptions ImportOptions exported imported imported_robot",
        "hard_points": "hard_point_names with_hard_points",
        "parts": "Exported Imported",
    },
)
