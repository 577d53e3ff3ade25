"""From a checked file to the mechanism and its problem, in SI units.

All that needs names, dimensions or geometry is checked here; every error points at its line, with
the value found, the limit and the remedy.
"""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.building.builder import Built as Built, build as build
    from mechkin_cli.building.fields import is_tiny_length as is_tiny_length
    from mechkin_cli.building.motion import by_count as by_count, by_step as by_step
    from mechkin_cli.building.recording import (
        precise as precise,
        precise_response as precise_response,
        record as record,
        shifting as shifting,
    )
    from mechkin_cli.building.source import (
        BadTable as BadTable,
        open_data as open_data,
        open_file as open_file,
        open_text as open_text,
        table_path as table_path,
        table_text as table_text,
    )
    from mechkin_cli.building.tables import used_quantities as used_quantities
    from mechkin_cli.building.view import (
        Kind as Kind,
        ShapeSetting as ShapeSetting,
        ViewSettings as ViewSettings,
    )

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "builder": "Built build",
        "fields": "is_tiny_length",
        "motion": "by_count by_step",
        "recording": "precise precise_response record shifting",
        "source": "BadTable open_data open_file open_text table_path table_text",
        "tables": "used_quantities",
        "view": "Kind ShapeSetting ViewSettings",
    },
)
