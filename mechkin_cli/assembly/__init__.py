"""Which assembly the first row has: as drawn, near what the file names, by mode, across a fold."""

from __future__ import annotations

from mechkin_cli.lazy import lazy_names

TYPE_CHECKING = False
if TYPE_CHECKING:
    from mechkin_cli.assembly.fold import *
    from mechkin_cli.assembly.home import *
    from mechkin_cli.assembly.near import *
    from mechkin_cli.assembly.start import *

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "fold": "PlacesBefore at_unit_rate condition_at left_for meant_branch unit_rates",
        "home": "NamedModes is_cyclic is_home_assembled is_home_singular name_modes "
        "nearest_to_home probe_of telling_points wrapped",
        "near": "AssemblyStart NEAR nothing_found",
        "start": "HOME MAY_BE_RIGID choose_start continued_start mode_letter "
        "rows_of_start state_at_first_row",
    },
)
