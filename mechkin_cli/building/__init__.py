"""From a checked file to the mechanism and its problem, in SI units.

All that needs names, dimensions or geometry is checked here; every error points at its line, with
the value found, the limit and the remedy.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.building.builder import *
    from mechkin_cli.building.cables import *
    from mechkin_cli.building.drawn_wheels import *
    from mechkin_cli.building.edit import *
    from mechkin_cli.building.fields import *
    from mechkin_cli.building.recording import *
    from mechkin_cli.building.source import *
    from mechkin_cli.building.spacing import *
    from mechkin_cli.building.tables import *
    from mechkin_cli.building.view import *
    from mechkin_cli.building.written_numbers import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "builder": "Built build graph_as_built motion_as_built read_and_build",
        "cables": "DrawnCable",
        "drawn_wheels": "DrawnBelt DrawnScrew DrawnWheel",
        "edit": "Edited edit_parameters value_text",
        "fields": "is_tiny_length",
        "recording": "precise precise_response record record_response shifting",
        "source": "BadTable open_data open_file open_text table_path table_text without_collection",
        "spacing": "Spacing",
        "tables": "used_quantities",
        "view": "DrawnBetween Kind ShapeSetting ViewSettings",
        "written_numbers": "FileNumber file_numbers",
    },
)
